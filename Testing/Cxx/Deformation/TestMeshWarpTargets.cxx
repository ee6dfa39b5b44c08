// SPDX-License-Identifier: BSD-3-Clause
// Motions of Warp Mesh to a target on processes: by ids, by the closest points, in the pieces of
// the mesh or in others; what has lost the order of its points is refused.
#include "Registry.h"
#include "WarpingRanks.h"

#include "vtkCellArray.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkFeatureEdges.h"
#include "vtkIdTypeArray.h"
#include "vtkPolyData.h"

using namespace tautline;

namespace
{
/// The mesh with the hole turned and stretched, and the points' ids.
vtkSmartPointer<vtkUnstructuredGrid> targetOf(
  const RankPart& part, double middle, double angle, bool numbered = false)
{
  auto grid = numbered ? numberedGridOf(part) : gridOf(part);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
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
        filter->SetMotion(vtkMeshWarp::TARGET);
        filter->SetInputData(1, target);
        filter->SetMethod(vtkMeshWarp::FEMWARP);
        filter->SetAmount(0.8);
        filter->SetCorrespondence(one.correspondence);
        filter->SetMovedPart(one.part);
        filter->SetTargetIds(one.ids);
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
    TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("put-together")));
    TAUTLINE_CHECK(farthest(here, expected) <= 1e-10);
    const std::string summary = serial->GetSummary();
    const std::size_t at = summary.find(one.how);
    TAUTLINE_CHECK(at != std::string::npos);
    const std::string line = summary.substr(at, summary.find('\n', at) - at);
    TAUTLINE_CHECK(contains(filter->GetSummary(), line));
  }
}

