// SPDX-License-Identifier: BSD-3-Clause
// Points that slide on flat and straight parts of a boundary, moved all at once by Newton's method.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Mesh/BoundaryShape.h"
#include "tautline/Mesh/Features.h"
#include "tautline/Optimization/FlatParts.h"

using namespace tautline;

namespace
{
constexpr Index n = 16; // cells along an edge: enough for several grids
/// The block: only two faces are at right angles to an axis.
constexpr double shearByY = 0.5, shearByZ = 0.3;
constexpr double height = 0.08; // of the bump, in edges of the block

Vec3 sheared(const Vec3& p)
{
  return { p[0] + shearByY * p[1] + shearByZ * p[2], p[1] - 0.2 * p[2], p[2] };
}

/// Where a point of the sheared block is in the block.
Vec3 unsheared(const double* x)
{
  const double y = x[1] + 0.2 * x[2];
  return { x[0] - shearByY * y - shearByZ * x[2], y, x[2] };
}

/// A sheared unit cube, its points moved at random except on the boundary; with a bump, the
/// top is curved between straight edges.
MeshData shearedBlock(CellType type, double bump)
{
  constexpr double amplitude = 0.2, pi = 3.14159265358979323846;
  MeshData data = perturbedBlock(type, n, amplitude);
  data.transform(
    [&](const Vec3& p)
    {
      Vec3 x = (1.0 / n) * p;
      x[2] *= 1 + bump * std::sin(pi * x[0]) * std::sin(pi * x[1]);
      return sheared(x);
    });
  TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
  return data;
}

/// On how many faces of the cube a point of the input is.
int facesOf(const Vec3& x, int axis, double& side)
{
  constexpr double close = 1e-9;
  side = x[axis] < 0.5 ? 0.0 : 1.0;
  return std::abs(x[axis] - side) < close;
}

/// How far points have left the flat faces that they are on in the input, and how many have moved
/// in one; with a bump, the top is none.
double offFaces(const MeshData& data, const std::vector<double>& points, bool bump, Index& moved)
{
  double off = 0;
  moved = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 before = unsheared(&data.points[3 * i]), now = unsheared(&points[3 * i]);
    for (int c = 0; c < 3; ++c)
    {
      double side = 0;
      if (facesOf(before, c, side) && !(bump && c == 2 && side == 1))
      {
        off = std::max(off, std::abs(now[c] - before[c]));
        moved += norm(now - before) > 1e-3;
      }
    }
  }
  return off;
}

/// Planes that are not at right angles to an axis: coarse grids mix the coordinates.
TAUTLINE_PART(testSlantedPlanes)
{
  for (CellType type : { CellType::Hexahedron, CellType::Tetrahedron })
  {
    const MeshData data = shearedBlock(type, 0);
    const Mesh mesh(data.view());
    const BoundaryShape shape = boundaryShape(mesh, 1.0);
    for (Optimizer optimizer : { Optimizer::NewtonConjugateGradient, Optimizer::LimitedMemoryBFGS })
    {
      const Context context(std::string(topology(type).name) + ", optimizer " +
        std::to_string(static_cast<int>(optimizer)));
      TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer, fixed = shape.fixed.data(),
        slidePlanes = shape.planes.data(), slideLines = shape.lines.data());
      const OptimizeResult result = optimize(mesh, options);
      Index moved = 0;
      TAUTLINE_CHECK(offFaces(data, result.points, false, moved) < 1e-13);
      TAUTLINE_CHECK(moved > 100);
      TAUTLINE_CHECK(result.history.back().objective < 0.95 * result.history.front().objective);
    }
  }
}

struct Sliding
{
  Features features;
  SurfaceModel model;
  std::vector<std::int32_t> parts;
  std::vector<unsigned char> fixed;
  OptimizeOptions options;

  explicit Sliding(const Mesh& mesh)
    : features(findFeatures(mesh, {}))
    , model(makeSurfaceModel(mesh, features, true))
    , parts(partsOfPoints(features))
  {
    for (signed char kind : this->features.kind)
    {
      this->fixed.push_back(kind == CornerPoint);
    }
    this->options.fixed = this->fixed.data();
    this->options.model = &this->model;
    this->options.parts = this->parts.data();
    this->options.surfaceTolerance = 2e-3;
  }
  Sliding(const Sliding&) = delete;
  Sliding& operator=(const Sliding&) = delete;
};

