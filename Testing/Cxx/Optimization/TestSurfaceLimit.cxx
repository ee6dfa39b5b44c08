// SPDX-License-Identifier: BSD-3-Clause
// A boundary whose points slide stays within a distance of where it was, and the other way round;
// so does one whose points may leave it to improve the worst elements.
#include "Optimizing.h"
#include "Registry.h"
#include "SurfaceDistance.h"
#include "Surfaces.h"
#include "VtkMeshes.h"
#include "tautline/Mesh/Features.h"
#include "tautline/Optimization/SurfaceLimit.h"
#include "vtkMeshOptimizer.h"

using namespace tautline;

namespace
{
/// A block with a ridge on top, below the angle of features, and points crowded beside it.
MeshData ridge()
{
  constexpr Index n = 6;
  MeshData data = blockMesh(CellType::Hexahedron, n, n, 2);
  Random random(3);
  data.transform(
    [&](Vec3 p)
    {
      const double x = p[0] / n, y = p[1] / n;
      const bool inner = p[0] > 0 && p[0] < n && p[1] > 0 && p[1] < n;
      Vec3 q = { x + (inner ? random.uniform(-0.05, 0.05) : 0), y, 0.2 * p[2] };
      q[0] += inner ? 0.25 * x * (1 - x) : 0;
      q[2] += p[2] > 1 ? 0.25 * (0.5 - std::abs(q[0] - 0.5)) : 0;
      return q;
    });
  return data;
}

struct Outcome
{
  OptimizeResult result;
  double there, back;
};

Outcome runOn(const MeshData& data, double tolerance, int threads = 1)
{
  const Mesh mesh(data.view());
  const Features found = findFeatures(mesh, {});
  const SurfaceModel model = makeSurfaceModel(mesh, found, true);
  const std::vector<std::int32_t> parts = partsOfPoints(found);
  auto fixed =
    collect<unsigned char>(found.kind, [&](signed char kind) { return kind == CornerPoint; });
  TAUTLINE_LET(OptimizeOptions, options, holdWorst = false, fixed = fixed.data(), model = &model,
    parts = parts.data(), surfaceTolerance = tolerance, threads = threads);
  Outcome outcome = { optimize(mesh, options), 0, 0 };
  const std::vector<Triangle> before = boundaryOf(data, data.points),
                              after = boundaryOf(data, outcome.result.points);
  TAUTLINE_SET(outcome, there = distance(after, before), back = distance(before, after));
  return outcome;
}

TAUTLINE_PART(testLimit)
{
  const MeshData data = ridge();
  TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
  const Outcome free = runOn(data, 0);
  const double off = std::max(free.there, free.back);
  TAUTLINE_CHECK(off > 0.01);
  // The result's numbers equal the measurement here, except for the places in between.
  TAUTLINE_CHECK(free.result.surfaceError > 0.8 * off && free.result.surfaceError < 1.05 * off);
  const double start = free.result.history.front().objective,
               unlimited = start - free.result.history.back().objective;
  TAUTLINE_CHECK_EQUAL(free.result.heldOnSurface, Index(0));
  double last = 0;
  for (double tolerance : { 1e-4, 1e-3, 5e-3 })
  {
    const Context context("tolerance " + std::to_string(tolerance));
    const Outcome limited = runOn(data, tolerance);
    TAUTLINE_CHECK(limited.there <= tolerance);
    TAUTLINE_CHECK(limited.back <= tolerance);
    TAUTLINE_CHECK(limited.result.surfaceError <= tolerance);
    const Index held = limited.result.heldOnSurface;
    TAUTLINE_CHECK(held > 0 && held < limited.result.freeVertices);
    // The mesh still improves, the more the wider the limit.
    const double lowered = start - limited.result.history.back().objective;
    TAUTLINE_CHECK(lowered > last && lowered > 0.3 * unlimited);
    last = lowered;
    TAUTLINE_CHECK(runOn(data, tolerance, 2).result.points == limited.result.points);
  }
}

/// The triangles of a surface in space.
std::vector<Triangle> trianglesOf(const MeshData& data, const std::vector<double>& points)
{
  return collect<Triangle>(data.numberOfCells(),
    [&](Index c)
    {
      Triangle t;
      for (int k = 0; k < 3; ++k)
      {
        const double* p = &points[3 * data.connectivity[data.offsets[c] + k]];
        t[k] = { p[0], p[1], p[2] };
      }
      return t;
    });
}

/// A surface in space stays within the default tolerance, both ways, and keeps its volume: one of a
/// CAD program with long facets along fillets, and a fine round one. It still improves.
TAUTLINE_PART(testSurfaces)
{
  MeshData ball = sphereSurface(CellType::Triangle, 12);
  Random random(8);
  ball.transform(
    [&](Vec3 p)
    {
      const Vec3 q =
        p + 0.03 * Vec3{ random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) };
      return (1 / norm(q)) * q;
    });
  for (const bool round : { false, true })
  {
    const MeshData data = round ? ball : roundedBar(4, 2.0, 4, 0.45, 5);
    const double diagonal = round ? 2 * std::sqrt(3.0) : norm({ 2, 2, 8 });
    const std::vector<Triangle> before = trianglesOf(data, data.points);
    for (const int preset : { vtkMeshOptimizer::BEST_SHAPE, vtkMeshOptimizer::WORST_ELEMENT })
    {
      const Context context((round ? "ball, preset " : "bar, preset ") + std::to_string(preset));
      TAUTLINE_NEW(
        vtkMeshOptimizer, filter, SetInputData(toGrid(data)), SetPreset(preset), Update());
      const std::vector<double> points = toMesh(outputOf<vtkUnstructuredGrid>(filter)).points;
      const std::vector<Triangle> after = trianglesOf(data, points);
      constexpr double tolerance = 1e-3;
      TAUTLINE_CHECK(distance(after, before) <= tolerance * diagonal);
      TAUTLINE_CHECK(distance(before, after) <= tolerance * diagonal);
      TAUTLINE_CHECK(filter->GetSurfaceError() <= tolerance * diagonal);
      TAUTLINE_CHECK_RELATIVE(volumeWithin(data, points), volumeWithin(data, data.points), 5e-3);
      TAUTLINE_CHECK(sumOfSquares(data, points, Metric::InverseMeanRatio) <
        0.95 * sumOfSquares(data, data.points, Metric::InverseMeanRatio));
      // Without a tolerance it goes farther: the limit is what holds it.
      TAUTLINE_SET(filter, SetSurfaceTolerance(0.0), Update());
      const std::vector<double> free = toMesh(outputOf<vtkUnstructuredGrid>(filter)).points;
      TAUTLINE_CHECK(distance(before, trianglesOf(data, free)) > distance(before, after));
    }
  }
}

