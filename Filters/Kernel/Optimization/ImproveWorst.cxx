// SPDX-License-Identifier: BSD-3-Clause
#include "ImproveWorst.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tautline
{
namespace
{
constexpr int maxRounds = 100;
constexpr int sweepsPerRound = 4;
/// A round that reduces the worst value by less than this fraction is the last.
constexpr double worthwhile = 1e-3;
/// p, one after the other: with the first, elements at 0.8 of the worst value have a thousandth of
/// its share; with the last, those at 0.95.
constexpr double powers[] = { 32, 128 };
/// How much more the elements near the worst one count where a round no longer pays, and at most.
constexpr double stronger = 4;
constexpr double strongest = 256;
/// In closed form, sweeps begin at elements above this fraction of the worst value: the others have
/// a share below 1e-5.
constexpr double nearWorst = 0.7;

/// What a round minimizes.
class WorstObjectives
{
public:
  /// @param power of the second sum
  /// @param pull how much more that counts than the first
  WorstObjectives(
    OptimizationProblem& problem, const Objective& judged, double worst, double power, double pull)
    : Pull(pull)
    , Terms(problem.localTerms())
    , Fast(Terms[0].shapePower > 0 && judged.metric == Metric::InverseMeanRatio)
  {
    this->Terms.resize(1);
    if (this->Fast)
    {
      this->Terms[0].worst = worst;
      return;
    }
    Objective mean = judged;
    mean.objectiveTemplate = ObjectiveTemplate::PowerMean;
    mean.power = power;
    this->Sum = &problem.sum(0);
    this->Mean = std::make_unique<ObjectiveSum>(problem.moving(), mean, problem.options().threads);
    LocalTerm second;
    second.metric = this->Mean.get();
    this->Terms.push_back(second);
    this->First = this->values();
  }

  const std::vector<LocalTerm>& terms() const { return this->Terms; }

  std::vector<double> values() const
  {
    return this->Fast ? std::vector<double>{ 1.0 }
                      : std::vector<double>{ this->Sum->value(), this->Mean->value() };
  }

  /// Both by the changes relative to where they start.
  Scalarizer scalarizer() const
  {
    ScalarizationOptions options;
    options.method = Scalarization::WeightedSum;
    std::vector<double> weights = { 1.0 };
    if (!this->Fast)
    {
      weights = { 1.0 / std::abs(this->First[0]), this->Pull / std::abs(this->First[1]) };
    }
    return Scalarizer(options, weights, this->values());
  }

  bool fast() const { return this->Fast; }

  /// Whether both can be reduced relative to where they start: a sum of values that are all 0 is
  /// at its best.
  bool canImprove() const
  {
    return this->Fast || (std::abs(this->First[0]) > 0 && std::abs(this->First[1]) > 0);
  }

private:
  double Pull;
  std::vector<LocalTerm> Terms;
  bool Fast;
  const ObjectiveSum* Sum = nullptr;
  std::unique_ptr<ObjectiveSum> Mean;
  std::vector<double> First;
};
}

namespace
{
/// The first objective, with the metric of the worst element.
Objective judgedBy(OptimizationProblem& problem)
{
  Objective judged = problem.sum(0).objective();
  const Metric metric = worstMetric(problem.moving(), problem.options());
  if (metric != judged.metric)
  {
    judged.metric = metric;
    judged.evaluation = EvaluationOptions();
    judged.evaluation.threads = problem.options().threads;
  }
  return judged;
}
}

//------------------------------------------------------------------------------
bool improveWorst(OptimizationProblem& problem, const QualityGuard& guard,
  const WorstLimits& limits, const std::function<bool(const IterationRecord&)>& report)
{
  problem.shareTolerance(1.0);
  const Objective judged = judgedBy(problem);
  const auto isLarger = [](Metric metric)
  { return metricInfo(metric).direction == Direction::LargerIsBetter; };
  const bool larger = isLarger(judged.metric);
  const IterationRecord start = problem.record(0);
  double worst = problem.worstMovable(judged); // elements that cannot move do not count
  if (!std::isfinite(worst) || metricInfo(judged.metric).direction == Direction::Neutral)
  {
    return false;
  }
  const auto better = [=](double a, double b) { return larger ? a > b : a < b; };
  const double sign = isLarger(problem.options().objectives[0].metric) ? -1 : 1;
  const double mean = limits.mean.value_or(start.mean[0]);
  const double bound = mean + sign * limits.allowance * std::abs(mean);

  SimplexMesh& simplices = problem.simplices();
  const std::size_t size = VertexStride * static_cast<std::size_t>(simplices.freeVertices());
  std::vector<double> best(simplices.coordinates(), simplices.coordinates() + size);
  const double* power = std::begin(powers);
  double pull = 1.0;
  bool lowered = false; // the pull, once, because its cost was too high
  for (int round = 0; round < maxRounds && !problem.outOfTime(); ++round)
  {
    const WorstObjectives objectives(problem, judged, worst, *power, pull);
    if (!objectives.canImprove())
    {
      return false;
    }
    LocalOptions options = problem.localOptions();
    options.newton = true;
    options.relaxation = 1.0;
    LocalSweeper sweeper(
      simplices, problem.moving(), problem.points().data(), objectives.terms(), options);
    const Scalarizer scalarizer = objectives.scalarizer();
    // The simplices have the targets of the objective, the metric that judges may have none.
    const bool ofSimplices = objectives.fast() && simplices.uniform();
    if (ofSimplices)
    {
      sweeper.wakeOnly(problem.verticesAbove(nearWorst * worst));
    }
    for (int i = 0; i < sweepsPerRound; ++i)
    {
      std::vector<double> values = objectives.values();
      sweeper.sweep(scalarizer, values);
    }
    problem.store();
    IterationRecord now = problem.record(0);
    const double reached = ofSimplices ? problem.worstRatioMovable() : problem.worstMovable(judged);
    const bool affordable = sign * (now.mean[0] - bound) <= 0 || guard.worse(worst);
    const bool kept = better(reached, worst) && affordable && now.inverted <= start.inverted;
    const double gain = kept ? std::abs(worst - reached) / std::abs(worst) : 0.0;
    if (kept)
    {
      worst = reached;
      std::copy_n(simplices.coordinates(), size, best.begin());
      if (!report(now) || (limits.onlyAsInput && !guard.worse(worst)))
      {
        return false;
      }
    }
    else
    {
      std::copy(best.begin(), best.end(), simplices.coordinates());
      problem.store();
    }
    if (!affordable && !lowered && pull > 1)
    {
      lowered = true;
      pull /= stronger;
    }
    else if (gain < worthwhile)
    {
      pull *= stronger;
      if (objectives.fast() || !affordable || lowered || pull > strongest)
      {
        if (objectives.fast() || ++power == std::end(powers))
        {
          return false;
        }
        pull = 1.0;
        lowered = false;
      }
    }
  }
  return problem.outOfTime();
}
}