/// Targets whose pieces are not those of the mesh to the last bit, or not at all.
void testOtherPieces(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("other pieces");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  constexpr double angle = 0.3;
  const RankPart entire = partOf(whole, 0, [](Index) { return 0; });
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  const auto setTo = [&](vtkUnstructuredGrid* target, int correspondence)
  {
    return [=](vtkMeshWarp* filter)
    {
      filter->SetMotion(vtkMeshWarp::TARGET);
      filter->SetInputData(1, target);
      filter->SetMethod(vtkMeshWarp::FEMWARP);
      filter->SetCorrespondence(correspondence);
      filter->SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY);
    };
  };
  const auto shifted = [&](const RankPart& of, double shift)
  {
    const auto target = targetOf(of, middle, angle);
    for (vtkIdType i = 0; i < target->GetNumberOfPoints(); ++i)
    {
      const Vec3 p = tautline::pointOf(target, i) + Vec3{ shift, -shift, 0 };
      target->GetPoints()->SetPoint(i, p.data());
    }
    return target;
  };
  {
    const Context inner("rounding at seams");
    constexpr double rounding = 1e-15;
    vtkNew<vtkMeshWarp> serial, filter;
    const std::vector<double> expected = alone(controller, whole,
      setTo(targetOf(entire, middle, angle), vtkMeshWarp::SAME_MESH), serial.Get());
    const auto target = shifted(part, rank * rounding);
    const std::vector<double> here =
      pointsOf(whole, part, setTo(target, vtkMeshWarp::SAME_MESH), filter.Get());
    TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("put-together")));
    TAUTLINE_CHECK(farthest(here, expected) <= 1e-12);
    TAUTLINE_CHECK(farthest(here, whole.points) > 0.05);
    // The copies of a point on several processes are in one place, bitwise.
    for (const double sign : { 1.0, -1.0 })
    {
      std::vector<double> mine(here), most(here.size());
      std::transform(mine.begin(), mine.end(), mine.begin(),
        [sign](double x) { return x == HUGE_VAL ? -HUGE_VAL : sign * x; });
      controller->AllReduce(
        mine.data(), most.data(), static_cast<vtkIdType>(most.size()), vtkCommunicator::MAX_OP);
      for (std::size_t i = 0; i < here.size(); ++i)
      {
        TAUTLINE_CHECK(here[i] == HUGE_VAL || mine[i] == most[i]);
      }
    }
  }
  {
    // Cells whose points are listed from another one on; by the places in the pieces, without ids.
    const Context inner("same pieces, other cells");
    const auto rolled = [&](const RankPart& of)
    {
      const auto target = targetOf(of, middle, angle);
      vtkNew<vtkCellArray> cells;
      vtkNew<vtkIdList> ids;
      for (vtkIdType cell = 0; cell < target->GetNumberOfCells(); ++cell)
      {
        target->GetCellPoints(cell, ids);
        std::rotate(ids->begin(), ids->begin() + 1, ids->begin() + 3);
        cells->InsertNextCell(ids);
      }
      const int type = static_cast<int>(whole.types[0]);
      target->SetCells(type, cells);
      return target;
    };
    vtkNew<vtkMeshWarp> serial, filter;
    const std::vector<double> expected =
      alone(controller, whole, setTo(rolled(entire), vtkMeshWarp::AUTOMATIC_MATCH), serial.Get());
    const std::vector<double> here =
      pointsOf(whole, part, setTo(rolled(part), vtkMeshWarp::AUTOMATIC_MATCH), filter.Get());
    TAUTLINE_CHECK(contains(serial->GetSummary(), wording("as-the-same-mesh-point-by-point-2")));
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("as-the-same-mesh-point-by-point-2")));
    TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("put-together")));
    TAUTLINE_CHECK(farthest(here, expected) <= 1e-10);
  }
  {
    // Half of the cells list their points in the opposite order, so that the mesh is gathered.
    const Context inner("same pieces, put together");
    MeshData turned = whole;
    for (Index cell = 0; cell < turned.numberOfCells(); cell += 2)
    {
      std::swap(
        turned.connectivity[turned.offsets[cell]], turned.connectivity[turned.offsets[cell] + 1]);
    }
    const RankPart all = partOf(turned, 0, [](Index) { return 0; });
    const RankPart here = partOf(turned, rank, cutBy(turned, Cut::Random, size));
    vtkNew<vtkMeshWarp> serial, filter;
    const std::vector<double> expected = alone(controller, turned,
      setTo(targetOf(all, middle, angle), vtkMeshWarp::SAME_MESH), serial.Get());
    const std::vector<double> found = pointsOf(
      turned, here, setTo(targetOf(here, middle, angle), vtkMeshWarp::SAME_MESH), filter.Get());
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("put-together")));
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("as-the-same-mesh-point-by-point-2")));
    TAUTLINE_CHECK(farthest(found, expected) <= 1e-10);
  }
  {
    // All of both is on the first process, and the mesh is divided among all.
    const Context inner("in one place");
    vtkNew<vtkMeshWarp> serial, filter;
    vtkNew<vtkDataSetSurfaceFilter> surface;
    surface->SetInputData(targetOf(entire, middle, angle));
    surface->Update();
    const auto extracted = [&](int match)
    {
      return [&, match](vtkMeshWarp* each)
      {
        setTo(nullptr, match)(each);
        vtkNew<vtkPolyData> nothing;
        const bool here = each->GetInputDataObject(0, 0)->GetNumberOfElements(0) > 0;
        each->SetInputData(1, here ? surface->GetOutput() : nothing.Get());
        each->SetRedistribute(vtkMeshWarp::KD_TREE);
      };
    };
    for (const int match : { vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::SAME_BOUNDARY })
    {
      const std::vector<double> expected = alone(controller, whole, extracted(match), serial.Get());
      const RankPart first = partOf(whole, rank, [](Index) { return 0; });
      const std::vector<double> here = pointsOf(whole, first, extracted(match), filter.Get());
      TAUTLINE_CHECK(farthest(expected, whole.points) > 0.05);
      TAUTLINE_CHECK(farthest(here, expected) <= 1e-10);
      TAUTLINE_CHECK(contains(filter->GetSummary(), wording("divided-anew-among")));
      const std::string summary = serial->GetSummary();
      const std::size_t at = summary.find(": as the ");
      TAUTLINE_CHECK(at == std::string::npos ||
        contains(filter->GetSummary(), summary.substr(at, summary.find('\n', at) - at)));
    }
  }
  const auto refused = [&](const char* name, vtkUnstructuredGrid* grid, vtkUnstructuredGrid* target,
                         int correspondence, const char* message)
  {
    const Context inner(name);
    vtkNew<vtkMeshWarp> filter;
    filter->SetInputData(grid);
    setTo(target, correspondence)(filter);
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(message));
    TAUTLINE_CHECK_EQUAL(
      vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfPoints(), 0);
  };
  const auto grid = gridOf(part);
  constexpr double apart = 0.5;
  refused("torn", grid, shifted(part, rank * apart), vtkMeshWarp::AUTOMATIC_MATCH,
    wording("the-target-has-different-places"));
  const char* unknown = "without an order of global ids of both";
  for (const Cut cut : { Cut::Slabs, Cut::FirstOnly })
  {
    const RankPart other = partOf(whole, rank, cutBy(whole, cut, size));
    const auto target = targetOf(other, middle, angle);
    for (const int match :
      { vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::SAME_MESH, vtkMeshWarp::SAME_BOUNDARY })
    {
      refused(wording("no-order"), grid, target, match, unknown);
    }
    refused(wording("ids-of-the-target-alone"), grid, targetOf(other, middle, angle, true),
      vtkMeshWarp::AUTOMATIC_MATCH, unknown);
    // Ids that are others than the mesh has.
    const auto others = targetOf(other, middle, angle, true);
    vtkDataArray* ids = others->GetPointData()->GetGlobalIds();
    for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
    {
      const double id = ids->GetComponent(i, 0); // every two are interchanged
      ids->SetComponent(i, 0, std::fmod(id, 2) == 0 ? id + 1 : id - 1);
    }
    for (const int match : { vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::SAME_MESH })
    {
      refused(wording("other-ids"), numberedGridOf(part), others, match,
        cut == Cut::Slabs ? "but not its cells" : unknown);
    }
  }
  if (topology(static_cast<CellType>(whole.types[0])).dimension == 2)
  {
    // The surface of a volume has no boundary that a planar mesh could go to.
    const MeshData volume = blockWithHole(CellType::Tetrahedron);
    const auto closed = toGrid(partOf(volume, rank, cutBy(volume, Cut::Slabs, size)).data);
    refused("closed", grid, closed, vtkMeshWarp::CLOSEST_POINT, wording("it-is-closed"));
  }
  vtkNew<vtkUnstructuredGrid> empty;
  refused("missing", grid, nullptr, vtkMeshWarp::AUTOMATIC_MATCH, wording("there-is-no-target"));
  refused("empty", grid, empty, vtkMeshWarp::AUTOMATIC_MATCH, wording("the-target-is-empty"));
}