/// Points on flat faces and straight edges get their directions; those on the bump, and on the
/// straight edges beside it, are held.
TAUTLINE_PART(testDirections)
{
  const MeshData data = shearedBlock(CellType::Hexahedron, height);
  const Mesh mesh(data.view());
  const Sliding sliding(mesh);
  const PointSlides slides = slidesOf(mesh, sliding.options);
  const Vec3 normals[] = { { 1, -shearByY, -shearByZ - 0.2 * shearByY }, { 0, 1, 0.2 },
    { 0, 0, 1 } };
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  Index held = 0, planes = 0, lines = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 x = unsheared(&data.points[3 * i]);
    int faces = 0, axis = 0, along = 0;
    bool top = boundary[i] && x[2] > 1 + 1e-9;
    for (int c = 0; c < 3; ++c)
    {
      double side = 0;
      const bool on = facesOf(x, c, side) && !(c == 2 && top);
      faces += on;
      axis = on ? c : axis;
      along = on ? along : c;
      top = top || (on && c == 2 && side == 1);
    }
    const auto at = [i](const std::vector<double>& of) {
      return Vec3{ of[3 * i], of[3 * i + 1], of[3 * i + 2] };
    };
    const Vec3 plane = at(slides.planes), line = at(slides.lines);
    held += slides.held[i];
    planes += dot(plane, plane) > 0;
    lines += dot(line, line) > 0;
    TAUTLINE_CHECK_EQUAL(int(slides.held[i]), int(top && faces < 3));
    if (dot(plane, plane) > 0)
    {
      TAUTLINE_CHECK(faces == 1 && !top);
      TAUTLINE_CHECK(norm(cross(plane, normals[axis])) < 1e-9 * norm(plane) * norm(normals[axis]));
    }
    if (dot(line, line) > 0)
    {
      Vec3 unit = { 0, 0, 0 };
      unit[along] = 1;
      const Vec3 edge = sheared(unit);
      TAUTLINE_CHECK(faces == 2 && !top);
      TAUTLINE_CHECK(norm(cross(line, edge)) < 1e-9 * norm(line) * norm(edge));
    }
  }
  constexpr Index inner = n - 1; // points inside an edge
  TAUTLINE_CHECK_EQUAL(planes, 5 * inner * inner);
  TAUTLINE_CHECK_EQUAL(lines, 8 * inner);
  TAUTLINE_CHECK_EQUAL(held, inner * inner + 4 * inner);

  // On another geometry, all points that slide are held.
  OptimizeOptions geometry = TAUTLINE_CHANGED(sliding.options, onGeometry = true);
  const PointSlides there = slidesOf(mesh, geometry);
  TAUTLINE_CHECK(there.planes.empty() && there.lines.empty());
  TAUTLINE_CHECK_EQUAL(
    Index(std::count(there.held.begin(), there.held.end(), 1)), 6 * inner * inner + 12 * inner);
  TAUTLINE_CHECK(slidesOf(mesh, OptimizeOptions()).held.empty());
}

/// Sheared blocks, which sweeps alone bring to the minimum in hundreds of iterations.
TAUTLINE_PART_SLOW(testSurface)
{
  for (const bool bump : { false, true })
  {
    const Context context(bump ? "bump" : "flat");
    const MeshData data = shearedBlock(CellType::Hexahedron, bump ? height : 0);
    const Mesh mesh(data.view());
    Sliding sliding(mesh);
    OptimizeOptions& options = sliding.options;
    options.stopping.maximumIterations = 2000;
    const OptimizeResult result = optimize(mesh, options);
    Index moved = 0;
    TAUTLINE_CHECK(offFaces(data, result.points, bump, moved) < 1e-12);
    TAUTLINE_CHECK(moved > 100);
    TAUTLINE_CHECK(result.surfaceError <= options.surfaceTolerance);
    TAUTLINE_CHECK(bump || result.surfaceError < 1e-12);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
    TAUTLINE_SET(options, optimizer = Optimizer::LocalNewton, stopping.relativeChange = 1e-9);
    const OptimizeResult sweeps = optimize(mesh, options);
    std::cout << "surface " << bump << ": " << result.iterations << " and " << sweeps.iterations
              << " iterations, objective / objective of sweeps "
              << result.history.back().objective / sweeps.history.back().objective << "\n";
    TAUTLINE_CHECK(result.history.back().objective < (1 + 1e-3) * sweeps.history.back().objective);
    const double wanted = (1 + 1e-4) * result.history.back().objective;
    const Index needed = std::count_if(sweeps.history.begin(), sweeps.history.end(),
      [wanted](const IterationRecord& record) { return record.objective > wanted; });
    std::cout << "  of which " << needed << " to 1.0001 of it\n";
    TAUTLINE_CHECK(result.iterations < needed && (bump || 2 * result.iterations < needed));
    TAUTLINE_SET(options, optimizer = Optimizer::Automatic, stopping = StoppingCriteria(),
      threads = 2, stopping.maximumIterations = 2000);
    TAUTLINE_CHECK(optimize(mesh, options).points == result.points);
  }
}

/// Objectives of the size, which shrink a mesh whose boundary is free, are minimized by sliding.
TAUTLINE_PART(testSizes)
{
  const MeshData data = shearedBlock(CellType::Hexahedron, 0);
  const Mesh mesh(data.view());
  Sliding sliding(mesh);
  applyPreset(Preset::UniformSize, sliding.options);
  const OptimizeResult result = optimize(mesh, sliding.options);
  Index moved = 0;
  TAUTLINE_CHECK(offFaces(data, result.points, false, moved) < 1e-12);
  TAUTLINE_CHECK(moved > 100);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
}

/// Metrics that cannot judge the worst element, and those whose values may all be 0.
TAUTLINE_PART(testWorstMetrics)
{
  const MeshData data = perturbedBlock(CellType::Quadrilateral, 5, 0.2);
  const Mesh mesh(data.view());
  OptimizeOptions options;
  applyPreset(Preset::WorstElement, options);
  options.worstMetric = Metric::Size;
  TAUTLINE_CHECK_THROWS(
    optimize(mesh, options), wording("choose-another-metric-for-the-worst-element"));
  options.worstMetric = Metric::RadiusRatio;
  TAUTLINE_CHECK_THROWS(optimize(mesh, options), wording("is-not-defined-on-every-element"));
  options.worstMetric = Metric::UntangleBeta;
  const OptimizeResult result = optimize(mesh, options);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);

  // One quadrilateral that is folded: nothing takes part.
  MeshData folded = blockMesh(CellType::Quadrilateral, 1, 1, 0);
  const Vec3 first = folded.point(0);
  TAUTLINE_SET(folded, setPoint(0, folded.point(1)), setPoint(1, first));
  TAUTLINE_CHECK_THROWS(
    optimize(Mesh(folded.view()), OptimizeOptions()), wording("no-element-is-valid"));
}
}
