// SPDX-License-Identifier: BSD-3-Clause
// Motions of Warp Mesh to a target on processes: by ids, by the closest points, in the pieces of
// the mesh or in others; targets that have lost the order of their points are rejected.
#include "Registry.h"
#include "WarpingRanks.h"

using namespace tautline;

namespace
{
/// The mesh with the hole turned and stretched, and the points' ids.
vtkSmartPointer<vtkUnstructuredGrid> targetOf(
  const RankPart& part, double middle, double angle, bool numbered = false)
{
  auto grid = numbered ? numberedGridOf(part) : gridOf(part);
  TAUTLINE_NEW(vtkPoints, points, SetDataTypeToDouble());
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    Vec3 p = tautline::pointOf(grid, i);
    const double x = p[0] - middle, y = p[1] - middle;
    if (std::max(std::abs(x), std::abs(y)) < 1)
    {
      p[0] = middle + 1.2 * (std::cos(angle) * x - std::sin(angle) * y);
      p[1] = middle + std::sin(angle) * x + std::cos(angle) * y;
    }
    points->InsertNextPoint(p.data());
  }
  grid->SetPoints(points);
  return grid;
}

vtkSmartPointer<vtkDoubleArray> idsOf(const RankPart& part)
{
  return arrayOf("number", static_cast<Index>(part.pointOf.size()), 1,
    [&part](Index i, int) { return 1000.0 + static_cast<double>(part.pointOf[i]); });
}

/// Motions to a target: the pieces of the mesh, or other pieces and ids, or a surface.
void testTargets(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("target");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  constexpr double angle = 0.3;
  const auto all = [](Index) { return 0; };
  const RankPart entire = partOf(whole, 0, all);
  const RankPart nothing = partOf(whole, 1, all);
  const struct
  {
    const char* name;
    int correspondence, part;
    Cut cut;         ///< of the target
    const char* ids; ///< or none
    const char* how; ///< in the summary
    bool numbered;   ///< whether mesh and target have global ids
  } cases[] = {
    { "same pieces", vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::AUTOMATIC_PART, Cut::Random,
      nullptr, "as the same mesh, point by point: ", false },
    { "same mesh", vtkMeshWarp::SAME_MESH, vtkMeshWarp::INNER_BOUNDARIES, Cut::Random, nullptr,
      "as the same mesh, point by point: ", false },
    { "ids, cut otherwise", vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::AUTOMATIC_PART, Cut::Slabs,
      "number", "by point ids: ", false },
    { "ids, on the first", vtkMeshWarp::POINT_IDS, vtkMeshWarp::INNER_BOUNDARIES, Cut::FirstOnly,
      "number", "by point ids: ", false },
    { "closest, cut otherwise", vtkMeshWarp::CLOSEST_POINT, vtkMeshWarp::INNER_BOUNDARIES,
      Cut::Slabs, nullptr, "by projection: ", false },
    { "closest, on the first", vtkMeshWarp::CLOSEST_POINT, vtkMeshWarp::INNER_BOUNDARIES,
      Cut::FirstOnly, nullptr, "by projection: ", false },
    { "closest, same pieces", vtkMeshWarp::CLOSEST_POINT, vtkMeshWarp::WHOLE_BOUNDARY, Cut::Random,
      nullptr, "by projection: ", false },
    { "closest, by global ids", vtkMeshWarp::CLOSEST_POINT, vtkMeshWarp::INNER_BOUNDARIES,
      Cut::Slabs, nullptr, "by projection: ", true },
    { "same mesh, on the first", vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::AUTOMATIC_PART,
      Cut::FirstOnly, nullptr, "as the same mesh, point by point: ", true },
    { "numbers of points", vtkMeshWarp::POINT_IDS, vtkMeshWarp::INNER_BOUNDARIES, Cut::Slabs,
      "index", "by point ids: ", true },
    { "same mesh, cut otherwise", vtkMeshWarp::SAME_MESH, vtkMeshWarp::INNER_BOUNDARIES, Cut::Slabs,
      nullptr, "as the same mesh, point by point: ", true },
  };
  for (const auto& one : cases)
  {
    const Context inner(one.name);
    const auto setTo = [&](const RankPart& part, const RankPart& other)
    {
      return [&one, &part, &other, middle](vtkMeshWarp* filter)
      {
        auto* input = vtkUnstructuredGrid::SafeDownCast(filter->GetInputDataObject(0, 0));
        input->GetPointData()->AddArray(idsOf(part));
        const auto target = targetOf(other, middle, angle, one.numbered);
        target->GetPointData()->AddArray(idsOf(other));
        target->GetPointData()->AddArray(arrayOf("index", other.data.numberOfPoints(), 1,
          [&other](Index i, int) { return static_cast<double>(other.pointOf[i]); }));
        TAUTLINE_SET(filter, SetMotion(vtkMeshWarp::TARGET), SetInputData(1, target),
          SetMethod(vtkMeshWarp::FEMWARP), SetAmount(0.8), SetCorrespondence(one.correspondence),
          SetMovedPart(one.part), SetTargetIds(one.ids));
      };
    };
    vtkNew<vtkMeshWarp> serial, filter;
    const std::vector<double> expected =
      alone(controller, whole, setTo(entire, entire), serial.Get());
    TAUTLINE_CHECK(farthest(expected, whole.points) > 0.05);
    const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
    const RankPart other = partOf(whole, rank, cutBy(whole, one.cut, size), one.cut == Cut::Slabs);
    const std::vector<double> here =
      pointsOf(whole, part, setTo(part, other), filter.Get(), one.numbered);
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("put-together")));
    TAUTLINE_CHECK(farthest(here, expected) <= 1e-10);
    const std::string summary = serial->GetSummary();
    const std::size_t at = summary.find(one.how);
    TAUTLINE_CHECK(at != std::string::npos);
    const std::string line = summary.substr(at, summary.find('\n', at) - at);
    TAUTLINE_CHECK(contains(filter->GetSummary(), line));
  }
}

