// SPDX-License-Identifier: BSD-3-Clause
// Motions of Warp Mesh to a target on processes where ids contradict what else points could
// correspond by.
#include "Registry.h"
#include "WarpingRanks.h"

using namespace tautline;

namespace
{
/// The piece in its new place, with global ids.
vtkSmartPointer<vtkUnstructuredGrid> shearedOf(const RankPart& part)
{
  auto grid = numberedGridOf(part);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    const Vec3 p = tautline::pointOf(grid, i);
    const Vec3 moved = { p[0] + 0.1 * p[1], p[1] + 0.02 * p[0] * p[0], p[2] };
    grid->GetPoints()->SetPoint(i, moved.data());
  }
  return grid;
}

/// A mesh of two pieces with the same numbers of points and cells, and a target with these pieces
/// the other way round: the global ids count, not the numbers.
void testSwapped(vtkMPIController* controller, int correspondence)
{
  const Context context("swapped " + std::to_string(correspondence));
  constexpr Index half = 4;
  const int rank = controller->GetLocalProcessId();
  const MeshData whole = blockMesh(CellType::Triangle, 2 * half, half, 0);
  const Mesh mesh(whole.view());
  const auto side = [&mesh](Index cell)
  { return mesh.center(cell, CellType::Triangle)[0] < half ? 0 : 1; };
  const RankPart part = partOf(whole, rank, side);
  const RankPart other = partOf(whole, rank, [&side](Index cell) { return 1 - side(cell); });
  TAUTLINE_CHECK(part.data.connectivity == other.data.connectivity); // alike but for the places
  const auto setTo = [correspondence](const RankPart& of)
  {
    return [&of, correspondence](vtkMeshWarp* filter)
    {
      filter->SetMotion(vtkMeshWarp::TARGET);
      filter->SetInputData(1, shearedOf(of));
      filter->SetMethod(vtkMeshWarp::FEMWARP);
      filter->SetCorrespondence(correspondence);
    };
  };
  const RankPart all = partOf(whole, 0, [](Index) { return 0; });
  vtkNew<vtkMeshWarp> serial, filter, same;
  const std::vector<double> expected = alone(controller, whole, setTo(all), serial.Get());
  TAUTLINE_CHECK(farthest(expected, whole.points) > 0.1);
  TAUTLINE_CHECK(
    farthest(pointsOf(whole, part, setTo(other), filter.Get(), true), expected) <= 1e-10);
  TAUTLINE_CHECK(farthest(pointsOf(whole, part, setTo(part), same.Get(), true), expected) <= 1e-10);
  for (vtkMeshWarp* one : { serial.Get(), filter.Get(), same.Get() })
  {
    TAUTLINE_CHECK(contains(one->GetSummary(), wording("as-the-same-mesh-point-by-point")));
    TAUTLINE_CHECK(!contains(one->GetSummary(), wording("put-together")));
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestMeshWarpTargetIds)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_RUN(testSwapped(controller, vtkMeshWarp::AUTOMATIC_MATCH));
  TAUTLINE_RUN(testSwapped(controller, vtkMeshWarp::SAME_MESH));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