/// Facets are smooth where they are short against the radius of curvature.
TAUTLINE_PART(testLongFacets)
{
  for (const double length : { 0.2, 2.0 })
  {
    const MeshData data = roundedBar(3, length, 6, 0.0, 1);
    const Mesh mesh(data.view());
    const Features found = findFeatures(mesh, {});
    const SurfaceModel model = makeSurfaceModel(mesh, found, true, false, 1.0);
    const double highest = largestOf<double>(0, model.patches,
      [&](int patch) { return static_cast<double>(model.parts[patch].controls.size()); });
    // The strips of the fillets; the flat sides between them, which are wider, stay flat.
    const double strips = 4 * 6 * 2 * 3;
    TAUTLINE_CHECK(length < 0.5 ? highest > 0.5 * strips && highest <= strips : highest == 0);
  }
}

/// The filter's limit is relative to the diagonal, whatever the unit.
TAUTLINE_PART(testFilter)
{
  for (double unit : { 1.0, 1e-3 })
  {
    MeshData data = ridge();
    data.transform([unit](Vec3 p) { return unit * p; });
    const double diagonal = unit * norm({ 1.0, 1.0, 0.525 });
    const auto grid = toGrid(data);
    double errors[2];
    for (int limited = 0; limited < 2; ++limited)
    {
      TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(grid),
        SetBoundary(vtkMeshOptimizer::ON_SURFACE), SetHoldWorst(false));
      TAUTLINE_CHECK(filter->GetSurfaceTolerance() == 0.001);
      TAUTLINE_SET(filter, SetSurfaceTolerance(limited ? 0.001 : 0.0), Update());
      errors[limited] = filter->GetSurfaceError() / diagonal;
      const std::string summary = filter->GetSummary();
      const bool says = contains(summary, wording("surface-tolerance-holds"));
      TAUTLINE_CHECK_EQUAL(says, limited == 1);
    }
    TAUTLINE_CHECK(errors[0] > 0.005);
    TAUTLINE_CHECK(errors[1] <= 0.001 && errors[1] > 0.0003);
  }
}

