// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh on several processes: a distributed mesh moves as it does on one process.
#include "Processes.h"
#include "Registry.h"
#include "WarpingMeshes.h"
#include "vtkMPIController.h"

using namespace tautline;

namespace
{
void setUp(vtkMeshWarp* filter)
{
  TAUTLINE_SET(
    filter, SetMethod(vtkMeshWarp::FEMWARP), SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(20));
}

/// Every so-many-th cell, with all points: those without a cell stay.
vtkSmartPointer<vtkUnstructuredGrid> piece(const MeshData& whole, Index number, Index count)
{
  TAUTLINE_LET(MeshData, data, points = whole.points);
  for (Index cell = number; cell < whole.numberOfCells(); cell += count)
  {
    data.addCell(static_cast<int>(whole.types[cell]), whole.nodes(cell));
  }
  return toGrid(data);
}

void testRanks(int rank, int ranks)
{
  const MeshData data = holedBlock(CellType::Triangle, 5);
  vtkNew<vtkUnstructuredGrid> nothing;
  vtkNew<vtkMeshWarp> filter, single;
  {
    const OneProcess alone;
    setUp(single);
    TAUTLINE_SET(single, SetInputData(toGrid(data)), Update());
  }
  const MeshData expected = withPointsOf(data, meshOf(single));
  Messages messages(filter);
  setUp(filter);
  // Pieces of all processes.
  TAUTLINE_SET(filter, SetInputData(piece(data, rank, ranks)), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK(distance(expected, data) > 0.1);
  MeshData here = withPointsOf(data, meshOf(filter)), there = expected;
  std::vector<char> used(data.numberOfPoints(), 0);
  for (Index cell = rank; cell < data.numberOfCells(); cell += ranks)
  {
    for (Index n = data.offsets[cell]; n < data.offsets[cell + 1]; ++n)
    {
      used[data.connectivity[n]] = 1;
    }
  }
  for (std::size_t i = 0; i < there.points.size(); ++i)
  {
    there.points[i] = used[i / 3] ? there.points[i] : data.points[i];
  }
  TAUTLINE_CHECK_NEAR(distance(here, there), 0, 1e-10);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("elements-are-valid")));
  messages.clear();

  // Whole on the first process, empty on the others.
  filter->SetInputData(rank == 0 ? toGrid(data) : vtkSmartPointer<vtkUnstructuredGrid>(nothing));
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfCells(), rank == 0 ? data.numberOfCells() : 0);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("elements-are-valid")));
  TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("redistributed")));

  // The same, divided among all.
  for (const int how : { vtkMeshWarp::KD_TREE, vtkMeshWarp::PT_SCOTCH })
  {
    TAUTLINE_SET(filter, SetRedistribute(how), Update());
    TAUTLINE_CHECK(messages.empty());
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfCells(), rank == 0 ? data.numberOfCells() : 0);
    if (rank == 0)
    {
      TAUTLINE_CHECK_NEAR(distance(withPointsOf(data, meshOf(filter)), expected), 0, 1e-10);
    }
    TAUTLINE_CHECK(contains(filter->GetSummary(),
      std::string(wording("redistributed")) + " among " + std::to_string(ranks)));
  }
  filter->RedistributeOff();

  // A block on each; the others are null, and how many blocks are listed differs.
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(rank, toGrid(data)));
  TAUTLINE_SET(filter, SetInputData(blocks), Update());
  TAUTLINE_CHECK(messages.empty());
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  auto* own = vtkPointSet::SafeDownCast(output->GetBlock(rank));
  TAUTLINE_CHECK_EQUAL(own->GetNumberOfCells(), data.numberOfCells());
  TAUTLINE_CHECK(distance(withPointsOf(data, own), data) > 0.1);

  // If one cannot, none does.
  MeshData tangled = data;
  if (rank == 1)
  {
    std::swap(tangled.points[0], tangled.points[3]);
  }
  TAUTLINE_SET(blocks, SetBlock(rank, toGrid(tangled)), Modified());
  messages.clear();
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("untangle-mesh")));
  TAUTLINE_SET(blocks, SetBlock(rank, toGrid(data)), Modified());
  messages.clear();
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestMeshWarpRanks)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_RUN(testRanks(controller->GetLocalProcessId(), controller->GetNumberOfProcesses()));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
