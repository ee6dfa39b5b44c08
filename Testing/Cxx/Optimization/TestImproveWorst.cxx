// SPDX-License-Identifier: BSD-3-Clause
// Rounds that improve the worst element: each that counts improves it, costs the mean no more than
// allowed and inverts nothing; the points come from the last such round.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Optimization/ImproveWorst.h"

#include <utility>

using namespace tautline;

namespace
{
/// The data after a round, computed from its points.
struct Round
{
  std::vector<double> points;
  double worst = 0, mean = 0;
};

/// A run of improveWorst() by itself, from given points.
class Rounds
{
public:
  /// @param from the points to begin with; the guard has the points of `data`
  Rounds(const MeshData& data, Metric metric, ObjectiveTemplate objectiveTemplate)
    : Data(data)
    , TheMesh(this->Data.view())
    , TheMetric(metric)
  {
    this->Options.threads = 1;
    this->Options.worstMetric = metric;
    this->Options.objectives[0].metric = metric;
    this->Options.objectives[0].objectiveTemplate = objectiveTemplate;
  }

  OptimizeOptions& options() { return this->Options; }

  /// @param most rounds after which report() stops the run; 0: none
  std::vector<Round> from(
    const std::vector<double>& start, const WorstLimits& limits, std::size_t most = 0)
  {
    std::vector<double> points = start;
    OptimizationProblem problem(this->TheMesh, this->Options, points, Stopwatch());
    problem.start(problem.record(0));
    const QualityGuard guard(this->TheMesh, this->Options);
    std::vector<Round> rounds = { this->at(start) };
    improveWorst(problem, guard, limits,
      [&](const IterationRecord& record)
      {
        rounds.push_back(this->at(points));
        TAUTLINE_CHECK_RELATIVE(record.mean[0], rounds.back().mean, 1e-10);
        TAUTLINE_CHECK_EQUAL(invalid(this->Data, points), Index(0));
        return rounds.size() - 1 != most;
      });
    problem.store();
    double off = largestOf<double>(0, points.size(),
      [&](std::size_t i) { return std::abs(points[i] - rounds.back().points[i]); });
    TAUTLINE_CHECK(off < 1e-12);
    return rounds;
  }

private:
  Round at(const std::vector<double>& points) const
  {
    MeshData moved = TAUTLINE_CHANGED(this->Data, points = points);
    const std::vector<double> q = valuesOf(moved, this->TheMetric);
    const std::vector<char> boundary = Mesh(this->Data.view()).boundary().isBoundaryPoint;
    TAUTLINE_LET(Round, round, points = points);
    const bool larger = metricInfo(this->TheMetric).direction == Direction::LargerIsBetter;
    round.worst = larger ? 1e300 : -1e300;
    for (Index c = 0; c < moved.numberOfCells(); ++c)
    {
      const auto begin = moved.connectivity.begin() + moved.offsets[c],
                 end = moved.connectivity.begin() + moved.offsets[c + 1];
      if (std::any_of(begin, end, [&](Index p) { return !boundary[p]; }))
      {
        round.worst = larger ? std::min(round.worst, q[c]) : std::max(round.worst, q[c]);
      }
      round.mean += q[c] / static_cast<double>(moved.numberOfCells());
    }
    return round;
  }

