// Warp Mesh on several processes: a distributed mesh is rejected by all of them, one that is whole
// on a process is warped there.
#include "WarpingMeshes.h"

#include "vtkMPIController.h"
#include "vtkMultiBlockDataSet.h"

using namespace tautline;

namespace
{
void setUp(vtkMeshWarp* filter)
{
  filter->SetMethod(vtkMeshWarp::FEMWARP);
  filter->SetTransformKind(vtkMeshWarp::ROTATION);
  filter->SetAngle(20);
}

void testRanks(int rank)
{
  const MeshData data = holedBlock(CellType::Triangle, 5);
  vtkNew<vtkUnstructuredGrid> nothing;
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  setUp(filter);
  filter->SetInputData(toGrid(data));
  filter->Update();
  TAUTLINE_CHECK(messages.has("gather it on one process first"));
  TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfPoints(), 0);
  messages.clear();

  // Whole on the first process, empty on the others.
  filter->SetInputData(rank == 0 ? toGrid(data) : vtkSmartPointer<vtkUnstructuredGrid>(nothing));
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfCells(), rank == 0 ? data.numberOfCells() : 0);
  TAUTLINE_CHECK(rank > 0 || contains(filter->GetSummary(), "elements are valid"));

  // A block on each; the others are null, and how many blocks are listed differs.
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(rank, toGrid(data));
  filter->SetInputData(blocks);
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  auto* own = vtkPointSet::SafeDownCast(output->GetBlock(rank));
  TAUTLINE_CHECK_EQUAL(own->GetNumberOfCells(), data.numberOfCells());
  TAUTLINE_CHECK(distance(withPointsOf(data, own), data) > 0.1);

  // If one cannot, none does.
  MeshData tangled = data;
  if (rank == 1)
  {
    std::swap(tangled.points[0], tangled.points[3]);
  }
  blocks->SetBlock(rank, toGrid(tangled));
  blocks->Modified();
  messages.clear();
  filter->Update();
  TAUTLINE_CHECK(messages.has(rank == 1 ? "Untangle Mesh" : "Another process could not warp"));
  blocks->SetBlock(rank, toGrid(data));
  blocks->Modified();
  messages.clear();
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
}
}

//------------------------------------------------------------------------------
int TestMeshWarpRanks(int argc, char* argv[])
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  testRanks(controller->GetLocalProcessId());
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return exitCode();
}
