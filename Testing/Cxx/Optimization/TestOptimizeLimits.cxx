// SPDX-License-Identifier: BSD-3-Clause
// Limits on the way of points: kept, and no stop short of the minimum within them.
#include "OptimizingRanks.h"
#include "Registry.h"
#include "StretchedMeshes.h"

#include "tautline/Mesh/BoundaryShape.h"
#include "tautline/Untangling/Untangle.h"

using namespace tautline;

namespace
{
/// Bends rows less than would invert tetrahedra at the boundary.
MeshData stretchedRows(CellType type, int cells)
{
  const double power = type == CellType::Tetrahedron ? 1.5 : 3;
  return stretched(type, cells,
    [power](const Vec3& p) {
      return Vec3{ p[0], std::pow(p[1], power), p[2] };
    });
}

double wayOf(const MeshData& data, const std::vector<double>& points, Index p)
{
  const double *x = &points[3 * p], *start = &data.points[3 * p];
  return std::hypot(x[0] - start[0], x[1] - start[1], x[2] - start[2]);
}

/// Points at their limit.
Index atLimit(const MeshData& data, const std::vector<double>& points, double limit)
{
  Index count = 0;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    count += wayOf(data, points, p) > (1 - 1e-6) * limit;
  }
  return count;
}

double longestWay(const MeshData& data, const std::vector<double>& points)
{
  double longest = 0;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    longest = std::max(longest, wayOf(data, points, p));
  }
  return longest;
}

/// The sum of squares of the inverse mean ratios of the cells at a point.
double sumAround(const MeshData& data, Index p)
{
  MeshData around;
  around.points = data.points;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const auto begin = data.connectivity.begin() + data.offsets[c],
               end = data.connectivity.begin() + data.offsets[c + 1];
    if (std::find(begin, end, p) != end)
    {
      around.addCell(static_cast<CellType>(data.types[c]), std::vector<Index>(begin, end));
    }
  }
  return sumOfSquares(around, around.points, Metric::InverseMeanRatio);
}

/// Small steps of single points, taken back to their limit, do not reduce the sum.
void checkMinimum(const MeshData& data, const std::vector<double>& points, double limit)
{
  constexpr double step = 1e-4, much = 1e-7;
  const bool flat = topology(static_cast<CellType>(data.types[0])).dimension == 2;
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  MeshData moved = data;
  moved.points = points;
  double gain = 0;
  for (Index p = 0; p < data.numberOfPoints(); p += 7)
  {
    const Vec3 x = moved.point(p), start = data.point(p);
    const double here = sumAround(moved, p);
    for (int c = 0; !boundary[p] && c < (flat ? 4 : 6); ++c)
    {
      Vec3 to = x;
      to[c / 2] += c % 2 == 0 ? step : -step;
      const double way = norm(to - start);
      to = way > limit ? start + (limit / way) * (to - start) : to;
      moved.setPoint(p, to);
      gain = std::max(gain, 1 - sumAround(moved, p) / here);
    }
    moved.setPoint(p, x);
  }
  TAUTLINE_CHECK(gain <= much);
}

/// Methods of all kinds end at the same sum, a minimum within the limits.
void testMethods(const char* name, CellType type, int cells, double limit)
{
  const Context context(name);
  const MeshData data = stretchedRows(type, cells);
  std::vector<double> limits(data.numberOfPoints(), limit);
  OptimizeOptions options;
  options.limits = limits.data();
  options.stopping.maximumIterations = 3000;
  double sums[3];
  const Optimizer methods[] = { Optimizer::Automatic, Optimizer::LocalNewton,
    Optimizer::LocalConjugateGradient };
  for (int i = 0; i < 3; ++i)
  {
    const Context which("optimizer " + std::to_string(static_cast<int>(methods[i])));
    options.optimizer = methods[i];
    options.stopping.relativeChange = 1e-9;
    options.stopping.gradientNorm = 1e-12;
    const OptimizeResult result = run(data, options);
    checkHistory(data, result);
    sums[i] = result.history.back().objective;
    TAUTLINE_CHECK(result.reason != StopReason::IterationLimit);
    TAUTLINE_CHECK(longestWay(data, result.points) <= (1 + 1e-12) * limit);
    TAUTLINE_CHECK(atLimit(data, result.points, limit) > 20);
    TAUTLINE_CHECK_RELATIVE(sums[i], sums[0], 1e-5);
    checkMinimum(data, result.points, limit);
    options.stopping = StoppingCriteria();
    options.stopping.maximumIterations = 3000;
    const OptimizeResult usual = run(data, options);
    TAUTLINE_CHECK(usual.history.back().objective <= 1.001 * sums[0]);
  }
}

/// Limits that no point reaches change nothing: the minimum is the uniform grid.
void testWide()
{
  constexpr int cells = 48;
  const MeshData data = stretchedRows(CellType::Quadrilateral, cells);
  std::vector<double> limits(data.numberOfPoints(), 2.0);
  OptimizeOptions options;
  options.limits = limits.data();
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK_RELATIVE(result.history.back().objective, 1.0 * cells * cells, 1e-6);
}

