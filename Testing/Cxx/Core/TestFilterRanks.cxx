// Filters that do not support several processes reject a mesh that is not on the first one, on all
// processes and by name; a mesh on the first process alone is taken there.
#include "Check.h"
#include "VtkMeshes.h"

#include "vtkHorizonNeighbors.h"
#include "vtkInteractionLayer.h"
#include "vtkMeshComparison.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"
#include "vtkPeridynamicStiffness.h"

#include "vtkDataSet.h"
#include "vtkMPIController.h"
#include "vtkMultiBlockDataSet.h"

using namespace tautline;

namespace
{
vtkSmartPointer<vtkUnstructuredGrid> square()
{
  MeshData data = blockMesh(CellType::Triangle, 6, 6, 0);
  data.transform([](Vec3 p) { return (1.0 / 6) * p; });
  return toGrid(data);
}

vtkIdType cellsOf(vtkAlgorithm* filter)
{
  vtkDataObject* output = filter->GetOutputDataObject(0);
  return output->GetNumberOfElements(vtkDataObject::CELL);
}

/// @param input sets the input of the filter
template <class Filter, class Input>
void testFilter(const char* name, int rank, const Input& input)
{
  const Context context(name);
  vtkNew<Filter> filter;
  Messages messages(filter);
  const std::string refusal = std::string(name) + " does not support meshes on several processes";
  const auto run = [&](bool here)
  {
    messages.clear();
    // A new one each time, so that all processes execute.
    input(filter.Get(), here ? square() : vtkSmartPointer<vtkUnstructuredGrid>::New());
    filter->Update();
  };
  run(true); // a part on each
  TAUTLINE_CHECK(messages.has(refusal));
  TAUTLINE_CHECK(messages.has("Aggregate Dataset"));
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), 0);
  run(rank == 1); // whole, but not where the tables and the summary are taken from
  TAUTLINE_CHECK(messages.has(refusal));
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), 0);
  run(rank == 0);
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(cellsOf(filter) > 0, rank == 0);
  // Blocks: how many a process has differs, and none waits for another.
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (int i = 0; i <= rank; ++i)
  {
    blocks->SetBlock(static_cast<unsigned int>(i), square());
  }
  messages.clear();
  input(filter.Get(), blocks.Get());
  filter->Update();
  TAUTLINE_CHECK(messages.has(refusal));
}
}

//------------------------------------------------------------------------------
int TestFilterRanks(int argc, char* argv[])
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  const int rank = controller->GetLocalProcessId();
  const auto one = [](auto* filter, vtkDataObject* data) { filter->SetInputDataObject(0, data); };
  testFilter<vtkMeshOptimizer>("Optimize Mesh", rank, one);
  testFilter<vtkMeshUntangler>("Untangle Mesh", rank, one);
  testFilter<vtkMeshPerturbation>("Perturb Mesh", rank, one);
  testFilter<vtkInteractionLayer>("Interaction Layer", rank, one);
  testFilter<vtkHorizonNeighbors>("Horizon Neighbors", rank, one);
  testFilter<vtkPeridynamicStiffness>("Peridynamic Condition", rank,
    [](vtkPeridynamicStiffness* filter, vtkDataObject* data)
    {
      filter->SetConstrained(false);
      filter->SetInputDataObject(0, data);
    });
  testFilter<vtkMeshComparison>("Compare Meshes", rank,
    [](vtkMeshComparison* filter, vtkDataObject* data)
    {
      filter->SetInputDataObject(0, data);
      filter->SetInputDataObject(1, data);
    });
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return exitCode();
}
