// SPDX-License-Identifier: BSD-3-Clause
// Never worse on ranks: where an objective makes the worst element worse than all of the input, it
// is improved, as on one process; where there is no time for that, points about it go back to the
// input. The same however the mesh is cut.
#include "OptimizingRanks.h"
#include "Registry.h"
#include "tautline/Quality/UserMetric.h"

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

/// How the worst element becomes as good as the input's.
enum class Remedy
{
  Improve,
  PutBack /**< where the run is stopped */
};

struct Case
{
  CellType type;
  double amplitude;
  Metric objective, judged;
  int iterations; ///< at most
  Index n;        ///< cubes or squares along an edge
};

void testGuard(const Case& test, Remedy remedy)
{
  const CellType type = test.type;
  const Metric judged = test.judged;
  const bool stopped = remedy == Remedy::PutBack;
  const Context context(std::string(topology(type).plural) + ", metrics " +
    std::to_string(static_cast<int>(test.objective)) + " and " +
    std::to_string(static_cast<int>(judged)) + (stopped ? ", stopped" : ""));
  const MeshData whole = jittered(type, test.n, test.amplitude);
  OptimizeOptions options = with({ test.objective });
  options.worstMetric = judged;
  options.stopping.maximumIterations = test.iterations;
  OptimizeOptions unguarded = options;
  unguarded.holdWorst = false;
  const Run free = runOn(whole, Cut::FirstOnly, 1, unguarded);
  if (stopped)
  {
    const int last = free.result.iterations;
    options.observer = [last](const IterationState& state)
    { return state.record.iteration < last; };
  }
  const Run one = runOn(whole, Cut::FirstOnly, 1, options);
  const double before = worstOf(whole, whole.points, judged);
  const double limit = before + rounding * std::abs(before);
  // Without the guard the worst element is worse, with it is not, and the objective is still less.
  TAUTLINE_CHECK(worstOf(whole, free.points, judged) > limit);
  TAUTLINE_CHECK(worstOf(whole, one.points, judged) <= limit);
  TAUTLINE_CHECK(!one.result.unchanged);
  TAUTLINE_CHECK(one.result.history.back().objective < one.result.history.front().objective);
  // As on one process in its own order.
  const OptimizeResult usual = optimize(Mesh(whole.view()), options);
  TAUTLINE_CHECK(worstOf(whole, usual.points, judged) <= limit);
  TAUTLINE_CHECK_EQUAL(one.result.restored > 0, stopped);
  TAUTLINE_CHECK_EQUAL(broughtBack(whole, one, free) > 0, stopped);
  TAUTLINE_CHECK(broughtBack(whole, one, free) <= one.result.restored);
  const double first = one.result.history.front().objective;
  const auto gain = [first](const OptimizeResult& result)
  { return 1 - result.history.back().objective / first; };
  std::cout << topology(type).plural << ": " << one.result.restored << " points went back, of "
            << whole.numberOfPoints() << "; the worst element " << before << ", without the guard "
            << worstOf(whole, free.points, judged) << "; the objective lower by "
            << gain(one.result) << ", in one process's own order " << gain(usual) << "\n";
  if (!stopped)
  {
    constexpr double alike = 0.05;
    TAUTLINE_CHECK_EQUAL(usual.restored, Index(0));
    TAUTLINE_CHECK_RELATIVE(gain(one.result), gain(usual), alike);
  }
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

/// The inverse mean ratio, or its negative (larger is better), without a value above a limit.
struct Limited
{
  double limit, sign;
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    const Number ratio = T.norm2() / (N * pow(abs(T.det()), 2.0 / N));
    return sign * ratio + 0.0 * sqrt(limit - ratio);
  }
};

