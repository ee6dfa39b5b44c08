// SPDX-License-Identifier: BSD-3-Clause
#include "ImproveWorst.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tautline
{
namespace
{
constexpr int maxWorstRounds = 100;
/// A round that reduces the worst value by less than this fraction is the last.
constexpr double worthwhile = 1e-3;
/// p, one after the other: with the first, elements at 0.8 of the worst value have a thousandth of
/// its share; with the last, those at 0.95.
constexpr double powers[] = { 32, 128 };
/// How much more the elements near the worst one count where a round no longer pays, and at most.
constexpr double stronger = 4;
constexpr double strongest = 256;
/// A p-mean that has fallen below this fraction is computed anew: its change in units of the p-th
/// power has lost digits.
constexpr double trusted = 0.9;

/// What a round minimizes.
class WorstObjectives
{
public:
  /// @param mean the second sum
  /// @param pull how much more that counts than the first
  WorstObjectives(OptimizationProblem& problem, double worst, const ObjectiveSum* mean, double pull)
    : Pull(pull)
    , Terms(problem.localTerms())
    , Mean(mean)
  {
    this->Terms.resize(1);
    if (!this->Mean)
    {
      this->Terms[0].worst = worst;
      return;
    }
    this->Sum = &problem.sum(0);
    LocalTerm second;
    second.metric = this->Mean;
    this->Terms.push_back(second);
    this->First = this->values();
  }

  const std::vector<LocalTerm>& terms() const { return this->Terms; }

  std::vector<double> values() const
  {
    return this->Mean ? std::vector<double>{ this->Sum->value(), this->Mean->value() }
                      : std::vector<double>{ 1.0 };
  }

  /// The values at the points of the start.
  std::vector<double> first() const { return this->Mean ? this->First : this->values(); }

  Scalarizer scalarizer() const { return worstScalarizer(this->First, this->Pull, this->first()); }

  /// Whether both can be reduced relative to where they start: a sum of values that are all 0 is
  /// at its best.
  bool canImprove() const
  {
    return !this->Mean || (std::abs(this->First[0]) > 0 && std::abs(this->First[1]) > 0);
  }

private:
  double Pull;
  std::vector<LocalTerm> Terms;
  const ObjectiveSum* Sum = nullptr;
  const ObjectiveSum* Mean; ///< null: one closed form
  std::vector<double> First;
};
}

namespace
{
/// The first objective, with the metric of the worst element.
Objective judgedBy(OptimizationProblem& problem)
{
  return judgedAs(problem.sum(0).objective(), worstMetric(problem.moving(), problem.options()),
    problem.options().threads);
}

/// The steps on one process.
class StepsOfWorst : public WorstSteps
{
public:
  explicit StepsOfWorst(OptimizationProblem& problem)
    : Problem(problem)
    , Judged(judgedBy(problem))
    , Fast(problem.localTerms()[0].shapePower > 0 && Judged.metric == Metric::InverseMeanRatio)
    , Best(problem.simplices().coordinates(), problem.simplices().coordinates() + this->size())
  {
  }

  const Objective& judged() const { return this->Judged; }
  bool outOfTime() const override { return this->Problem.outOfTime(); }
  IterationRecord record() override { return this->Problem.record(0); }
  /// Elements that cannot move do not count.
  double worst() override
  {
    this->AtBest = this->Problem.measure(this->Judged);
    return this->Problem.worstMovable(this->Judged, this->AtBest);
  }
  double reached() override
  {
    if (this->OfSimplices)
    {
      return this->Problem.worstRatioMovable();
    }
    this->Now = this->Problem.measure(this->Judged);
    return this->Problem.worstMovable(this->Judged, this->Now);
  }
  bool isFast() override { return this->Fast; }

  bool sweep(double worst, double power, double pull) override
  {
    const WorstObjectives objectives(
      this->Problem, worst, this->Fast ? nullptr : this->meanOf(power), pull);
    if (!objectives.canImprove())
    {
      return false;
    }
    SimplexMesh& simplices = this->Problem.simplices();
    LocalSweeper sweeper(simplices, this->Problem.moving(), this->Problem.points().data(),
      objectives.terms(), worstOptions(this->Problem));
    const Scalarizer scalarizer = objectives.scalarizer();
    // The simplices have the targets of the objective, the metric that judges may have none.
    this->OfSimplices = this->Fast && simplices.uniform();
    if (this->OfSimplices)
    {
      sweeper.wakeOnly(this->Problem.verticesAbove(nearWorst * worst));
    }
    else if (!this->Fast)
    {
      sweeper.wakeOnly(this->Problem.verticesNear(this->Judged, this->AtBest, worst, power));
    }
    std::vector<double> values = objectives.first();
    for (int i = 0; i < sweepsPerRound; ++i)
    {
      const double before = values.back();
      sweeper.sweep(scalarizer, values);
      if (i + 1 < sweepsPerRound && (this->Fast || !(values.back() > trusted * before)))
      {
        values = objectives.values();
      }
    }
    this->Problem.store();
    return true;
  }

  void keep() override
  {
    std::copy_n(this->Problem.simplices().coordinates(), this->size(), this->Best.begin());
    std::swap(this->AtBest, this->Now);
  }
  void goBack() override
  {
    std::copy(this->Best.begin(), this->Best.end(), this->Problem.simplices().coordinates());
    this->Problem.store();
  }

private:
  std::size_t size() const
  {
    return VertexStride * static_cast<std::size_t>(this->Problem.simplices().freeVertices());
  }

  /// The p-mean of the metric that judges. Kept from round to round.
  const ObjectiveSum* meanOf(double power)
  {
    if (!this->Mean || this->Power != power)
    {
      Objective mean = this->Judged;
      mean.objectiveTemplate = ObjectiveTemplate::PowerMean;
      mean.power = this->Power = power;
      this->Mean = std::make_unique<ObjectiveSum>(
        this->Problem.moving(), mean, this->Problem.options().threads);
    }
    return this->Mean.get();
  }

  OptimizationProblem& Problem;
  Objective Judged;
  bool Fast, OfSimplices = false;
  std::unique_ptr<ObjectiveSum> Mean;
  double Power = 0;
  std::vector<double> Best;
  OptimizationProblem::Measured AtBest, Now; ///< by the metric that judges, not of simplices
};
}

//------------------------------------------------------------------------------
Objective judgedAs(Objective objective, Metric metric, int threads)
{
  if (metric != objective.metric)
  {
    objective.metric = metric;
    objective.evaluation = EvaluationOptions();
    objective.evaluation.threads = threads;
  }
  return objective;
}

LocalOptions worstOptions(const OptimizationProblem& problem)
{
  LocalOptions options = problem.localOptions();
  options.newton = true;
  options.relaxation = 1.0;
  return options;
}

Scalarizer worstScalarizer(
  const std::vector<double>& first, double pull, const std::vector<double>& now)
{
  ScalarizationOptions options;
  options.method = Scalarization::WeightedSum;
  std::vector<double> weights = { 1.0 };
  if (!first.empty())
  {
    weights = { 1.0 / std::abs(first[0]), pull / std::abs(first[1]) };
  }
  return Scalarizer(options, weights, now);
}

//------------------------------------------------------------------------------
bool improveWorst(WorstSteps& steps, Metric judged, Metric ofMean,
  const std::function<bool(double)>& isWorse, const WorstLimits& limits,
  const std::function<bool(const IterationRecord&)>& report)
{
  const auto isLarger = [](Metric metric)
  { return metricInfo(metric).direction == Direction::LargerIsBetter; };
  const bool larger = isLarger(judged);
  const IterationRecord start = steps.record();
  double worst = steps.worst();
  if (!std::isfinite(worst) || metricInfo(judged).direction == Direction::Neutral)
  {
    return false;
  }
  const auto better = [=](double a, double b) { return larger ? a > b : a < b; };
  const double sign = isLarger(ofMean) ? -1 : 1;
  const double mean = limits.mean.value_or(start.mean[0]);
  const double bound = mean + sign * limits.allowance * std::abs(mean);

  const double* power = std::begin(powers);
  double pull = 1.0;
  bool lowered = false; // the pull, once, because its cost was too high
  for (int round = 0; round < maxWorstRounds && !steps.outOfTime(); ++round)
  {
    if (!steps.sweep(worst, *power, pull))
    {
      return false;
    }
    IterationRecord now = steps.record();
    const double reached = steps.reached();
    const bool affordable = sign * (now.mean[0] - bound) <= 0 || isWorse(worst);
    const bool kept = better(reached, worst) && affordable && now.inverted <= start.inverted;
    const double gain = kept ? std::abs(worst - reached) / std::abs(worst) : 0.0;
    if (kept)
    {
      worst = reached;
      steps.keep();
      if (!report(now) || (limits.onlyAsInput && !isWorse(worst)))
      {
        return false;
      }
    }
    else
    {
      steps.goBack();
    }
    if (!affordable && !lowered && pull > 1)
    {
      lowered = true;
      pull /= stronger;
    }
    else if (gain < worthwhile)
    {
      pull *= stronger;
      if (steps.isFast() || !affordable || lowered || pull > strongest)
      {
        if (steps.isFast() || ++power == std::end(powers))
        {
          return false;
        }
        pull = 1.0;
        lowered = false;
      }
    }
  }
  return steps.outOfTime();
}

bool improveWorst(OptimizationProblem& problem, const QualityGuard& guard,
  const WorstLimits& limits, const std::function<bool(const IterationRecord&)>& report)
{
  problem.shareTolerance(1.0);
  StepsOfWorst steps(problem);
  return improveWorst(
    steps, steps.judged().metric, problem.options().objectives[0].metric,
    [&guard](double worst) { return guard.worse(worst); }, limits, report);
}
}
