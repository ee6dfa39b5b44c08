#include "Processes.h"

#include "MovableMesh.h"

#include "vtkDataSet.h"
#include "vtkMultiProcessController.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Null if there is only one process.
vtkMultiProcessController* manyProcesses()
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return controller && controller->GetNumberOfProcesses() > 1 ? controller : nullptr;
}
}

//------------------------------------------------------------------------------
int leastOfAll(int own)
{
  int least = own;
  if (vtkMultiProcessController* controller = manyProcesses())
  {
    controller->AllReduce(&own, &least, 1, vtkCommunicator::MIN_OP);
  }
  return least;
}

//------------------------------------------------------------------------------
void requireOneProcess(vtkDataObject* input)
{
  vtkMultiProcessController* controller = manyProcesses();
  if (!controller)
  {
    return;
  }
  std::vector<int> here;
  forEachLeaf(input,
    [&here](unsigned int index, vtkDataSet* data)
    {
      here.resize(std::max<std::size_t>(here.size(), index + 1));
      here[index] = data->GetNumberOfCells() > 0;
    });
  const int own = static_cast<int>(here.size());
  int size = own;
  controller->AllReduce(&own, &size, 1, vtkCommunicator::MAX_OP);
  here.resize(size, 0);
  std::vector<int> processes(size, 0);
  if (size > 0)
  {
    controller->AllReduce(here.data(), processes.data(), size, vtkCommunicator::SUM_OP);
  }
  const int most = size > 0 ? *std::max_element(processes.begin(), processes.end()) : 0;
  if (most > 1)
  {
    throw Error("The mesh is spread over " + std::to_string(most) +
      " processes, and the boundary of a part is not that of the mesh: gather it on one process "
      "first, "
      "in ParaView by Aggregate Dataset.");
  }
}
}
