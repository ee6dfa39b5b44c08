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
/// The number of sweeps in a round and, for the closed form, the fraction of the worst value above
/// which elements contribute initially: the others have a share below 1e-5.
constexpr int sweepsPerRound = 4;
constexpr double nearWorst = 0.7;
/// A round that reduces the worst value by less than this fraction is the last.
constexpr double worthwhile = 1e-3;
/// The successive values of p: with the first, elements at 0.8 of the worst value have a thousandth
/// of its share; with the last, elements at 0.95.
constexpr double powers[] = { 32, 128 };
/// The factor by which the weight of elements near the worst one increases when a round no longer
/// pays off, and its maximum.
constexpr double stronger = 4;
constexpr double strongest = 256;
/// A p-mean that has fallen below this fraction is recomputed: its change in units of the p-th
/// power has lost digits.
constexpr double trusted = 0.9;

/// An objective with the metric of the worst element, without targets if it is a different metric.
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

/// The options of the sweeps.
LocalOptions worstOptions(const OptimizationProblem& problem)
{
  LocalOptions options = problem.localOptions();
  options.newton = true;
  options.relaxation = 1.0;
  return options;
}

/// Scalarizes the sums by their changes relative to the start.
/// @param first their values at the start; empty: one closed form
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

/// The objectives of a round.
class WorstObjectives
{
public:
  /// @param mean the second sum
  /// @param pull its weight relative to the first
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

  /// Whether both can be reduced relative to the start: a sum of zeros is already optimal, and a
  /// nonfinite sum has no scale.
  bool canImprove() const
  {
    return !this->Mean ||
      std::all_of(this->First.begin(), this->First.end(),
        [](double sum) { return sum != 0 && std::isfinite(sum); });
  }

private:
  double Pull;
  std::vector<LocalTerm> Terms;
  const ObjectiveSum* Sum = nullptr;
  const ObjectiveSum* Mean; ///< null: one closed form
  std::vector<double> First;
};

/// The first objective, with the metric of the worst element.
Objective judgedBy(OptimizationProblem& problem)
{
  return judgedAs(problem.sum(0).objective(), worstMetric(problem.moving(), problem.options()),
    problem.options().threads);
}

/// Whether the sums of all ranks have one closed form; ranks without cells support any form.
bool isFast(OptimizationProblem& problem, Metric judged)
{
  return !problem.ranks().any(problem.moving().view().numberOfCells > 0 &&
    (problem.localTerms()[0].shapePower == 0 || judged != Metric::InverseMeanRatio));
}

/// The steps, and the best points so far.
class StepsOfWorst
{
public:
  explicit StepsOfWorst(OptimizationProblem& problem)
    : Problem(problem)
    , Judged(judgedBy(problem))
    , Fast(tautline::isFast(problem, Judged.metric))
    , Best(problem.simplices().coordinates(), problem.simplices().coordinates() + this->size())
  {
  }

  const Objective& judged() const { return this->Judged; }
  /// The worst value of the decisive metric among the elements with a free point; infinite if there
  /// are none.
  double worst()
  {
    this->AtBest = this->Problem.measure(this->Judged);
    return this->Problem.worstMovable(this->Judged, this->AtBest);
  }
  /// The same after sweep().
  double reached()
  {
    if (this->OfSimplices)
    {
      return this->Problem.worstRatioMovable();
    }
    this->Now = this->Problem.measure(this->Judged);
    return this->Problem.worstMovable(this->Judged, this->Now);
  }
  /// Whether both sums have one closed form, without a pull.
  bool isFast() const { return this->Fast; }

  /**
   * @brief A few sweeps, and stores the points.
   * @param worst the worst value so far
   * @param power of the second sum
   * @param pull its weight relative to the first
   * @return false without a sweep if one of the sums is 0 already
   */
  bool sweep(double worst, double power, double pull)
  {
    const WorstObjectives objectives(
      this->Problem, worst, this->Fast ? nullptr : this->meanOf(power), pull);
    if (!objectives.canImprove())
    {
      return false;
    }
    SimplexMesh& simplices = this->Problem.simplices();
    LocalSweeper sweeper(simplices, this->Problem.moving(), this->Problem.points().data(),
      objectives.terms(), worstOptions(this->Problem), &this->Problem.order());
    const Scalarizer scalarizer = objectives.scalarizer();
    // The simplices have the targets of the objective; the decisive metric may have none.
    this->OfSimplices = this->Fast && !this->Problem.ranks().any(!simplices.uniform());
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

  /// Keeps the current points; the counterpart restores the last kept points or the start.
  void keep()
  {
    std::copy_n(this->Problem.simplices().coordinates(), this->size(), this->Best.begin());
    std::swap(this->AtBest, this->Now);
  }
  void goBack()
  {
    std::copy(this->Best.begin(), this->Best.end(), this->Problem.simplices().coordinates());
    this->Problem.coordinatesChanged();
    this->Problem.store();
  }

private:
  std::size_t size() const
  {
    return VertexStride * static_cast<std::size_t>(this->Problem.simplices().freeVertices());
  }

  /// The p-mean of the decisive metric. Kept from round to round.
  const ObjectiveSum* meanOf(double power)
  {
    if (!this->Mean || this->Power != power)
    {
      Objective mean = this->Judged;
      mean.objectiveTemplate = ObjectiveTemplate::PowerMean;
      mean.power = this->Power = power;
      this->Mean = std::make_unique<ObjectiveSum>(
        this->Problem.moving(), mean, this->Problem.options().threads, this->Problem.ranks());
    }
    return this->Mean.get();
  }

  OptimizationProblem& Problem;
  Objective Judged;
  bool Fast, OfSimplices = false;
  std::unique_ptr<ObjectiveSum> Mean;
  double Power = 0;
  std::vector<double> Best;
  OptimizationProblem::Measured AtBest, Now; ///< with the decisive metric, not for simplices
};
}

//------------------------------------------------------------------------------
bool improveWorst(OptimizationProblem& problem, const QualityGuard& guard,
  const WorstLimits& limits, const std::function<bool(const IterationRecord&)>& report)
{
  problem.shareTolerance(1.0);
  StepsOfWorst steps(problem);
  const Metric judged = steps.judged().metric, ofMean = problem.options().objectives[0].metric;
  const auto isLarger = [](Metric metric)
  { return metricInfo(metric).direction == Direction::LargerIsBetter; };
  const bool larger = isLarger(judged);
  const IterationRecord start = problem.record(0);
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
  bool lowered = false; // whether the pull was reduced once because its cost was too high
  for (int round = 0; round < maxWorstRounds && !problem.outOfTime(); ++round)
  {
    if (!steps.sweep(worst, *power, pull))
    {
      return false;
    }
    IterationRecord now = problem.record(0);
    const double reached = steps.reached();
    const bool affordable = sign * (now.mean[0] - bound) <= 0 || guard.worse(worst);
    const bool kept = better(reached, worst) && affordable && now.inverted <= start.inverted;
    const double gain = kept ? std::abs(worst - reached) / std::abs(worst) : 0.0;
    if (kept)
    {
      worst = reached;
      steps.keep();
      if (!report(now) || (limits.onlyAsInput && !guard.worse(worst)))
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
  return problem.outOfTime();
}
}