  MeshData Data;
  Mesh TheMesh;
  Metric TheMetric;
  OptimizeOptions Options;
};

/// A block with a wavy side, so that its elements cannot be equal.
MeshData wavy(CellType type)
{
  MeshData data = perturbedBlock(type, 6, 0.12);
  data.transform(
    TAUTLINE_PLACE(p[0] * (1 + 0.1 * std::sin(1.3 * p[1])), p[1], p[2] * (1 + p[0] / 8)));
  return data;
}

/// Metrics whose small values are better, and whose large ones are; in closed form and not.
TAUTLINE_PART(testRounds)
{
  const std::tuple<CellType, Metric, ObjectiveTemplate> cases[] = {
    { CellType::Tetrahedron, Metric::InverseMeanRatio, ObjectiveTemplate::SumOfSquares },
    { CellType::Triangle, Metric::InverseMeanRatio, ObjectiveTemplate::SumOfSquares },
    { CellType::Hexahedron, Metric::InverseMeanRatio, ObjectiveTemplate::SumOfSquares },
    { CellType::Triangle, Metric::MeanRatio, ObjectiveTemplate::SumOfSquaredReciprocals },
    { CellType::Quadrilateral, Metric::MeanRatio, ObjectiveTemplate::SumOfReciprocals },
  };
  for (const auto& [type, metric, objectiveTemplate] : cases)
  {
    const Context context(std::string(topology(type).name) + ", " + metricInfo(metric).name);
    const MeshData data = wavy(type);
    Rounds rounds(data, metric, objectiveTemplate);
    const double sign = metricInfo(metric).direction == Direction::LargerIsBetter ? -1 : 1;
    // Where the mean is the smallest, the worst element can only improve at its cost.
    OptimizeOptions least = TAUTLINE_CHANGED(rounds.options(), stopping.relativeChange = 1e-10);
    const std::vector<double> start = run(data, least).points;
    // In closed form, a round that gains little is the last.
    constexpr double worthwhile = 1e-3;
    const bool closed = metric == Metric::InverseMeanRatio && topology(type).samples == 1;
    // No limit, and the cost of the first of these rounds as the limit.
    double allowance = 0.5;
    for (const bool tight : { false, true })
    {
      const Context which(tight ? "tight" : "wide");
      const std::vector<Round> found = rounds.from(start, { allowance, false });
      TAUTLINE_CHECK(found.size() > 1);
      for (std::size_t i = 1; i < found.size(); ++i)
      {
        TAUTLINE_CHECK(sign * (found[i].worst - found[i - 1].worst) < 0);
        const double gain = std::abs(found[i].worst / found[i - 1].worst - 1);
        TAUTLINE_CHECK(!closed || i + 1 == found.size() || gain >= worthwhile);
        TAUTLINE_CHECK(
          sign * (found[i].mean - found[0].mean) <= allowance * found[0].mean * (1 + 1e-9));
      }
      std::cout << std::setprecision(6) << topology(type).name << ", " << metricInfo(metric).name
                << ", allowance " << allowance << ": " << found.size() - 1 << " rounds, worst "
                << found[0].worst << " -> " << found.back().worst << ", mean " << found[0].mean
                << " -> " << found.back().mean << "\n";
      allowance = 1.01 * sign * (found[1].mean / found[0].mean - 1);
    }
    // As many as asked for, and none without time.
    TAUTLINE_CHECK_EQUAL(rounds.from(start, { 0.5, false }, 1).size(), std::size_t(2));
    rounds.options().stopping.maximumSeconds = 1e-9;
    TAUTLINE_CHECK_EQUAL(rounds.from(start, { 0.5, false }).size(), std::size_t(1));
  }
}

/// If the worst element is worse than the input's, no cost counts until it is as good; without a
/// further aim the run ends there.
TAUTLINE_PART(testBackToInput)
{
  for (const CellType type : { CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const MeshData data = wavy(type);
    Rounds rounds(data, Metric::InverseMeanRatio, ObjectiveTemplate::SumOfSquares);
    OptimizeOptions least = TAUTLINE_CHANGED(rounds.options(), stopping.relativeChange = 1e-10);
    MeshData input = TAUTLINE_CHANGED(data, points = run(data, least).points);
    // The input has a better worst element than the start, at the cost of the mean.
    const std::vector<double> start = input.points;
    const std::vector<Round> better = rounds.from(start, { 0.5, false });
    input.points = better[std::min<std::size_t>(2, better.size() - 1)].points;
    Rounds again(input, Metric::InverseMeanRatio, ObjectiveTemplate::SumOfSquares);
    // The guard also counts the elements that cannot move.
    const std::vector<double> q = valuesOf(input, Metric::InverseMeanRatio);
    const double worst = *std::max_element(q.begin(), q.end());
    const std::vector<Round> back = again.from(start, { 0, true });
    TAUTLINE_CHECK(back.front().worst > 1.02 * worst);
    TAUTLINE_CHECK(back.back().mean > back.front().mean);
    TAUTLINE_CHECK(back.size() > 1 && back.back().worst <= worst * (1 + 1e-9));
    for (std::size_t i = 0; i + 1 < back.size(); ++i)
    {
      TAUTLINE_CHECK(back[i].worst > worst * (1 + 1e-9));
    }
    const std::vector<Round> further = again.from(start, { 0.5, false });
    TAUTLINE_CHECK(further.size() > back.size());
    TAUTLINE_CHECK(further.back().worst < back.back().worst);
    std::cout << topology(type).name << ": worst " << worst << " of the input, "
              << back.front().worst << " -> " << back.back().worst << " in " << back.size() - 1
              << " rounds, " << further.back().worst << " in " << further.size() - 1 << "\n";
  }
}

/// Where cells have several corners, the worst element counts more and more, until that no longer
/// pays; where a round costs too much, less once more. Bounds are between what is reached so and
/// what otherwise: 1.2984 (1.5498 of wedges) always, and 1.28705 (1.53746) where the cost ends it.
TAUTLINE_PART(testPull)
{
  using Bounds = std::vector<std::pair<double, double>>; // of allowances
  const std::pair<CellType, Bounds> cases[] = {
    { CellType::Hexahedron, { { 0.5, 1.285 }, { 0.01, 1.287 } } },
    { CellType::Wedge, { { 0.5, 1.535 }, { 0.01, 1.5374 } } },
  };
  for (const auto& [type, bounds] : cases)
  {
    const Context context(topology(type).name);
    const MeshData data = wavy(type);
    Rounds rounds(data, Metric::InverseMeanRatio, ObjectiveTemplate::SumOfSquares);
    OptimizeOptions least = TAUTLINE_CHANGED(rounds.options(), stopping.relativeChange = 1e-10);
    const std::vector<double> start = run(data, least).points;
    double last = 0;
    for (const auto& [allowance, most] : bounds)
    {
      const Round found = rounds.from(start, { allowance, false }).back();
      std::cout << std::setprecision(9) << topology(type).name << ", allowance " << allowance
                << ": worst " << found.worst << ", mean " << found.mean << "\n";
      TAUTLINE_CHECK(found.worst < most);
      TAUTLINE_CHECK(found.worst > last);
      last = found.worst;
    }
  }
}

/// The first sweep of a round visits the free points of elements with a share of at least 1e-5 in
/// the p-mean, beside the worst element's; and no others.
TAUTLINE_PART(testVerticesNear)
{
  for (const CellType type : { CellType::Tetrahedron, CellType::Hexahedron })
  {
    for (const Metric metric : { Metric::ScaledJacobian, Metric::EdgeRatio })
    {
      const Context context(std::string(topology(type).name) + ", " + metricInfo(metric).name);
      const MeshData data = wavy(type);
      const Mesh mesh(data.view());
      OptimizeOptions options;
      std::vector<double> points = data.points;
      OptimizationProblem problem(mesh, options, points, Stopwatch());
      TAUTLINE_LET(Objective, judged, metric = metric);
      const std::vector<double> q = valuesOf(data, metric);
      const bool larger = metricInfo(metric).direction == Direction::LargerIsBetter;
      const double worst =
        larger ? *std::min_element(q.begin(), q.end()) : *std::max_element(q.begin(), q.end());
      for (const double power : { 32.0, 128.0 })
      {
        std::vector<char> near(data.numberOfPoints(), 0);
        for (Index c = 0; c < data.numberOfCells(); ++c)
        {
          const double share = std::pow(larger ? worst / q[c] : q[c] / worst, power);
          for (Index n = data.offsets[c]; share >= 1e-5 && n < data.offsets[c + 1]; ++n)
          {
            near[data.connectivity[n]] = 1;
          }
        }
        const std::vector<unsigned char> flags =
          problem.verticesNear(judged, problem.measure(judged), worst, power);
        const SimplexMesh& simplices = problem.simplices();
        TAUTLINE_CHECK_EQUAL(flags.size(), static_cast<std::size_t>(simplices.freeVertices()));
        Index visited = 0;
        for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
        {
          TAUTLINE_CHECK_EQUAL(flags[v] != 0, near[simplices.point(v)] != 0);
          visited += flags[v] != 0;
        }
        TAUTLINE_CHECK(visited > 0 && visited < simplices.freeVertices());
      }
    }
  }
}

/// Metrics without a barrier, on many meshes: no round that counts makes the worst element worse,
/// or inverts one where that is allowed to single steps.
TAUTLINE_PART(testManyMeshes)
{
  std::size_t rounds = 0;
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Quadrilateral })
  {
    for (const Metric metric : { Metric::EdgeRatio, Metric::MeanRatio, Metric::RadiusRatio })
    {
      for (unsigned seed = 1; metricInfo(metric).definedOn(type) && seed <= 4; ++seed)
      {
        const Context context(std::string(topology(type).name) + ", " + metricInfo(metric).name +
          ", seed " + std::to_string(seed));
        const Index n = topology(type).dimension == 2 ? 6 : 3;
        const MeshData data =
          perturbedBlock(type, n, type == CellType::Tetrahedron ? 0.2 : 0.3, seed);
        if (invalid(data, data.points) > 0)
        {
          continue;
        }
        Rounds run(data, metric, ObjectiveTemplate::Default);
        run.options().allowInversion = true;
        const std::vector<Round> found = run.from(data.points, { 10, false });
        const double sign = metricInfo(metric).direction == Direction::LargerIsBetter ? -1 : 1;
        for (std::size_t i = 1; i < found.size(); ++i)
        {
          TAUTLINE_CHECK(sign * (found[i].worst - found[i - 1].worst) < 0);
        }
        rounds += found.size() - 1;
      }
    }
  }
  std::cout << rounds << " rounds on many meshes\n";
  TAUTLINE_CHECK(rounds > 50);
}