/// A block of cubes, sheared so that two of its edges have the angle whose tangent is given: no
/// hexahedron there has a larger scaled Jacobian than the sine, as long as the faces are plane.
constexpr Index side = 4;
constexpr double tangent = 1.0, unit = 3.0;
MeshData slantedBlock(CellType type = CellType::Hexahedron)
{
  MeshData data = blockMesh(type, side, side, topology(type).dimension == 3 ? side : 0);
  data.transform([](Vec3 p) { return unit * Vec3{ p[0] + p[1] / tangent, p[1], p[2] }; });
  return data;
}

double worstJacobian(const MeshData& data, const std::vector<double>& points)
{
  MeshView view = TAUTLINE_CHANGED(data.view(), points = points.data());
  std::vector<double> values(view.numberOfCells);
  evaluateMetric(Mesh(view), Metric::ScaledJacobian, {}, values.data());
  return *std::min_element(values.begin(), values.end());
}

struct Leaving
{
  double worst, off;
  Index left; ///< points off the planes of the block
  std::string summary;
  std::vector<double> points;
};

Leaving leave(const MeshData& data, const std::function<void(vtkMeshOptimizer*)>& set)
{
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)),
    SetPreset(vtkMeshOptimizer::WORST_ELEMENT), SetBoundary(vtkMeshOptimizer::ON_SURFACE),
    SetSurfaceTolerance(0.005));
  set(filter);
  filter->Update();
  TAUTLINE_LET(Leaving, result, summary = filter->GetSummary());
  vtkPoints* points = outputOf<vtkPointSet>(filter)->GetPoints();
  for (vtkIdType p = 0; p < points->GetNumberOfPoints(); ++p)
  {
    const double* x = points->GetPoint(p);
    result.points.insert(result.points.end(), x, x + 3);
  }
  result.worst = worstJacobian(data, result.points);
  const std::vector<Triangle> before = boundaryOf(data, data.points),
                              after = boundaryOf(data, result.points);
  TAUTLINE_SET(result, off = std::max(distance(before, after), distance(after, before)), left = 0);
  for (std::size_t p = 0; p < result.points.size() / 3; ++p)
  {
    // The points that were on a plane of the block, in the coordinates of its cubes.
    const auto cubes = [](const double* x) {
      return Vec3{ (x[0] - x[1] / tangent) / unit, x[1] / unit, x[2] / unit };
    };
    const Vec3 was = cubes(&data.points[3 * p]), is = cubes(&result.points[3 * p]);
    bool on = true;
    for (int c = 0; c < 3; ++c)
    {
      const bool plane = std::abs(was[c]) < 1e-9 || std::abs(was[c] - side) < 1e-9;
      on = on && (!plane || std::abs(is[c] - was[c]) < 1e-9);
    }
    result.left += !on;
  }
  return result;
}