/// Every so many cells of a curve or surface, with all points, and the ids of these.
vtkSmartPointer<vtkPolyData> shareOf(vtkPolyData* whole, int rank, int size, bool lines)
{
  auto share = vtkSmartPointer<vtkPolyData>::New();
  share->CopyStructure(whole);
  share->GetPointData()->ShallowCopy(whole->GetPointData());
  vtkNew<vtkCellArray> cells;
  for (vtkIdType i = rank; i < whole->GetNumberOfCells(); i += size)
  {
    cells->InsertNextCell(whole->GetCell(i));
  }
  lines ? share->SetLines(cells) : share->SetPolys(cells);
  return share;
}

/// The boundary of a mesh, cut otherwise: by global ids, or by numbers of points.
void testBoundaryInPieces(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("boundary in pieces");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart entire = partOf(whole, 0, [](Index) { return 0; });
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Slabs, size));
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(targetOf(entire, middle, 0.3, true));
  surface->PassThroughPointIdsOn();
  surface->Update();
  const auto mine = shareOf(surface->GetOutput(), rank, size, false);
  const auto setTo = [](vtkPolyData* target, int correspondence, const char* ids)
  {
    return [=](vtkMeshWarp* filter)
    {
      filter->SetMotion(vtkMeshWarp::TARGET);
      filter->SetInputData(1, target);
      filter->SetMethod(vtkMeshWarp::FEMWARP);
      filter->SetCorrespondence(correspondence);
      filter->SetTargetIds(ids);
    };
  };
  for (const char* ids : { static_cast<const char*>(nullptr), "vtkOriginalPointIds" })
  {
    for (const int match : { vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::SAME_BOUNDARY })
    {
      const Context inner(ids ? ids : "global ids");
      vtkNew<vtkMeshWarp> serial, filter;
      const std::vector<double> expected =
        alone(controller, whole, setTo(surface->GetOutput(), match, ids), serial.Get());
      const std::vector<double> here =
        pointsOf(whole, part, setTo(mine, match, ids), filter.Get(), true);
      TAUTLINE_CHECK(farthest(expected, whole.points) > 0.05);
      TAUTLINE_CHECK(farthest(here, expected) <= 1e-10);
      TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("put-together")));
      const bool byIds = ids && match == vtkMeshWarp::AUTOMATIC_MATCH;
      TAUTLINE_CHECK(contains(filter->GetSummary(),
        byIds ? "by point ids: " : "as the boundary extracted from the mesh: "));
    }
    // The cells of a surface are what they are; with ids, and below without.
    vtkNew<vtkMeshWarp> one, several;
    const std::vector<double> closest = alone(controller, whole,
      setTo(surface->GetOutput(), vtkMeshWarp::CLOSEST_POINT, nullptr), one.Get());
    const std::vector<double> found =
      pointsOf(whole, part, setTo(mine, vtkMeshWarp::CLOSEST_POINT, nullptr), several.Get());
    TAUTLINE_CHECK(farthest(closest, whole.points) > 0.05);
    TAUTLINE_CHECK(farthest(found, closest) <= 1e-10);
    TAUTLINE_CHECK(!contains(several->GetSummary(), wording("put-together")));
    // Without ids one process has an order, and several have not.
    mine->GetPointData()->SetGlobalIds(nullptr);
    for (const int match : { vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::SAME_BOUNDARY })
    {
      vtkNew<vtkMeshWarp> filter;
      filter->SetInputData(gridOf(part));
      setTo(mine, match, ids)(filter);
      Messages messages(filter);
      filter->Update();
      TAUTLINE_CHECK(messages.has(ids && match == vtkMeshWarp::AUTOMATIC_MATCH
          ? "no numbers that the target could refer to"
          : "without an order of global ids of both"));
    }
    mine->GetPointData()->SetGlobalIds(surface->GetOutput()->GetPointData()->GetGlobalIds());
  }
}