/// Limits on some points, also of 0, beyond which the harmonic map takes them: it is no start then.
void testSome(double limit)
{
  const Context context("limit " + std::to_string(limit));
  constexpr int cells = 30;
  const MeshData data = stretched(CellType::Triangle, cells,
    [](const Vec3& p) {
      return Vec3{ p[0], p[1] * p[1], p[2] };
    });
  Random random(5);
  std::vector<double> limits(data.numberOfPoints(), 10.0);
  for (double& l : limits)
  {
    l = random.vector(0, 1)[0] < 0.1 ? limit : l;
  }
  OptimizeOptions options;
  options.limits = limits.data();
  options.holdWorst = false; // points that cannot move keep the worst element from improving
  OptimizeOptions sweeps = options;
  sweeps.optimizer = Optimizer::LocalNewton;
  sweeps.stopping.maximumIterations = 3000;
  const OptimizeResult result = run(data, options), swept = run(data, sweeps);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  TAUTLINE_CHECK(result.history.front().objective > 2 * result.history.back().objective);
  TAUTLINE_CHECK(result.history.back().objective <= 1.001 * swept.history.back().objective);
  TAUTLINE_CHECK(result.iterations < swept.iterations);
  double over = 0;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    over = std::max(over, wayOf(data, result.points, p) - limits[p]);
  }
  TAUTLINE_CHECK(over <= 1e-14);
}

/// Limits that are small beside the elements: the curvature of the limits is what counts.
void testSmall(CellType type, int cells)
{
  const Context context(topology(type).name);
  const MeshData data = stretched(type, cells,
    [](const Vec3& p) {
      return Vec3{ p[0], std::pow(p[1], 1.5), p[2] };
    });
  const std::vector<double> limits(data.numberOfPoints(), 1e-3);
  OptimizeOptions options;
  options.limits = limits.data();
  const OptimizeResult result = run(data, options);
  options.optimizer = Optimizer::LocalNewton;
  const OptimizeResult swept = run(data, options);
  TAUTLINE_CHECK_RELATIVE(result.history.back().objective, swept.history.back().objective, 1e-4);
  TAUTLINE_CHECK(result.iterations <= 15);
}

/// Points that slide in planes stay there, also with limits.
void testSliding()
{
  constexpr double limit = 0.05;
  const MeshData data = stretchedRows(CellType::Tetrahedron, 8);
  std::vector<double> limits(data.numberOfPoints(), limit);
  const BoundaryShape shape = boundaryShape(Mesh(data.view()), 1.0);
  OptimizeOptions options;
  options.limits = limits.data();
  options.fixed = shape.fixed.data();
  options.slidePlanes = shape.planes.data();
  options.slideLines = shape.lines.data();
  OptimizeOptions local = options;
  local.optimizer = Optimizer::LocalNewton;
  local.stopping.maximumIterations = 3000;
  const OptimizeResult result = run(data, options), swept = run(data, local);
  TAUTLINE_CHECK_RELATIVE(result.history.back().objective, swept.history.back().objective, 1e-3);
  TAUTLINE_CHECK(longestWay(data, result.points) <= (1 + 1e-12) * limit);
  double off = 0, along = 0;
  for (std::size_t i = 0; i < data.points.size(); ++i)
  {
    const double x = data.points[i];
    const double way = std::abs(result.points[i] - x);
    const bool onSide = x == 0 || x == 1;
    const std::size_t other = i - i % 3 + (i + 1) % 3;
    off = std::max(off, onSide ? way : 0.0);
    along = std::max(along, onSide ? std::abs(result.points[other] - data.points[other]) : 0.0);
  }
  TAUTLINE_CHECK(off <= 1e-14);
  TAUTLINE_CHECK(along > 0.5 * limit);
}

/// Points of a curved surface, which go back to it after each step, also keep their limits.
void testSurface(CellType type, bool project)
{
  const Context context(
    std::string(topology(type).name) + (project ? " on the surface" : " beside the surface"));
  constexpr double limit = 0.02;
  MeshData data = stretchedRows(type, 12);
  data.transform(
    [](const Vec3& p) {
      return Vec3{ p[0], p[1], 0.3 * std::sin(3 * p[0]) * std::cos(4 * p[1]) };
    });
  const std::vector<double> limits(data.numberOfPoints(), limit);
  for (const Optimizer method : { Optimizer::Automatic, Optimizer::LocalConjugateGradient })
  {
    OptimizeOptions options;
    options.optimizer = method;
    options.limits = limits.data();
    options.surface.project = project;
    const OptimizeResult result = run(data, options);
    TAUTLINE_CHECK(longestWay(data, result.points) <= limit);
    TAUTLINE_CHECK(atLimit(data, result.points, limit) > 20);
    TAUTLINE_CHECK(result.history.back().objective < 0.9 * result.history.front().objective);
  }
}