/// An element without a value of the user's metric that judges is the worst one: the result has
/// none where the input has none, and an input with one is rejected.
void testWithoutValue(bool larger)
{
  const Context context(larger ? "larger is better" : "smaller is better");
  const MeshData whole = jittered(CellType::Tetrahedron, 5, 0.25);
  const double worst = worstOf(whole, whole.points, Metric::InverseMeanRatio);
  MetricDescription d;
  d.name = larger ? "g_larger" : "g_smaller";
  d.direction = larger ? Direction::LargerIsBetter : Direction::SmallerIsBetter;
  d.full = { -MetricDescription::infinity, MetricDescription::infinity };
  constexpr double above = 1.001, below = 0.999;
  const double sign = larger ? -1.0 : 1.0;
  const Metric wide = registerJacobianMetric(d, Limited{ above * worst, sign });
  d.name += "_narrow";
  d.label = "Narrow";
  const Metric narrow = registerJacobianMetric(d, Limited{ below * worst, sign });
  OptimizeOptions options = with({ Metric::SizeNonBarrier });
  options.holdWorst = false;
  options.worstMetric = narrow;
  const Mesh input(whole.view());
  const OptimizeResult free = optimize(input, options);
  TAUTLINE_CHECK(worstOf(whole, free.points, Metric::InverseMeanRatio) > above * worst);
  options.holdWorst = true;
  options.worstMetric = wide;
  const double limit = (1 + rounding) * worst;
  const OptimizeResult one = optimize(input, options);
  TAUTLINE_CHECK(worstOf(whole, one.points, Metric::InverseMeanRatio) <= limit);
  const Run run = runOn(whole, Cut::Random, 2, options);
  TAUTLINE_CHECK(worstOf(whole, run.points, Metric::InverseMeanRatio) <= limit);

  options.worstMetric = narrow;
  const std::string expected = "The metric \"Narrow\" has no finite value on ";
  TAUTLINE_CHECK_THROWS(optimize(input, options), expected + "cell ");
  int errors = 0; // on all ranks of both runs
  std::mutex mutex;
  for (const bool objective : { false, true })
  {
    options.objectives[0].metric = objective ? narrow : Metric::SizeNonBarrier;
    options.holdWorst = !objective;
    moveOnRanks<Found>(whole, Cut::Random, 3,
      [&](DistributedMesh& mesh, Found& result)
      {
        result.points = mesh.points();
        OptimizeOptions own = options;
        const std::vector<unsigned char> fixed = rankBoundary(mesh);
        own.fixed = fixed.data();
        std::string error = "none";
        try
        {
          optimize(localMesh(mesh), own, {}, Ranks(mesh));
        }
        catch (const Error& e)
        {
          error = e.what();
        }
        const std::lock_guard<std::mutex> lock(mutex);
        errors += error.find(expected) != std::string::npos;
      });
  }
  TAUTLINE_CHECK_EQUAL(errors, 2 * 3);
  unregisterMetric(larger ? "g_larger" : "g_smaller");
  unregisterMetric(d.name);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestGuardsRanks)
{
  TAUTLINE_RUN(testWithoutValue(false));
  TAUTLINE_RUN(testWithoutValue(true));
  constexpr int many = 300, few = 5;
  // Equal sizes at the cost of the shape of single elements.
  const Case cases[] = {
    { CellType::Tetrahedron, 0.25, Metric::SizeNonBarrier, Metric::ScaledJacobian, many, 5 },
    { CellType::Tetrahedron, 0.2, Metric::Size, Metric::EdgeRatio, many, 5 },
    { CellType::Triangle, 0.25, Metric::SizeBarrier, Metric::ScaledJacobian, many, 9 },
    { CellType::Quadrilateral, 0.2, Metric::Size, Metric::InverseMeanRatio, many, 9 },
    { CellType::Hexahedron, 0.25, Metric::Size, Metric::EdgeRatio, few, 5 },
  };
  for (const Case& test : cases)
  {
    const Pace pace = &test == cases ? Pace::Fast : Pace::Slow;
    TAUTLINE_RUN_PART(pace, testGuard(test, Remedy::Improve));
    TAUTLINE_RUN_PART(pace, testGuard(test, Remedy::PutBack));
  }
  // Converged, all points would have to go back.
  TAUTLINE_RUN_SLOW(testGuard(
    { CellType::Hexahedron, 0.25, Metric::Size, Metric::EdgeRatio, many, 4 }, Remedy::Improve));
}