/// The edges of a planar mesh, all of them or those of the hole, cut otherwise.
void testCurves(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("curves");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart entire = partOf(whole, 0, [](Index) { return 0; });
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(targetOf(entire, middle, 0.3, true));
  surface->Update();
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputConnection(surface->GetOutputPort());
  edges->FeatureEdgesOff();
  edges->NonManifoldEdgesOff();
  edges->ColoringOff();
  edges->Update();
  vtkPolyData* rim = edges->GetOutput();
  // The points of the hole, in the order of the mesh.
  std::map<Index, vtkIdType> inner;
  vtkDataArray* ids = rim->GetPointData()->GetArray("point ids");
  for (vtkIdType i = 0; i < rim->GetNumberOfPoints(); ++i)
  {
    const Vec3 p = tautline::pointOf(rim, i);
    if (std::max(std::abs(p[0] - middle), std::abs(p[1] - middle)) < 1)
    {
      inner[static_cast<Index>(ids->GetComponent(i, 0))] = i;
    }
  }
  vtkNew<vtkPolyData> hole;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> numbers;
  numbers->SetName("point ids");
  std::map<vtkIdType, vtkIdType> at;
  for (const auto& [id, i] : inner)
  {
    at[i] = points->InsertNextPoint(rim->GetPoint(i));
    numbers->InsertNextValue(id);
  }
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIdList> ends;
  for (vtkIdType cell = 0; cell < rim->GetNumberOfCells(); ++cell)
  {
    rim->GetCellPoints(cell, ends);
    if (at.count(ends->GetId(0)) > 0)
    {
      lines->InsertNextCell({ at[ends->GetId(0)], at[ends->GetId(1)] });
    }
  }
  hole->SetPoints(points);
  hole->SetLines(lines);
  hole->GetPointData()->SetGlobalIds(numbers);
  rim->GetPointData()->SetGlobalIds(ids);
  TAUTLINE_CHECK_EQUAL(hole->GetNumberOfPoints(), 4);
  for (const bool all : { true, false })
  {
    vtkPolyData* curve = all ? rim : hole.Get();
    const auto mine = shareOf(curve, rank, size, true);
    for (const int match : { vtkMeshWarp::AUTOMATIC_MATCH, vtkMeshWarp::SAME_BOUNDARY })
    {
      const Context inside(all ? "all" : "hole");
      const auto setTo = [match](vtkPolyData* target)
      {
        return [=](vtkMeshWarp* filter)
        {
          filter->SetMotion(vtkMeshWarp::TARGET);
          filter->SetInputData(1, target);
          filter->SetMethod(vtkMeshWarp::FEMWARP);
          filter->SetCorrespondence(match);
        };
      };
      vtkNew<vtkMeshWarp> serial, filter;
      const std::vector<double> expected = alone(controller, whole, setTo(curve), serial.Get());
      const std::vector<double> here = pointsOf(whole, part, setTo(mine), filter.Get(), true);
      const char* how = all ? "as the boundary extracted from the mesh: "
                            : "by the order of the points that move: ";
      TAUTLINE_CHECK(contains(serial->GetSummary(), how));
      TAUTLINE_CHECK(contains(filter->GetSummary(), how));
      TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("put-together")));
      TAUTLINE_CHECK(farthest(expected, whole.points) > 0.05);
      TAUTLINE_CHECK(farthest(here, expected) <= 1e-10);
    }
    // One point less is neither the boundary nor what moves.
    const auto fewer = shareOf(curve, rank, size, true);
    fewer->GetPointData()->GetGlobalIds()->SetComponent(0, 0, ids->GetRange()[1] + 1000);
    vtkNew<vtkMeshWarp> filter;
    filter->SetInputData(numberedGridOf(part));
    filter->SetMotion(vtkMeshWarp::TARGET);
    filter->SetInputData(1, fewer);
    filter->SetCorrespondence(vtkMeshWarp::SAME_BOUNDARY);
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(wording("its-cells-are-not-those-of-the")));
  }
}