/// Limits count from the input, not from what untangling leaves: where that goes too far, it is an
/// error, also on ranks.
void testUntangling()
{
  const MeshData data = stretched(CellType::Tetrahedron, 8,
    [](const Vec3& p) {
      return Vec3{ p[0], p[1] * p[1] * p[1], p[2] };
    });
  TAUTLINE_CHECK(invalid(data, data.points) > 0);
  UntangleOptions untangling;
  const double way = longestWay(data, untangle(Mesh(data.view()), untangling).points);
  std::vector<double> limits(data.numberOfPoints(), 1.01 * way);
  OptimizeOptions options;
  options.limits = limits.data();
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK(result.untangled && result.invertedAfter == 0);
  TAUTLINE_CHECK(longestWay(data, result.points) <= (1 + 1e-12) * limits[0]);
  // Points with a limit of 0 are held in untangling.
  limits.assign(limits.size(), 10.0);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  Index held = 0;
  while (held < data.numberOfPoints() && boundary[held])
  {
    ++held;
  }
  limits[held] = 0;
  TAUTLINE_CHECK(wayOf(data, run(data, options).points, held) <= 1e-14);
  limits.assign(limits.size(), 0.9 * way);
  TAUTLINE_CHECK_THROWS(run(data, options), wording("points-farther-than-their-limits"));
  int errors = 0;
  std::mutex mutex;
  onRanks(2,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(data, group.rank(), cutBy(data, Cut::Slabs, 2));
      DistributedMesh mesh(group, { part.data.view(), nullptr, nullptr });
      const std::vector<unsigned char> fixed = rankBoundary(mesh);
      const std::vector<double> own(mesh.localPoints(), 0.9 * way);
      OptimizeOptions local;
      local.fixed = fixed.data();
      local.limits = own.data();
      try
      {
        optimize(localMesh(mesh), local, {}, Ranks(mesh));
      }
      catch (const Error& error)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        errors +=
          std::string(error.what()).find(wording("farther-than-their-limits")) != std::string::npos;
      }
    });
  TAUTLINE_CHECK_EQUAL(errors, 2);
}

/// On ranks, however the mesh is cut, and as on one process.
void testRanks(CellType type, int cells, double limit)
{
  const MeshData data = stretchedRows(type, cells);
  OptimizeOptions options = with({ Metric::InverseMeanRatio });
  options.stopping.relativeChange = 1e-9;
  options.stopping.maximumIterations = 1000;
  const auto runAt = [&](Cut cut, int ranks)
  {
    return moveOnRanks<Found>(data, cut, ranks,
      [&](DistributedMesh& mesh, Found& result)
      {
        OptimizeOptions own = options;
        const std::vector<unsigned char> fixed = rankBoundary(mesh);
        const std::vector<double> limits(mesh.localPoints(), limit);
        own.fixed = fixed.data();
        own.limits = limits.data();
        static_cast<OptimizeResult&>(result) = optimize(localMesh(mesh), own, {}, Ranks(mesh));
      });
  };
  const std::vector<double> limits(data.numberOfPoints(), limit);
  OptimizeOptions own = options;
  own.limits = limits.data();
  const double usual = run(data, own).history.back().objective;
  const Run one = runAt(Cut::FirstOnly, 1);
  TAUTLINE_CHECK_RELATIVE(one.result.history.back().objective, usual, 1e-6);
  TAUTLINE_CHECK(longestWay(data, one.points) <= (1 + 1e-12) * limit);
  for (const auto& [cut, ranks] : { std::pair(Cut::Slabs, 2), std::pair(Cut::Random, 3) })
  {
    const Run several = runAt(cut, ranks);
    TAUTLINE_CHECK(farthest(several.points, one.points) <= 1e-10);
    TAUTLINE_CHECK_EQUAL(several.result.iterations, one.result.iterations);
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestOptimizeLimits)
{
  TAUTLINE_RUN(testMethods("quadrilaterals", CellType::Quadrilateral, 24, 0.1));
  TAUTLINE_RUN(testMethods("triangles", CellType::Triangle, 24, 0.1));
  TAUTLINE_RUN(testMethods("tetrahedra", CellType::Tetrahedron, 10, 0.1));
  TAUTLINE_RUN(testMethods("hexahedra", CellType::Hexahedron, 10, 0.1));
  TAUTLINE_RUN(testWide());
  for (const double limit : { 0.0, 0.02, 0.05 })
  {
    TAUTLINE_RUN(testSome(limit));
  }
  TAUTLINE_RUN(testSmall(CellType::Quadrilateral, 30));
  TAUTLINE_RUN(testSmall(CellType::Tetrahedron, 8));
  TAUTLINE_RUN(testSmall(CellType::Hexahedron, 10));
  TAUTLINE_RUN(testSliding());
  for (const bool project : { true, false })
  {
    TAUTLINE_RUN(testSurface(CellType::Triangle, project));
    TAUTLINE_RUN(testSurface(CellType::Quadrilateral, project));
  }
  TAUTLINE_RUN(testUntangling());
  TAUTLINE_RUN(testRanks(CellType::Hexahedron, 8, 0.1));
  TAUTLINE_RUN(testRanks(CellType::Tetrahedron, 8, 0.1));
}
