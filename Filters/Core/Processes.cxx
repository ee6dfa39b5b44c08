// SPDX-License-Identifier: BSD-3-Clause
#include "Processes.h"

#include "Blocks.h"
#include "ProcessGroup.h"

#include "vtkAlgorithm.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkMultiProcessController.h"

#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#endif

#include <algorithm>
#include <numeric>
#include <string>

namespace tautline
{
namespace
{
int ofOneProcess = 0; // number of OneProcess objects
}

//------------------------------------------------------------------------------
OneProcess::OneProcess()
{
  ++ofOneProcess;
}

//------------------------------------------------------------------------------
OneProcess::~OneProcess()
{
  --ofOneProcess;
}

//------------------------------------------------------------------------------
vtkMultiProcessController* severalProcesses()
{
  vtkMultiProcessController* controller =
    ofOneProcess > 0 ? nullptr : vtkMultiProcessController::GetGlobalController();
  return controller && controller->GetNumberOfProcesses() > 1 ? controller : nullptr;
}

//------------------------------------------------------------------------------
int minimumOverProcesses(int own)
{
  int minimum = own;
  if (vtkMultiProcessController* controller = severalProcesses())
  {
    controller->AllReduce(&own, &minimum, 1, vtkCommunicator::MIN_OP);
  }
  return minimum;
}

//------------------------------------------------------------------------------
std::string firstProblem(const std::string& own)
{
  vtkMultiProcessController* controller = severalProcesses();
  if (!controller)
  {
    return own;
  }
  const int rank = controller->GetLocalProcessId(), count = controller->GetNumberOfProcesses();
  const int first = minimumOverProcesses(own.empty() ? count : rank);
  if (first == count)
  {
    return "";
  }
  std::string message = own;
  auto length = static_cast<vtkIdType>(message.size());
  controller->Broadcast(&length, 1, first);
  message.resize(static_cast<std::size_t>(length));
  controller->Broadcast(&message[0], length, first);
  return "In process " + std::to_string(first) + ": " + message;
}

//------------------------------------------------------------------------------
bool isScattered(vtkDataObject* input)
{
  vtkMultiProcessController* all = severalProcesses();
  const bool here = all && all->GetLocalProcessId() > 0 && input &&
    input->GetNumberOfElements(vtkDataObject::CELL) > 0;
  return minimumOverProcesses(here ? 0 : 1) == 0;
}

//------------------------------------------------------------------------------
void requireOneProcess(vtkDataObject* input)
{
  vtkMultiProcessController* controller = severalProcesses();
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
  const int maximum = size > 0 ? *std::max_element(processes.begin(), processes.end()) : 0;
  if (maximum > 1)
  {
    throw Error("The mesh is distributed over " + std::to_string(maximum) +
      " processes, and the boundary of a part is not the boundary of the mesh: gather it on one "
      "process first, in ParaView with Aggregate Dataset.");
  }
}

namespace
{
Index cellsOf(vtkDataObject* input)
{
  Index cells = 0;
  if (input)
  {
    forEachLeaf(
      input, [&cells](unsigned int, vtkDataSet* data) { cells += data->GetNumberOfCells(); });
  }
  return cells;
}

[[noreturn]] void refuseProcesses(const std::string& filter, const std::string& having)
{
  throw Error(filter + " does not support meshes on several processes, and " + having +
    " have cells: gather the mesh on the first process, in ParaView with Aggregate Dataset and one "
    "process, or run ParaView with one process.");
}
}

//------------------------------------------------------------------------------
void requireFirstProcess(vtkDataObject* input, const char* filter)
{
  vtkMultiProcessController* controller = severalProcesses();
  if (!controller)
  {
    return;
  }
  const int own = cellsOf(input) > 0;
  const int elsewhere = own != 0 && controller->GetLocalProcessId() > 0;
  int having = own, notFirst = elsewhere;
  controller->AllReduce(&own, &having, 1, vtkCommunicator::SUM_OP);
  controller->AllReduce(&elsewhere, &notFirst, 1, vtkCommunicator::SUM_OP);
  if (notFirst > 0)
  {
    refuseProcesses(
      filter, std::to_string(having) + " of " + std::to_string(controller->GetNumberOfProcesses()));
  }
}

//------------------------------------------------------------------------------
void requireFirstProcess(vtkAlgorithm* filter, int port, vtkDataObject* input, const char* name)
{
  if (!vtkCompositeDataSet::SafeDownCast(filter->GetInputDataObject(port, 0)))
  {
    requireFirstProcess(input, name);
    return;
  }
  vtkMultiProcessController* controller = severalProcesses();
  if (controller && controller->GetLocalProcessId() > 0 && cellsOf(input) > 0)
  {
    refuseProcesses(name, "processes other than the first");
  }
}
}