/// A defect of the target on one process is an error on all.
void testWrongTarget(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("wrong target");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Slabs, size));
  const RankPart other = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  const auto shift = [](vtkUnstructuredGrid* target)
  {
    for (vtkIdType i = 0; i < target->GetNumberOfPoints(); ++i)
    {
      const Vec3 p = tautline::pointOf(target, i) + Vec3{ 0, 0, 0.5 };
      target->GetPoints()->SetPoint(i, p.data());
    }
  };
  enum Way
  {
    Pieces,
    Ids,
    Order,
    Torn
  };
  for (const Way way : { Pieces, Ids, Order, Torn })
  {
    const Context inner("way " + std::to_string(way));
    const RankPart& of = way >= Order ? other : part;
    const auto grid = TAUTLINE_CHANGED(numberedGridOf(part), GetPointData()->AddArray(idsOf(part)));
    const auto target = targetOf(of, middle, 0.3, true);
    const auto ids = idsOf(of);
    if (rank == size - 1)
    {
      // A corner, not at the seam, where the other process also has the point.
      vtkIdType far = 0;
      for (vtkIdType i = 0; i < target->GetNumberOfPoints(); ++i)
      {
        const Vec3 p = tautline::pointOf(target, i), q = tautline::pointOf(target, far);
        far = p[0] + p[1] + p[2] > q[0] + q[1] + q[2] ? i : far;
      }
      way == Ids      ? ids->SetValue(far, -7)
        : way == Torn ? shift(target)
                      : target->GetPoints()->GetData()->SetComponent(far, 0, NAN);
    }
    target->GetPointData()->AddArray(ids);
    TAUTLINE_NEW(vtkMeshWarp, filter, SetInputData(grid), SetInputData(1, target),
      SetMotion(vtkMeshWarp::TARGET), SetMethod(vtkMeshWarp::FEMWARP),
      SetTargetIds(way == Ids ? "number" : nullptr));
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(way == Ids ? "has 1 values that do not occur in the mesh's array"
        : way == Torn                      ? wording("points-at-different-places-have-the-global")
                                           : "coordinates that are NaN or infinite"));
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfPoints(), 0);
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestMeshWarpTargets)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  const MeshData planar = blockWithHole(CellType::Triangle);
  const MeshData volume = blockWithHole(CellType::Tetrahedron);
  TAUTLINE_RUN(testTargets(controller, planar, 3.5));
  TAUTLINE_RUN(testTargets(controller, volume, 2.5));
  TAUTLINE_RUN(testWrongTarget(controller, volume, 2.5));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
