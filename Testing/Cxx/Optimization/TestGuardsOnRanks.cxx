// SPDX-License-Identifier: BSD-3-Clause
// Never worse on ranks: where an objective makes the worst element worse than all of the input, the
// points about it go back to the input, the same however the mesh is cut.
#include "OptimizingOnRanks.h"

using namespace tautline;

namespace
{
constexpr double rounding = 1e-9;

/// The worst value of a metric, which is larger the worse.
double worstOf(const MeshData& whole, const std::vector<double>& points, Metric metric)
{
  MeshData moved = whole;
  moved.points = points;
  const Mesh mesh(moved.view());
  std::vector<double> values(mesh.view().numberOfCells);
  evaluateMetric(mesh, metric, {}, values.data());
  return metricInfo(metric).direction == Direction::LargerIsBetter
    ? -*std::min_element(values.begin(), values.end())
    : *std::max_element(values.begin(), values.end());
}

/// Points that moved far in a run without the guard and are where they were in one with it.
Index broughtBack(const MeshData& whole, const Run& guarded, const Run& free)
{
  Index count = 0;
  for (std::size_t i = 0; i < whole.points.size(); i += 3)
  {
    const auto at = static_cast<std::ptrdiff_t>(i);
    const auto stays = [&](const std::vector<double>& points)
    { return std::equal(points.begin() + at, points.begin() + at + 3, whole.points.begin() + at); };
    count += stays(guarded.points) && !stays(free.points);
  }
  return count;
}

void testGuard(
  CellType type, double amplitude, Metric objective, Metric judged, int iterations = 300)
{
  const Context context(std::string(topology(type).plural) + ", metrics " +
    std::to_string(static_cast<int>(objective)) + " and " +
    std::to_string(static_cast<int>(judged)));
  const MeshData whole = jittered(type, topology(type).dimension == 2 ? 9 : 5, amplitude);
  OptimizeOptions options = with({ objective });
  options.worstMetric = judged;
  options.stopping.maximumIterations = iterations;
  OptimizeOptions unguarded = options;
  unguarded.holdWorst = false;
  const Run free = runOn(whole, Cut::FirstOnly, 1, unguarded);
  const Run one = runOn(whole, Cut::FirstOnly, 1, options);
  const double before = worstOf(whole, whole.points, judged);
  const double limit = before + rounding * std::abs(before);
  // Without the guard the worst element is worse, with it is not, and the objective is still less.
  TAUTLINE_CHECK(worstOf(whole, free.points, judged) > limit);
  TAUTLINE_CHECK(worstOf(whole, one.points, judged) <= limit);
  TAUTLINE_CHECK(one.result.restored > 0);
  TAUTLINE_CHECK(!one.result.unchanged);
  TAUTLINE_CHECK(one.result.history.back().objective < one.result.history.front().objective);
  TAUTLINE_CHECK(broughtBack(whole, one, free) > 0);
  TAUTLINE_CHECK(broughtBack(whole, one, free) <= one.result.restored);
  // One process in its own order has another way, and the same guarantee.
  const OptimizeResult usual = optimize(Mesh(whole.view()), options);
  TAUTLINE_CHECK(worstOf(whole, usual.points, judged) <= limit);
  std::cout << topology(type).plural << ": " << one.result.restored << " points went back, of "
            << whole.numberOfPoints() << "; the worst element " << before << ", without the guard "
            << worstOf(whole, free.points, judged) << "\n";
  forEachCut({ 2, 3, 4 },
    [&](Cut cut, int ranks)
    {
      const Run run = runOn(whole, cut, ranks, options);
      TAUTLINE_CHECK(farthest(run.points, one.points) <= 1e-10);
      TAUTLINE_CHECK(worstOf(whole, run.points, judged) <= limit);
      TAUTLINE_CHECK_EQUAL(run.result.history.size(), one.result.history.size());
      TAUTLINE_CHECK_EQUAL(run.result.unchanged, one.result.unchanged);
      for (const Found& found : run.results)
      {
        TAUTLINE_CHECK_EQUAL(found.restored, one.result.restored);
        TAUTLINE_CHECK_EQUAL(found.history.back().objective, one.result.history.back().objective);
      }
    });
}
}

//------------------------------------------------------------------------------
int TestGuardsOnRanks(int, char*[])
{
  // Equal sizes at the cost of the shape of single elements.
  testGuard(CellType::Tetrahedron, 0.25, Metric::SizeNonBarrier, Metric::ScaledJacobian);
  testGuard(CellType::Tetrahedron, 0.2, Metric::Size, Metric::EdgeRatio);
  testGuard(CellType::Triangle, 0.25, Metric::SizeBarrier, Metric::ScaledJacobian);
  testGuard(CellType::Quadrilateral, 0.2, Metric::Size, Metric::InverseMeanRatio);
  // Converged, all points would go back.
  constexpr int few = 5;
  testGuard(CellType::Hexahedron, 0.25, Metric::Size, Metric::EdgeRatio, few);
  return exitCode();
}