/// A mesh with a crack, closed as its points coincide: the surface that is extracted has its faces.
void testCrackedMesh(vtkMPIController* controller)
{
  const Context context("cracked mesh");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  MeshData whole = blockMesh(CellType::Tetrahedron, 4, 4, 4);
  const Mesh mesh(whole.view());
  Index middle = 0;
  for (Index i = 0; i < whole.numberOfPoints(); ++i)
  {
    middle = norm(whole.point(i) - Vec3{ 2, 2, 2 }) == 0 ? i : middle;
  }
  std::vector<char> right;
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    right.push_back(mesh.center(cell, CellType::Tetrahedron)[0] > 2);
  }
  const Index twin = whole.addPoint({ 2, 2, 2 });
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    for (Index n = whole.offsets[cell]; right[cell] && n < whole.offsets[cell + 1]; ++n)
    {
      whole.connectivity[n] = whole.connectivity[n] == middle ? twin : whole.connectivity[n];
    }
  }
  const RankPart entire = partOf(whole, 0, [](Index) { return 0; });
  const auto grid = numberedGridOf(entire);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    const Vec3 p = tautline::pointOf(grid, i);
    const Vec3 moved = { p[0] + 0.1 * p[1], p[1] + 0.02 * p[2] * p[2], p[2] };
    grid->GetPoints()->SetPoint(i, moved.data());
  }
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(grid);
  surface->Update();
  const auto mine = shareOf(surface->GetOutput(), rank, size, false);
  const auto setTo = [](vtkPolyData* target)
  {
    return [=](vtkMeshWarp* filter)
    {
      filter->SetMotion(vtkMeshWarp::TARGET);
      filter->SetInputData(1, target);
      filter->SetMethod(vtkMeshWarp::FEMWARP);
      filter->SetCorrespondence(vtkMeshWarp::SAME_BOUNDARY);
    };
  };
  vtkNew<vtkMeshWarp> serial, filter;
  const std::vector<double> expected =
    alone(controller, whole, setTo(surface->GetOutput()), serial.Get());
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  const std::vector<double> here = pointsOf(whole, part, setTo(mine), filter.Get(), true);
  TAUTLINE_CHECK(
    contains(serial->GetSummary(), wording("as-the-boundary-extracted-from-the-mesh")));
  TAUTLINE_CHECK(
    contains(filter->GetSummary(), wording("as-the-boundary-extracted-from-the-mesh")));
  TAUTLINE_CHECK(farthest(expected, whole.points) > 0.3);
  TAUTLINE_CHECK(farthest(here, expected) <= 1e-10);
}

