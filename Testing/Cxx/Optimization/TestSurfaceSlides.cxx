// SPDX-License-Identifier: BSD-3-Clause
// Stretched meshes of curved surfaces, whose points Newton's method moves all at once.
#include "Registry.h"
#include "StretchedMeshes.h"
#include "tautline/Mesh/Features.h"

using namespace tautline;

namespace
{
constexpr double height = 0.2, turn = 2; // of the bump; of the cylinder, radians

/// A surface over the unit square, and its normal.
struct Surface
{
  const char* name;
  std::function<Vec3(const Vec3&)> point, normal;
  std::function<double(const Vec3&)> distance;
};

Vec3 onBump(const Vec3& p)
{
  return { p[0], p[1], height * std::sin(Pi * p[0]) * std::sin(Pi * p[1]) };
}

const Surface surfaces[] = {
  { "bump", onBump,
    [](const Vec3& x)
    {
      return Vec3{ -height * Pi * std::cos(Pi * x[0]) * std::sin(Pi * x[1]),
        -height * Pi * std::sin(Pi * x[0]) * std::cos(Pi * x[1]), 1 };
    },
    [](const Vec3& x) { return std::abs(x[2] - onBump(x)[2]); } },
  // The order of the points of its elements makes normals point inwards.
  { "cylinder",
    [](const Vec3& p) {
      return Vec3{ std::cos(turn * p[0]), p[1], std::sin(turn * p[0]) };
    },
    [](const Vec3& x) {
      return Vec3{ -x[0], 0, -x[2] };
    },
    [](const Vec3& x) { return std::abs(std::hypot(x[0], x[2]) - 1); } },
};

/// Rows that become flat towards one border, between borders of uniform edges.
MeshData meshOf(const Surface& surface, CellType type, int cells, double power)
{
  MeshData data = stretched(type, cells, TAUTLINE_PLACE(p[0], std::pow(p[1], power), p[2]));
  data.transform(surface.point);
  return data;
}

OptimizeResult runOnModel(const MeshData& data, bool smooth, OptimizeOptions options)
{
  const Mesh mesh(data.view());
  const Features found = findFeatures(mesh, {});
  const SurfaceModel model = makeSurfaceModel(mesh, found, smooth);
  const std::vector<std::int32_t> parts = partsOfPoints(found);
  auto fixed =
    collect<unsigned char>(found.kind, [&](signed char kind) { return kind == CornerPoint; });
  options.holdWorst = false; // the sum alone is compared
  TAUTLINE_SET(options, fixed = fixed.data(), model = &model, parts = parts.data());
  return optimize(mesh, options);
}

/// The largest distance from the surface, and whether all elements face as its normals do.
double offSurface(const MeshData& data, const std::vector<double>& points, const Surface& surface)
{
  MeshData moved = TAUTLINE_CHANGED(data, points = points);
  double off = largestOf<double>(
    0, moved.numberOfPoints(), [&](Index p) { return surface.distance(moved.point(p)); });
  Index turned = 0;
  for (Index c = 0; c < moved.numberOfCells(); ++c)
  {
    const Index first = moved.offsets[c], count = moved.offsets[c + 1] - first;
    for (Index k = 0; k < count; ++k)
    {
      const auto at = [&](Index i)
      { return moved.point(moved.connectivity[first + (k + i) % count]); };
      const Vec3 area = cross(at(1) - at(0), at(count - 1) - at(0));
      turned += !(dot(area, surface.normal(at(0))) > 0);
    }
  }
  TAUTLINE_CHECK_EQUAL(turned, Index(0));
  return off;
}

void testStretched(const Surface& surface, CellType type, bool smooth)
{
  const Context context(std::string(surface.name) + (smooth ? ", smooth, " : ", facets, ") +
    "type " + std::to_string(static_cast<int>(type)));
  constexpr int cells = 32, few = 40;
  TAUTLINE_LET(OptimizeOptions, accurate, optimizer = Optimizer::LocalNewton,
    stopping.relativeChange = 1e-10, stopping.gradientNorm = 0, stopping.maximumIterations = 3000);
  // From rows of equal heights, sweeps reach the minimum.
  const double least =
    runOnModel(meshOf(surface, type, cells, 1), smooth, accurate).history.back().objective;
  const MeshData data = meshOf(surface, type, cells, 2);
  const OptimizeResult result = runOnModel(data, smooth, OptimizeOptions());
  TAUTLINE_CHECK(result.history.front().objective > 20 * least);
  TAUTLINE_CHECK(result.history.back().objective <= 1.002 * least);
  TAUTLINE_CHECK(result.reason == StopReason::RelativeChange);
  TAUTLINE_CHECK(result.iterations <= few);
  TAUTLINE_LET(
    OptimizeOptions, sweeps, optimizer = Optimizer::LocalNewton, stopping.maximumIterations = few);
  TAUTLINE_CHECK(runOnModel(data, smooth, sweeps).history.back().objective > 1.02 * least);
  // Facets leave the surface by half of its second derivative times the square of their size, of
  // which the smooth surface through their corners saves most.
  constexpr double dx = turn / cells, dy = 2.0 / cells, curvature = Pi * Pi * height;
  constexpr double chord = 0.5 * curvature * (dx * dx + dy * dy);
  TAUTLINE_CHECK(offSurface(data, result.points, surface) <= (smooth ? 0.05 : 1.0) * chord);
  // Points of the straight border stay there, and some of them move.
  double off = 0, along = 0;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const double y = data.points[3 * p + 1];
    const Vec3 way =
      Vec3{ result.points[3 * p], result.points[3 * p + 1], result.points[3 * p + 2] } -
      data.point(p);
    if (y == 0 || y == 1)
    {
      off = std::max(off, std::abs(way[1]));
      along = std::max(along, norm(way));
    }
  }
  TAUTLINE_CHECK(off <= 1e-12);
  TAUTLINE_CHECK(along > 0);
  TAUTLINE_LET(OptimizeOptions, threads, threads = 3);
  const OptimizeResult three = runOnModel(data, smooth, threads);
  TAUTLINE_CHECK(three.points == result.points);
}

/// Far flatter rows: no element turns over, and a minimum is reached. On the bump, rows of
/// quadrilaterals have a second one, 9.6 % above; rounding decides which of them it is.
void testFlat(const Surface& surface, CellType type)
{
  const Context context(surface.name);
  constexpr int cells = 24;
  const double least =
    runOnModel(meshOf(surface, type, cells, 1), true, OptimizeOptions()).history.back().objective;
  const MeshData data = meshOf(surface, type, cells, 3);
  const OptimizeResult result = runOnModel(data, true, OptimizeOptions());
  TAUTLINE_CHECK(result.history.front().objective > 1000 * least);
  const bool twoMinima = type == CellType::Quadrilateral && surface.name == std::string("bump");
  TAUTLINE_CHECK(result.history.back().objective <= (twoMinima ? 1.15 : 1.002) * least);
  offSurface(data, result.points, surface);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestSurfaceSlides)
{
  for (const Surface& surface : surfaces)
  {
    for (const CellType type : { CellType::Triangle, CellType::Quadrilateral })
    {
      if (type == CellType::Triangle)
      {
        TAUTLINE_RUN(testStretched(surface, type, true));
      }
      else
      {
        TAUTLINE_RUN_SLOW(testStretched(surface, type, true));
      }
      TAUTLINE_RUN_SLOW(testStretched(surface, type, false));
      TAUTLINE_RUN(testFlat(surface, type));
    }
  }
}