/// Where the surface itself bounds the worst element, points leave it, as far as they may.
TAUTLINE_PART_SLOW(testLeaving)
{
  const MeshData data = slantedBlock();
  const double diagonal = unit * side * norm({ 1 + 1 / tangent, 1, 1 });
  const double bound = std::sin(std::atan(tangent));
  const Leaving kept = leave(data, [](vtkMeshOptimizer* f) { f->SetLeaveSurface(false); });
  TAUTLINE_CHECK(kept.worst <= bound + 1e-9);
  TAUTLINE_CHECK_EQUAL(kept.left, Index(0));
  TAUTLINE_CHECK(!contains(kept.summary, wording("left-the-surface")));
  double last = bound;
  for (double tolerance : { 0.001, 0.003, 0.009 })
  {
    const Context context("tolerance " + std::to_string(tolerance));
    const auto set = [&](vtkMeshOptimizer* f) { f->SetSurfaceTolerance(tolerance); };
    const Leaving result = leave(data, set);
    TAUTLINE_CHECK(result.worst > last + 0.004);
    TAUTLINE_CHECK(result.off <= tolerance * diagonal);
    TAUTLINE_CHECK(result.left > 0);
    const std::string says = std::to_string(result.left) + " points of the boundary near";
    TAUTLINE_CHECK(contains(result.summary, says));
    last = result.worst;
    const Leaving again = leave(data,
      [&](vtkMeshOptimizer* f)
      {
        set(f);
        f->SetThreads(2);
      });
    TAUTLINE_CHECK(again.points == result.points);
  }
  // Points that are fixed stay, and so do corners that were given as such, and all with limits.
  std::vector<double> fixed, kinds;
  for (std::size_t p = 0; p < data.points.size() / 3; ++p)
  {
    const bool edge = std::abs(data.points[3 * p + 1]) < 1e-9;
    fixed.push_back(edge);
    kinds.push_back(edge ? 2 : -1);
  }
  const auto moved = [&](const Leaving& result)
  {
    Index count = 0;
    for (std::size_t p = 0; p < fixed.size(); ++p)
    {
      count += fixed[p] != 0 &&
        !std::equal(&data.points[3 * p], &data.points[3 * p] + 3, &result.points[3 * p],
          [](double a, double b) { return std::abs(a - b) < 1e-12; });
    }
    return count;
  };
  TAUTLINE_CHECK(moved(leave(data, [](vtkMeshOptimizer*) {})) > 0);
  for (int index : { 2, 5 })
  {
    const auto grid = toGrid(data);
    const auto array = filledArray<vtkDoubleArray>(
      "Flags", index == 2 ? fixed : kinds, [&](double value) { return value; });
    grid->GetPointData()->AddArray(array);
    const Leaving result = leave(data,
      [&](vtkMeshOptimizer* f)
      {
        f->SetInputData(grid);
        f->SetInputArrayToProcess(index, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Flags");
      });
    TAUTLINE_CHECK_EQUAL(moved(result), Index(0));
    TAUTLINE_CHECK(result.worst > 0.9 * bound);
  }
  const Leaving limited =
    leave(data, [](vtkMeshOptimizer* f) { f->SetMaximumDisplacement(0.5 * unit); });
  TAUTLINE_CHECK_EQUAL(limited.left, Index(0));
}

/// Also planar meshes and simplices; points stay on interfaces; with a Geometry, none leaves.
TAUTLINE_PART(testOtherMeshes)
{
  constexpr double tolerance = 0.005;
  for (CellType type : { CellType::Quadrilateral, CellType::Triangle, CellType::Tetrahedron,
         CellType::Wedge, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const MeshData data = slantedBlock(type);
    const bool volume = topology(type).dimension == 3, simplex = topology(type).samples == 1;
    const double diagonal = unit * side * norm({ 1 + 1 / tangent, 1, volume ? 1.0 : 0.0 });
    const auto grid = toGrid(data);
    // Two regions, below and above half of the height.
    TAUTLINE_NEW(vtkDoubleArray, regions, SetName("Regions"));
    const int up = volume ? 2 : 1;
    for (Index cell = 0; cell < data.numberOfCells(); ++cell)
    {
      double low = unit * side;
      for (Index n = data.offsets[cell]; n < data.offsets[cell + 1]; ++n)
      {
        low = std::min(low, data.points[3 * data.connectivity[n] + up]);
      }
      regions->InsertNextValue(low > unit * (side / 2 - 0.5));
    }
    grid->GetCellData()->AddArray(regions);
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(grid));
    // Sliding uses up what the mean of tetrahedra may get worse by with the preset.
    const double allowance = type == CellType::Tetrahedron ? 0.2 : simplex ? 0.01 : 0.05;
    const bool custom = type == CellType::Tetrahedron;
    TAUTLINE_SET(filter,
      SetPreset(custom ? vtkMeshOptimizer::CUSTOM : vtkMeshOptimizer::WORST_ELEMENT),
      SetImproveWorst(allowance), SetBoundary(vtkMeshOptimizer::ON_SURFACE),
      SetSurfaceTolerance(tolerance));
    double worst[2], mean[2];
    for (const bool withRegions : { true, false })
    {
      for (int leave = 0; leave < 2; ++leave)
      {
        TAUTLINE_SET(filter, SetLeaveSurface(leave == 1),
          SetInputArrayToProcess(
            6, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, withRegions ? "Regions" : ""),
          Update());
        MeshData moved = data;
        moved.points = toMesh(outputOf<vtkUnstructuredGrid>(filter)).points;
        std::vector<double> q(data.numberOfCells()), imr(q.size());
        const Mesh mesh(moved.view());
        evaluateMetric(
          mesh, simplex ? Metric::InverseMeanRatio : Metric::ScaledJacobian, {}, q.data());
        evaluateMetric(mesh, Metric::InverseMeanRatio, {}, imr.data());
        worst[leave] =
          simplex ? -*std::max_element(q.begin(), q.end()) : *std::min_element(q.begin(), q.end());
        mean[leave] =
          std::accumulate(imr.begin(), imr.end(), 0.0) / static_cast<double>(imr.size());
        TAUTLINE_CHECK(filter->GetSurfaceError() <= tolerance * diagonal);
        const std::string summary = filter->GetSummary();
        const bool left = contains(summary, wording("left-the-surface"));
        TAUTLINE_CHECK(withRegions ? !left || leave == 1 : left == (leave == 1));
        for (Index p = 0; withRegions && p < data.numberOfPoints(); ++p)
        {
          if (std::abs(data.point(p)[up] - unit * (side / 2)) < 1e-9)
          {
            TAUTLINE_CHECK_NEAR(moved.point(p)[up], unit * (side / 2), 1e-9);
          }
        }
      }
    }
    TAUTLINE_CHECK(worst[1] > worst[0] + 0.005);
    // The allowance of the mean covers both kinds of rounds together.
    TAUTLINE_CHECK(mean[1] <= mean[0] * (1 + allowance));
    if (type == CellType::Hexahedron)
    {
      MeshData geometry = cubeSurface(CellType::Quadrilateral, side);
      geometry.transform(
        [](Vec3 p) {
          return unit * side * Vec3{ p[0] + p[1] / tangent, p[1], p[2] };
        });
      TAUTLINE_SET(filter, SetInputDataObject(3, toGrid(geometry)), Update());
      TAUTLINE_CHECK(!contains(filter->GetSummary(), wording("left-the-surface")));
    }
  }
}

/// A request to stop in the rounds in which points leave is stated as the reason, with the best so
/// far.
TAUTLINE_PART(testStopping)
{
  const MeshData data = slantedBlock();
  const Mesh mesh(data.view());
  const Features found = findFeatures(mesh, {});
  const SurfaceModel model = makeSurfaceModel(mesh, found, true);
  const std::vector<std::int32_t> parts = partsOfPoints(found);
  std::vector<unsigned char> fixed, leaving;
  for (std::size_t p = 0; p < found.kind.size(); ++p)
  {
    fixed.push_back(found.kind[p] == CornerPoint);
    leaving.push_back(fixed.back() || parts[p] >= 0);
  }
  OptimizeOptions options;
  applyPreset(Preset::WorstElement, options);
  TAUTLINE_SET(options, fixed = fixed.data(), model = &model, parts = parts.data(),
    leaving = leaving.data(),
    surfaceTolerance = 0.01 * unit * side * norm({ 1 + 1 / tangent, 1, 1 }));
  const OptimizeResult whole = optimize(mesh, options);
  TAUTLINE_CHECK(whole.leftSurface > 0);
  TAUTLINE_CHECK(whole.reason != StopReason::Aborted);
  const int last = whole.iterations - 1;
  options.observer = [last](const IterationState& state) { return state.record.iteration < last; };
  const OptimizeResult stopped = optimize(mesh, options);
  TAUTLINE_CHECK(stopped.reason == StopReason::Aborted);
  TAUTLINE_CHECK_EQUAL(stopped.iterations, last);
  TAUTLINE_CHECK(stopped.leftSurface > 0);
  const double bound = std::sin(std::atan(tangent)), worst = worstJacobian(data, stopped.points);
  TAUTLINE_CHECK(worst > bound + 0.004 && worst <= worstJacobian(data, whole.points));
  // Points that may leave need the flags of those that may not move otherwise.
  options.fixed = nullptr;
  TAUTLINE_CHECK_THROWS(optimize(mesh, options), wording("flags-of-the-fixed-points"));
  TAUTLINE_SET(options, fixed = fixed.data(), onGeometry = true);
  TAUTLINE_CHECK_THROWS(optimize(mesh, options), wording("no-other-surface"));
}

/// Steps of one vertex, in cells, of meshes whose cells have the size 1.
class SteppedMesh
{
public:
  static constexpr double limit = 0.02;

  explicit SteppedMesh(MeshData data)
    : Data(std::move(data))
    , TheMesh(Data.view())
    , Fixed(Data.points.size() / 3, 0)
    , Simplices(TheMesh, Fixed.data(), nullptr, 1)
    , Surface(TheMesh, Simplices)
    , Limit(TheMesh, surfaceFacets(TheMesh), Simplices, Surface, limit / Simplices.scale(), true)
  {
  }

  /// Whether the point that is at a place may move by a step; it goes back.
  bool allows(const Vec3& place, const Vec3& step) { return this->move(place, step, false); }
  /// As allows(); the point stays where it may be.
  bool moves(const Vec3& place, const Vec3& step) { return this->move(place, step, true); }

private:
  bool move(const Vec3& place, const Vec3& step, bool stays)
  {
    const Vec3 x = this->Simplices.transform(place);
    for (std::int32_t v = 0; v < this->Simplices.vertices(); ++v)
    {
      double* p = this->Simplices.coordinates() + VertexStride * v;
      const Vec3 before = { p[0], p[1], p[2] };
      if (norm(before - x) > 1e-6)
      {
        continue;
      }
      const Vec3 after = this->Simplices.transform(place + step);
      std::copy(after.begin(), after.end(), p);
      const bool allowed = this->Limit.allows(v, before);
      if (!allowed || !stays)
      {
        std::copy(before.begin(), before.end(), p);
      }
      return allowed;
    }
    throw Error("no point there");
  }

  MeshData Data;
  Mesh TheMesh;
  std::vector<unsigned char> Fixed;
  SimplexMesh Simplices;
  SurfaceProjection Surface;
  SurfaceLimit Limit;
};

/// Vertices slide only on flat parts and along straight edges.
TAUTLINE_PART(testFlatParts)
{
  constexpr Index n = 4;
  for (CellType type : { CellType::Hexahedron, CellType::Tetrahedron })
  {
    SteppedMesh block(blockMesh(type, n, n, n));
    const double off = 2 * SteppedMesh::limit;
    TAUTLINE_CHECK(block.allows({ 2, 2, 4 }, { 0.4, -0.3, 0 }));
    TAUTLINE_CHECK(!block.allows({ 2, 2, 4 }, { 0.4, -0.3, off }));
    TAUTLINE_CHECK(!block.allows({ 2, 2, 4 }, { 0, 0, -off }));
    // Along an edge, but not in one of its two planes, nor beyond the next corner.
    TAUTLINE_CHECK(block.allows({ 4, 2, 4 }, { 0, 0.4, 0 }));
    TAUTLINE_CHECK(!block.allows({ 4, 2, 4 }, { -off, 0.4, 0 }));
    TAUTLINE_CHECK(!block.allows({ 4, 2, 4 }, { 0, 0, -off }));
    TAUTLINE_CHECK(!block.allows({ 4, 3, 4 }, { 0, 1 + off, 0 }));
    TAUTLINE_CHECK(!block.allows({ 3, 3, 4 }, { 1.5, 0, 0 }));
    TAUTLINE_CHECK(!block.allows({ 4, 4, 4 }, { 0, -off, 0 }));
    // Small steps off the plane add up, also beside large ones in it.
    Vec3 at = { 2, 2, 4 };
    const Vec3 step = { 0.01, 0, 0.1 * SteppedMesh::limit };
    int steps = 0;
    for (; steps < 20 && block.moves(at, step); ++steps)
    {
      at += step;
    }
    TAUTLINE_CHECK(steps >= 8 && steps <= 10);
  }

  // A sheet that is bent at x = 2: its border also counts.
  MeshData sheet = blockMesh(CellType::Triangle, n, n, 0);
  sheet.transform(TAUTLINE_PLACE(std::min(p[0], 2.0), p[1], std::max(p[0] - 2, 0.0)));
  SteppedMesh bent(sheet);
  TAUTLINE_CHECK(bent.allows({ 1, 2, 0 }, { 0.3, 0.2, 0 }));
  TAUTLINE_CHECK(bent.allows({ 2, 2, 0 }, { 0, 0.3, 0 }));
  TAUTLINE_CHECK(!bent.allows({ 2, 2, 0 }, { -0.3, 0, 0 }));
  TAUTLINE_CHECK(bent.allows({ 0, 2, 0 }, { 0, 0.3, 0 }));
  TAUTLINE_CHECK(!bent.allows({ 0, 2, 0 }, { 0.3, 0, 0 }));
  TAUTLINE_CHECK(!bent.allows({ 0, 0, 0 }, { 0, 0.3, 0 }));
  TAUTLINE_CHECK(!bent.allows({ 2, 0, 0 }, { 0, 0.3, 0 }));

  SteppedMesh plane(blockMesh(CellType::Quadrilateral, n, n, 0));
  TAUTLINE_CHECK(plane.allows({ 2, 4, 0 }, { 0.4, 0, 0 }));
  TAUTLINE_CHECK(!plane.allows({ 2, 4, 0 }, { 0.4, -0.3, 0 }));
  TAUTLINE_CHECK(!plane.allows({ 3, 4, 0 }, { 1.3, 0, 0 }));
  TAUTLINE_CHECK(!plane.allows({ 4, 4, 0 }, { 0, -0.3, 0 }));
}

/// The tip of a slit, and the front of a crack, do not move on, though facets on both sides are
/// flat; places on the sides do.
TAUTLINE_PART(testCracks)
{
  constexpr Index n = 4;
  for (CellType type : { CellType::Quadrilateral, CellType::Hexahedron })
  {
    const bool volume = type == CellType::Hexahedron;
    MeshData data = blockMesh(type, n, n, volume ? 2 : 0);
    // Points with x < 2 and y = 2 get copies for the cells above.
    const Index cells = data.numberOfCells(), points = data.numberOfPoints();
    std::map<Index, Index> copyOf;
    for (Index p = 0; p < points; ++p)
    {
      const Vec3 x = data.point(p);
      if (x[1] == 2 && x[0] < 2)
      {
        copyOf[p] = data.numberOfPoints();
        data.points.insert(data.points.end(), x.begin(), x.end());
      }
    }
    for (Index c = 0; c < cells; ++c)
    {
      const auto begin = data.connectivity.begin() + data.offsets[c],
                 end = data.connectivity.begin() + data.offsets[c + 1];
      const bool above = std::any_of(begin, end, [&](Index p) { return data.point(p)[1] > 2; });
      std::for_each(begin, end, [&](Index& p) { p = above && copyOf.count(p) ? copyOf[p] : p; });
    }
    SteppedMesh cracked(data);
    const double z = volume ? 1 : 0;
    TAUTLINE_CHECK(!cracked.allows({ 2, 2, z }, { 0.5, 0, 0 }));
    TAUTLINE_CHECK(!cracked.allows({ 2, 2, z }, { -0.5, 0, 0 }));
    TAUTLINE_CHECK(cracked.allows({ 1, 2, z }, { 0.3, 0, 0 }));
    TAUTLINE_CHECK(cracked.allows({ 2, 0, z }, { 0.3, 0, 0 }));
  }
}
}