/// A point in a flat triangle, whose edges become equal outside of it: a round that takes it there
/// is not kept, also where single steps may invert.
TAUTLINE_PART(testInversion)
{
  MeshData data;
  const Index left = data.addPoint({ -1, 0, 0 }), right = data.addPoint({ 1, 0, 0 }),
              top = data.addPoint({ 0, 0.3, 0 }), inner = data.addPoint({ 0.05, 0.1, 0 });
  data.addCell(CellType::Triangle, std::vector<Index>{ left, right, inner });
  data.addCell(CellType::Triangle, std::vector<Index>{ right, top, inner });
  data.addCell(CellType::Triangle, std::vector<Index>{ top, left, inner });
  Rounds rounds(data, Metric::EdgeRatio, ObjectiveTemplate::SumOfSquares);
  rounds.options().allowInversion = true;
  // Sweeps for the mean do go there.
  TAUTLINE_CHECK_EQUAL(run(data, rounds.options()).invertedAfter, Index(1));
  const std::vector<Round> found = rounds.from(data.points, { 10, false }); // which checks it
  std::cout << "flat triangle: " << found.size() - 1 << " rounds\n";
}

/// Sizes are neither good nor bad: there is no worst one.
TAUTLINE_PART(testNeutral)
{
  const MeshData data = wavy(CellType::Tetrahedron);
  Rounds rounds(data, Metric::Size, ObjectiveTemplate::SumOfSquares);
  TAUTLINE_CHECK_EQUAL(rounds.from(data.points, { 0.5, false }).size(), std::size_t(1));
}
}
