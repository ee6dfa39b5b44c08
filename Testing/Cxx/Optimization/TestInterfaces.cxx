// SPDX-License-Identifier: BSD-3-Clause
// Points on interfaces of regions slide on these: they keep their shape in one run and in several,
// within the surface tolerance.
#include "Optimizing.h"
#include "Registry.h"
#include "SurfaceDistance.h"
#include "VtkMeshes.h"
#include "tautline/Mesh/Features.h"
#include "vtkMeshOptimizer.h"

using namespace tautline;

namespace
{
/// A mesh of two regions: 1 within the interface, 0 outside.
struct TwoRegions
{
  MeshData data;
  std::vector<double> regions;
  std::vector<Index> interface; ///< its points
  /// How far a point of the interface is from its axis or center.
  std::function<double(const Vec3&)> radius;
};

/**
 * @brief A block mapped to the shape; its shells of the size `inner`, of `half`, are the interface.
 * @param sizeOf the size of the shell of a point of the cube or square from -1 to 1
 * @param map to the shape
 */
template <class Size, class Map>
TwoRegions mapped(
  CellType type, Index half, Index layers, double inner, const Size& sizeOf, const Map& map)
{
  TAUTLINE_LET(TwoRegions, made, data = blockMesh(type, 2 * half, 2 * half, layers));
  const auto n = static_cast<double>(half), depth = static_cast<double>(layers);
  made.data.transform(TAUTLINE_PLACE(p[0] / n - 1, p[1] / n - 1, 2 * p[2] / depth - 1));
  const double edge = inner / n, rounding = 1e-9;
  for (Index cell = 0; cell < made.data.numberOfCells(); ++cell)
  {
    double size = 0;
    for (Index k = made.data.offsets[cell]; k < made.data.offsets[cell + 1]; ++k)
    {
      size = std::max(size, sizeOf(made.data.point(made.data.connectivity[k])));
    }
    made.regions.push_back(size <= edge + rounding);
  }
  for (Index p = 0; p < made.data.numberOfPoints(); ++p)
  {
    if (std::abs(sizeOf(made.data.point(p)) - edge) < rounding)
    {
      made.interface.push_back(p);
    }
  }
  made.data.transform(map);
  return made;
}

/// Shells of cubes become spheres: their facets are stretched where the edges of the cubes were.
TwoRegions ballInBall(CellType type, Index half, double inner)
{
  const auto size = [](const Vec3& p) {
    return std::max({ std::abs(p[0]), std::abs(p[1]), std::abs(p[2]) });
  };
  TwoRegions made = mapped(type, half, 2 * half, inner, size,
    [&](const Vec3& p) { return norm(p) > 0 ? (size(p) / norm(p)) * p : p; });
  made.radius = [](const Vec3& p) { return norm(p); };
  return made;
}

/// A cylinder through a block, from its top to its bottom.
TwoRegions cylinderInBlock(CellType type, Index half, Index layers)
{
  const auto size = [](const Vec3& p) { return std::max(std::abs(p[0]), std::abs(p[1])); };
  TwoRegions made = mapped(type, half, layers, 0.5 * static_cast<double>(half), size,
    [&](const Vec3& p)
    {
      const double radius = std::hypot(p[0], p[1]), round = std::clamp(2 - 2 * size(p), 0.0, 1.0);
      const double scale = radius > 0 ? round * size(p) / radius + 1 - round : 1;
      return Vec3{ scale * p[0], scale * p[1], p[2] };
    });
  made.radius = [](const Vec3& p) { return std::hypot(p[0], p[1]); };
  return made;
}

double volumeOf(const std::vector<Triangle>& closed)
{
  double volume = 0;
  for (const auto& [a, b, c] : closed)
  {
    volume += dot(a, cross(b, c)) / 6;
  }
  return std::abs(volume);
}

struct Run
{
  std::vector<double> points;
  std::string summary;
  double error; ///< of the surface and the interface, as the filter states it
};

Run optimized(
  const TwoRegions& mesh, int boundary, double tolerance, int threads = 1, bool holdWorst = true)
{
  const auto regions =
    filledArray<vtkDoubleArray>("Regions", mesh.regions, [&](double region) { return region; });
  TAUTLINE_NEW(vtkMeshOptimizer, filter,
    SetInputData(TAUTLINE_CHANGED(toGrid(mesh.data), GetCellData()->AddArray(regions))),
    SetBoundary(boundary), SetSurfaceTolerance(tolerance),
    SetInputArrayToProcess(6, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Regions"),
    SetThreads(threads), SetHoldWorst(holdWorst), Update());
  TAUTLINE_LET(Run, run, points = toMesh(outputOf<vtkUnstructuredGrid>(filter)).points,
    summary = filter->GetSummary(), error = filter->GetSurfaceError());
  TAUTLINE_CHECK_EQUAL(invalid(mesh.data, run.points), Index(0));
  return run;
}

std::vector<Triangle> interfaceOf(const TwoRegions& mesh, const std::vector<double>& points)
{
  return boundaryOf(mesh.data, points, [&](Index cell) { return mesh.regions[cell] > 0; });
}

/// The distance between the interface before and after a run.
double offOf(const TwoRegions& mesh, const Run& run)
{
  const std::vector<Triangle> before = interfaceOf(mesh, mesh.data.points),
                              after = interfaceOf(mesh, run.points);
  return std::max(distance(after, before), distance(before, after));
}

Vec3 at(const std::vector<double>& points, Index p)
{
  return { points[3 * p], points[3 * p + 1], points[3 * p + 2] };
}

/// The facets of an interface face out of the cells of the smaller region, whatever their order.
TAUTLINE_PART(testSense)
{
  for (CellType type : { CellType::Hexahedron, CellType::Tetrahedron })
  {
    const TwoRegions mesh = ballInBall(type, 3, 2);
    TAUTLINE_LET(FeatureOptions, options, regions = mesh.regions.data());
    const Features found = findFeatures(Mesh(mesh.data.view()), options);
    TAUTLINE_CHECK_EQUAL(found.patches, 2);
    Index inwards = 0, all = 0;
    for (const Features::Facet& facet : found.facets)
    {
      const Vec3 a = mesh.data.point(facet.nodes[0]), b = mesh.data.point(facet.nodes[1]),
                 c = mesh.data.point(facet.nodes[2]);
      all += facet.interface;
      inwards += facet.interface && dot(cross(b - a, c - a), a) < 0;
    }
    TAUTLINE_CHECK(all >= 96);
    TAUTLINE_CHECK_EQUAL(inwards, all);
  }
}

/**
 * @brief Five runs: points slide, but do not leave the interface, and its volume stays within what
 * the facets of the input cut off.
 * @param off of the radius, relative
 */
void testRuns(TwoRegions mesh, int boundary, double off, double fullVolume)
{
  constexpr double tolerance = 1e-3;
  const double diagonal = norm({ 2, 2, 2 });
  const double radius = mesh.radius(mesh.data.point(mesh.interface[0])),
               volume = volumeOf(interfaceOf(mesh, mesh.data.points));
  double first = 0;
  for (int repeat = 0; repeat < 5; ++repeat)
  {
    const Run run = optimized(mesh, boundary, tolerance);
    TAUTLINE_CHECK(repeat > 0 || offOf(mesh, run) <= tolerance * diagonal);
    TAUTLINE_CHECK(run.error <= tolerance * diagonal);
    double slid = 0, farthest = 0;
    for (Index p : mesh.interface)
    {
      slid = std::max(slid, norm(at(run.points, p) - mesh.data.point(p)));
      farthest = std::max(farthest, std::abs(mesh.radius(at(run.points, p)) / radius - 1));
    }
    TAUTLINE_CHECK(slid > 0.01 || repeat > 0);
    TAUTLINE_CHECK(farthest < off);
    mesh.data.points = run.points;
    const double now = volumeOf(interfaceOf(mesh, run.points));
    TAUTLINE_CHECK(std::abs(now - volume) < fullVolume - volume);
    first = repeat == 0 ? now : first;
    TAUTLINE_CHECK_RELATIVE(now, first, 2e-3);
  }
}

TAUTLINE_PART_SLOW(testShapes)
{
  for (CellType type : { CellType::Hexahedron, CellType::Tetrahedron })
  {
    for (int boundary : { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::ON_SURFACE })
    {
      const Context context(
        std::string(topology(type).name) + (boundary == vtkMeshOptimizer::FIXED ? " fixed" : ""));
      const double inner = 0.5;
      testRuns(ballInBall(type, 6, 3), boundary, 1e-4, 4 * Pi / 3 * inner * inner * inner);
      testRuns(cylinderInBlock(type, 6, 6), boundary, 1e-3, 2 * Pi * inner * inner);
    }
  }
}

/// Fine facets, stretched in the input: the volume within them grows towards the ball's, as
/// they become regular, and stays there.
TAUTLINE_PART_SLOW(testFineBall)
{
  TwoRegions mesh = ballInBall(CellType::Hexahedron, 12, 8);
  const double radius = 2.0 / 3, full = 4 * Pi / 3 * radius * radius * radius,
               volume = volumeOf(interfaceOf(mesh, mesh.data.points));
  double first = 0;
  for (int repeat = 0; repeat < 5; ++repeat)
  {
    mesh.data.points = optimized(mesh, vtkMeshOptimizer::FIXED, 1e-3).points;
    const double now = volumeOf(interfaceOf(mesh, mesh.data.points));
    TAUTLINE_CHECK(now > (1 - 5e-4) * volume && now < full);
    first = repeat == 0 ? now : first;
    TAUTLINE_CHECK_RELATIVE(now, first, 5e-5);
    TAUTLINE_EACH_OF(
      Index p, mesh.interface, TAUTLINE_CHECK_NEAR(norm(mesh.data.point(p)), radius, 1e-5));
  }
}

/// The surface tolerance also applies to interfaces, whatever the boundary does; the summary states
/// it.
TAUTLINE_PART(testTolerance)
{
  for (int boundary : { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::SLIDING, vtkMeshOptimizer::FREE,
         vtkMeshOptimizer::ON_SURFACE })
  {
    const Context context("boundary " + std::to_string(boundary));
    const TwoRegions mesh = ballInBall(CellType::Hexahedron, 4, 2);
    const double diagonal = norm({ 2, 2, 2 });
    const auto states = [](const Run& run)
    { return contains(run.summary, wording("of-interfaces-their-last-steps-went-too")); };
    const Run unlimited = optimized(mesh, boundary, 0);
    TAUTLINE_CHECK(offOf(mesh, unlimited) > 2e-3 * diagonal);
    TAUTLINE_CHECK(!states(unlimited));
    for (double tolerance : { 1e-4, 1e-3 })
    {
      const Run run = optimized(mesh, boundary, tolerance);
      const double off = offOf(mesh, run);
      TAUTLINE_CHECK(off <= tolerance * diagonal && off > 0.3 * tolerance * diagonal);
      TAUTLINE_CHECK(states(run));
      TAUTLINE_CHECK(optimized(mesh, boundary, tolerance, 2).points == run.points);
    }
  }
}

/**
 * @brief A twisted cylinder through a block, run after run: where the worst element would get
 * worse, a run is to find points that keep it, not to go back to the input.
 */
TAUTLINE_PART(testHeldWorst)
{
  constexpr double tolerance = 1e-3, twist = 0.2, worthwhile = 1e-3;
  TwoRegions mesh = cylinderInBlock(CellType::Hexahedron, 6, 6);
  mesh.data.transform(
    [&](const Vec3& p)
    {
      const double size = std::max(std::abs(p[0]), std::abs(p[1]));
      const double angle = twist * (p[2] + 1) * std::clamp(2 - 2 * size, 0.0, 1.0);
      return Vec3{ std::cos(angle) * p[0] - std::sin(angle) * p[1],
        std::sin(angle) * p[0] + std::cos(angle) * p[1], p[2] };
    });
  TAUTLINE_CHECK_EQUAL(invalid(mesh.data, mesh.data.points), Index(0));
  int held = 0;
  for (int repeat = 0; repeat < 6; ++repeat)
  {
    const auto objective = [&](const std::vector<double>& points)
    { return sumOfSquares(mesh.data, points, Metric::InverseMeanRatio); };
    const auto worst = [&](const std::vector<double>& points)
    {
      MeshData moved = TAUTLINE_CHANGED(mesh.data, points = points);
      const std::vector<double> values = valuesOf(moved, Metric::InverseMeanRatio);
      return *std::max_element(values.begin(), values.end());
    };
    const Run run = optimized(mesh, vtkMeshOptimizer::ON_SURFACE, tolerance),
              any = optimized(mesh, vtkMeshOptimizer::ON_SURFACE, tolerance, 1, false);
    const double start = objective(mesh.data.points), before = worst(mesh.data.points);
    const double gained = start - objective(run.points), possible = start - objective(any.points);
    TAUTLINE_CHECK(worst(run.points) <= (1 + 1e-9) * before);
    TAUTLINE_CHECK(run.error <= tolerance * norm({ 2, 2, 2 }));
    if (possible > worthwhile * start)
    {
      TAUTLINE_CHECK(gained > 0.8 * possible);
      held += worst(any.points) > before;
    }
    mesh.data.points = run.points;
  }
  TAUTLINE_CHECK(held > 1);
}

/// A run from points that have converged, where the rest would make the worst element worse, keeps
/// them and calls them converged.
TAUTLINE_PART(testConverged)
{
  TwoRegions mesh = cylinderInBlock(CellType::Tetrahedron, 8, 8);
  bool kept = false;
  for (int repeat = 0; repeat < 12 && !kept; ++repeat)
  {
    const Run run = optimized(mesh, vtkMeshOptimizer::ON_SURFACE, 0);
    kept = run.points == mesh.data.points;
    if (kept)
    {
      TAUTLINE_CHECK_EQUAL(run.summary.find("Converged: "), std::size_t(0));
      TAUTLINE_CHECK(contains(run.summary, wording("the-little-that-the-objective-can-still")));
    }
    mesh.data.points = run.points;
  }
  TAUTLINE_CHECK(kept);
}
}