/// A crack within a piece of the target is a part of its surface, a seam is not.
void testCrack(vtkMPIController* controller)
{
  const Context context("crack");
  const int rank = controller->GetLocalProcessId();
  MeshData whole = blockMesh(CellType::Hexahedron, 2, 1, 1);
  for (Index i = 0; i < whole.numberOfPoints(); ++i)
  {
    constexpr double scale = 0.1;
    whole.setPoint(i, scale * whole.point(i) + Vec3{ 1.02, 0.45, 0.45 });
  }
  // Cubes from x = 0 to 1 and 1 to 2 with their own points, and one from 2 to 3 elsewhere.
  const auto targetIn = [](const std::vector<double>& starts)
  {
    MeshData data;
    for (const double start : starts)
    {
      const auto first = static_cast<Index>(data.points.size() / 3);
      const MeshData cube = blockMesh(CellType::Hexahedron, 1, 1, 1);
      for (Index i = 0; i < cube.numberOfPoints(); ++i)
      {
        const Vec3 p = cube.point(i) + Vec3{ start, 0, 0 };
        data.points.insert(data.points.end(), p.begin(), p.end());
      }
      std::vector<Index> nodes(cube.connectivity.begin(), cube.connectivity.end());
      std::transform(
        nodes.begin(), nodes.end(), nodes.begin(), [first](Index n) { return n + first; });
      data.addCell(static_cast<int>(cube.types[0]), nodes);
    }
    return toGrid(data);
  };
  const auto setTo = [](vtkUnstructuredGrid* target)
  {
    return [target](vtkMeshWarp* filter)
    {
      filter->SetMotion(vtkMeshWarp::TARGET);
      filter->SetInputData(1, target);
      filter->SetMethod(vtkMeshWarp::FEMWARP);
      filter->SetCorrespondence(vtkMeshWarp::CLOSEST_POINT);
      filter->SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY);
      filter->SetAmount(0.1);
    };
  };
  const auto here = rank == 0 ? targetIn({ 0, 1 })
    : rank == 1               ? targetIn({ 2 })
                              : vtkSmartPointer<vtkUnstructuredGrid>::New();
  const RankPart part = partOf(whole, rank, [](Index cell) { return static_cast<int>(cell); });
  vtkNew<vtkMeshWarp> filter;
  pointsOf(whole, part, setTo(here), filter.Get());
  // The face at x = 1, 0.22 from the last points; the sides of the cubes are 0.45 away.
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("the-farthest-of-them-0-22")));
  // Two processes that have the same face have it in the inside.
  const auto apart = rank == 0 ? targetIn({ 0 })
    : rank == 1                ? targetIn({ 1 })
                               : vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkMeshWarp> inside;
  pointsOf(whole, part, setTo(apart), inside.Get());
  TAUTLINE_CHECK(contains(inside->GetSummary(), wording("the-farthest-of-them-0-45")));
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
    const auto grid = numberedGridOf(part);
    grid->GetPointData()->AddArray(idsOf(part));
    const auto target = targetOf(of, middle, 0.3, true);
    const auto ids = idsOf(of);
    if (rank == size - 1)
    {
      // A corner, not at the seam, where the other process has the point, too.
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
    vtkNew<vtkMeshWarp> filter;
    filter->SetInputData(grid);
    filter->SetInputData(1, target);
    filter->SetMotion(vtkMeshWarp::TARGET);
    filter->SetMethod(vtkMeshWarp::FEMWARP);
    filter->SetTargetIds(way == Ids ? "number" : nullptr);
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(way == Ids ? "has 1 values that are no values of the mesh's array"
        : way == Torn ? "have the same global id: run Generate Global Ids again"
                      : "coordinates that are NaN or infinite"));
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfPoints(), 0);
  }
}

void testAll(vtkMPIController* controller)
{
  const MeshData planar = blockWithHole(CellType::Triangle);
  const MeshData volume = blockWithHole(CellType::Tetrahedron);
  testTargets(controller, planar, 3.5);
  testTargets(controller, volume, 2.5);
  testOtherPieces(controller, planar, 3.5);
  testOtherPieces(controller, volume, 2.5);
  testBoundaryInPieces(controller, volume, 2.5);
  testCurves(controller, planar, 3.5);
  testCrackedMesh(controller);
  testCrack(controller);
  testWrongTarget(controller, volume, 2.5);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestMeshWarpTargets)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_RUN(testAll(controller));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
