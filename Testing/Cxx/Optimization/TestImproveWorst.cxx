// Rounds that improve the worst element: each that counts improves it, costs the mean no more than
// allowed and inverts nothing; the points are those of the last such round.
#include "Optimizing.h"

#include "tautline/Core/Stopwatch.h"
#include "tautline/Optimization/ImproveWorst.h"

#include <numeric>
#include <utility>

using namespace tautline;

namespace
{
/// What is known after a round, computed from its points.
struct Round
{
  std::vector<double> points;
  double worst = 0, mean = 0;
};

/// A run of improveWorst() by itself, from given points.
class Rounds
{
public:
  /// @param from the points to begin with; the guard knows those of `data`
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
    double off = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      off = std::max(off, std::abs(points[i] - rounds.back().points[i]));
    }
    TAUTLINE_CHECK(off < 1e-12);
    return rounds;
  }

private:
  Round at(const std::vector<double>& points) const
  {
    MeshData moved = this->Data;
    moved.points = points;
    const std::vector<double> q = valuesOf(moved, this->TheMetric);
    const std::vector<char> boundary = Mesh(this->Data.view()).boundary().isBoundaryPoint;
    Round round;
    round.points = points;
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
    [](const Vec3& p) {
      return Vec3{ p[0] * (1 + 0.1 * std::sin(1.3 * p[1])), p[1], p[2] * (1 + p[0] / 8) };
    });
  return data;
}

/// Metrics whose small values are better, and whose large ones are; in closed form and not.
void testRounds()
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
    OptimizeOptions least = rounds.options();
    least.stopping.relativeChange = 1e-10;
    const std::vector<double> start = run(data, least).points;
    // As much as one wants, and what the first of those rounds costs.
    double allowance = 0.5;
    for (const bool tight : { false, true })
    {
      const Context which(tight ? "tight" : "wide");
      const std::vector<Round> found = rounds.from(start, { allowance, false });
      TAUTLINE_CHECK(found.size() > 1);
      for (std::size_t i = 1; i < found.size(); ++i)
      {
        TAUTLINE_CHECK(sign * (found[i].worst - found[i - 1].worst) < 0);
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

/// Where the worst element is worse than that of the input, no cost counts until it is as good; and
/// that is all, if no more is wanted.
void testBackToInput()
{
  for (const CellType type : { CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const MeshData data = wavy(type);
    Rounds rounds(data, Metric::InverseMeanRatio, ObjectiveTemplate::SumOfSquares);
    OptimizeOptions least = rounds.options();
    least.stopping.relativeChange = 1e-10;
    MeshData input = data;
    input.points = run(data, least).points;
    // One point of it moved: its cells are worse than the input.
    std::vector<double> start = input.points;
    const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    const double limit = 1.1 * worstMovable(input, input.points);
    for (Index p = 0; p < data.numberOfPoints() && worstMovable(input, start) < limit; ++p)
    {
      for (double step = 0.2; !boundary[p] && step < 0.6; step += 0.1)
      {
        std::vector<double> moved = input.points;
        moved[3 * p] += step;
        if (invalid(input, moved) == 0)
        {
          start = moved;
        }
      }
    }
    Rounds again(input, Metric::InverseMeanRatio, ObjectiveTemplate::SumOfSquares);
    const double worst = again.from(input.points, { 0, true }).front().worst;
    const std::vector<Round> back = again.from(start, { 0, true });
    TAUTLINE_CHECK(back.front().worst > 1.05 * worst);
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

/// Sizes are neither good nor bad: there is no worst one.
void testNeutral()
{
  const MeshData data = wavy(CellType::Tetrahedron);
  Rounds rounds(data, Metric::Size, ObjectiveTemplate::SumOfSquares);
  TAUTLINE_CHECK_EQUAL(rounds.from(data.points, { 0.5, false }).size(), std::size_t(1));
}
}

int TestImproveWorst(int, char*[])
{
  testRounds();
  testBackToInput();
  testNeutral();
  return exitCode();
}
