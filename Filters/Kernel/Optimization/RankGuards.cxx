// SPDX-License-Identifier: BSD-3-Clause
// What an optimization on ranks must not make worse: validity, the worst element, the objective.
// See settleWorst() and verify() in Optimize.cxx for the same on one process.
#include "OptimizationOnRanks.h"

#include "ImproveWorst.h"
#include "RankSweep.h"
#include "tautline/Objectives/ObjectiveSumState.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
//------------------------------------------------------------------------------
/// The steps that improve the worst element, of a mesh on several ranks.
class OptimizationOnRanks::StepsOfWorst : public WorstSteps
{
public:
  explicit StepsOfWorst(OptimizationOnRanks& run);

  bool outOfTime() const override { return this->Run.outOfTime(); }
  IterationRecord record() override { return this->Run.record(0); }
  double worst() override;
  double reached() override { return this->worst(); }
  bool isFast() override { return this->Fast; }
  bool sweep(double worst, double power, double pull) override;
  void keep() override { this->Best = this->Run.Points; }
  void goBack() override { this->Run.restart(this->Best); }

private:
  std::vector<double> values(double power) const;
  double valueOfMean(double power) const;

  OptimizationOnRanks& Run;
  Objective Judged; ///< with the weights of the local cells
  bool Larger, Fast;
  double TotalWeight = 0;             ///< of the elements that are judged
  std::unique_ptr<ObjectiveSum> Mean; ///< the p-mean of the metric that judges
  double Power = 0;                   ///< its p
  std::vector<double> Best;
};

//------------------------------------------------------------------------------
OptimizationOnRanks::StepsOfWorst::StepsOfWorst(OptimizationOnRanks& run)
  : Run(run)
{
  const Metric metric = run.Guard->judged().metric;
  this->Larger = metricInfo(metric).direction == Direction::LargerIsBetter;
  bool general = metric != Metric::InverseMeanRatio;
  std::vector<double> weights;
  this->Judged = judgedAs(
    run.Problem ? run.Resolved[0] : run.Options.objectives[0], metric, run.Options.threads);
  this->Best = run.Points;
  general = general || (run.Problem && run.Problem->localTerms()[0].shapePower == 0);
  const MetricInfo& info = metricInfo(metric);
  for (Index cell = 0; run.Problem && cell < run.TheMesh.view().numberOfCells; ++cell)
  {
    const CellType type = cornerType(run.TheMesh.view().cellTypes[cell]);
    if (run.TheMesh.ownedCells()[cell] && type != CellType::Unsupported && info.definedOn(type))
    {
      weights.push_back(this->Judged.elementWeights ? this->Judged.elementWeights[cell] : 1.0);
    }
  }
  this->Fast = !run.Group.any(general);
  this->TotalWeight = run.Group.orderlessSum(weights);
}

//------------------------------------------------------------------------------
/// Elements that cannot move do not count.
double OptimizationOnRanks::StepsOfWorst::worst()
{
  const RankGuard::Elements elements = this->Run.Guard->measure(this->Run.Points);
  const MeshView& view = this->Run.TheMesh.view();
  double worst = -infinity; // larger the worse
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index *begin = view.connectivity + view.offsets[cell],
                *end = view.connectivity + view.offsets[cell + 1];
    const bool movable = std::any_of(begin, end, [&](Index p) { return this->Run.Free[p] != 0; });
    if (movable && elements.validity[cell] == Valid)
    {
      worst = std::max(worst, elements.values[cell]);
    }
  }
  worst = this->Run.Group.maximum(worst);
  return this->Larger ? -worst : worst;
}

//------------------------------------------------------------------------------
/// The p-mean of the metric that judges, see ElementFunction; infinite where it has no value.
double OptimizationOnRanks::StepsOfWorst::valueOfMean(double power) const
{
  const DistributedMesh& mesh = this->Run.TheMesh;
  const RankGuard::Elements elements = this->Run.Guard->measure(this->Run.Points);
  std::vector<double> terms, weights;
  double largest = 0;
  bool fault = false;
  for (Index cell = 0; cell < mesh.view().numberOfCells; ++cell)
  {
    const double weight = this->Judged.elementWeights ? this->Judged.elementWeights[cell] : 1.0;
    const double value = elements.values[cell];
    if (!mesh.ownedCells()[cell] || value == -infinity || !(weight > 0))
    {
      continue;
    }
    // Larger is better: the reciprocals, of the values without their sign.
    fault = fault || elements.validity[cell] != Valid || (this->Larger && !(value < 0));
    terms.push_back(this->Larger ? -1 / value : std::abs(value));
    weights.push_back(weight);
    largest = std::max(largest, terms.back());
  }
  largest = this->Run.Group.maximum(largest);
  if (this->Run.Group.any(fault) || !std::isfinite(largest) || !(this->TotalWeight > 0))
  {
    return infinity;
  }
  for (std::size_t i = 0; i < terms.size(); ++i)
  {
    terms[i] = weights[i] * std::pow(largest > 0 ? terms[i] / largest : 0.0, power);
  }
  const double sum = this->Run.Group.orderlessSum(terms);
  return largest * std::pow(sum / this->TotalWeight, 1 / power);
}

//------------------------------------------------------------------------------
std::vector<double> OptimizationOnRanks::StepsOfWorst::values(double power) const
{
  if (this->Fast)
  {
    return { 1.0 };
  }
  const IterationRecord record = this->Run.record(0);
  return { record.objectives[0], this->valueOfMean(power) };
}

//------------------------------------------------------------------------------
bool OptimizationOnRanks::StepsOfWorst::sweep(double worst, double power, double pull)
{
  OptimizationProblem* problem = this->Run.Problem.get();
  SweepTerms sweeps;
  bool uniform = true;
  if (problem)
  {
    sweeps.options = worstOptions(*problem);
    sweeps.terms = problem->localTerms();
    sweeps.terms.resize(1);
    uniform = problem->simplices().uniform();
    if (this->Fast)
    {
      sweeps.terms[0].worst = worst;
    }
    else if (!this->Mean || this->Power != power)
    {
      Objective second = this->Judged;
      second.objectiveTemplate = ObjectiveTemplate::PowerMean;
      second.power = this->Power = power;
      this->Mean =
        std::make_unique<ObjectiveSum>(problem->moving(), second, this->Run.Options.threads, true);
      this->Mean->setTotalWeight(this->TotalWeight);
    }
    if (!this->Fast)
    {
      sweeps.terms.emplace_back();
      sweeps.terms.back().metric = this->Mean.get();
    }
  }
  const std::vector<double> start = this->values(power);
  if (!this->Fast &&
    std::any_of(start.begin(), start.end(), [](double v) { return !std::isfinite(v) || v == 0; }))
  {
    return false;
  }
  const Scalarizer scalarizer =
    worstScalarizer(this->Fast ? std::vector<double>() : start, pull, start);
  RankSweeper sweeper(
    this->Run.TheMesh, problem, this->Run.Sets, this->Run.Options.threads, &sweeps);
  const bool ofSimplices = this->Fast && !this->Run.Group.any(!uniform);
  if (problem && (ofSimplices || !this->Fast))
  {
    sweeper.wakeOnly(ofSimplices
        ? problem->verticesAbove(nearWorst * worst)
        : problem->verticesNear(this->Judged, problem->measure(this->Judged), worst, power));
  }
  for (int i = 0; i < sweepsPerRound; ++i)
  {
    sweeper.sweep(scalarizer, i == 0 ? start : this->values(power));
  }
  this->Run.store();
  return true;
}

//------------------------------------------------------------------------------
/// Improves the worst element at least to that of the input; where that does not do, points go
/// back.
void OptimizationOnRanks::settleWorst()
{
  if (!this->Guard->active() || !this->Guard->violatedAt(this->Guard->measure(this->Points)))
  {
    return;
  }
  if (this->Result.reason != StopReason::Aborted && this->Result.reason != StopReason::TimeLimit)
  {
    StepsOfWorst steps(*this);
    bool stopped = false;
    const WorstLimits limits{ 0.0, true };
    const bool outOfTime = improveWorst(
      steps, this->Guard->judged().metric, this->Options.objectives[0].metric,
      [this](double worst) { return this->Guard->worse(worst); }, limits,
      [&](IterationRecord record)
      {
        record.iteration = this->Result.history.back().iteration + 1;
        stopped = !this->report(record);
        return !stopped;
      });
    this->Result.reason = stopped ? StopReason::Aborted
      : outOfTime                 ? StopReason::TimeLimit
                                  : this->Result.reason;
  }
  this->Result.restored = this->restoreWorst();
  if (this->Result.restored > 0)
  {
    this->report(this->record(this->Result.history.back().iteration + 1));
  }
}

//------------------------------------------------------------------------------
/// Puts points back to where they were in the input, about the elements that are invalid or worse
/// than all of the input, until there is none. What a rank has no memory for is an error on all.
Index OptimizationOnRanks::restoreWorst()
{
  constexpr int maxRounds = 20; // then all points go back
  const MeshView& view = this->TheMesh.view();
  std::vector<unsigned char> restored, back;
  std::vector<double> points;
  restored.assign(this->TheMesh.localPoints(), 0);
  for (int round = 0;; ++round)
  {
    const RankGuard::Elements elements = this->Guard->measure(this->Points);
    back = restored;
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      const bool offends = round >= maxRounds || this->Guard->offends(elements, cell);
      for (Index n = view.offsets[cell]; offends && n < view.offsets[cell + 1]; ++n)
      {
        back[view.connectivity[n]] = 1;
      }
    }
    this->TheMesh.exchange(back.data());
    if (!this->Group.any(back != restored))
    {
      break;
    }
    restored.swap(back);
    points = this->Points;
    for (Index p = 0; p < this->TheMesh.localPoints(); ++p)
    {
      if (restored[p])
      {
        std::copy_n(&this->TheMesh.points()[3 * p], 3, &points[3 * p]);
      }
    }
    this->restart(points);
  }
  Index count = 0;
  for (Index p = 0; p < this->TheMesh.localPoints(); ++p)
  {
    count += restored[p] && this->TheMesh.owned(p);
  }
  return this->Group.sum(count);
}

//------------------------------------------------------------------------------
/// Goes back to the input if its objective is smaller.
void OptimizationOnRanks::keepInput(const IterationRecord& first)
{
  IterationRecord now = this->record(this->Result.history.back().iteration);
  if (!this->Guard->active() ||
    !isLarger(this->Options.scalarization, *this->TheScalarizer, now, first))
  {
    return;
  }
  this->restart(this->TheMesh.points());
  now = this->record(now.iteration);
  now.objective = first.objective;
  this->Result.history.back() = now;
  if (this->Result.reason != StopReason::Aborted && this->Result.reason != StopReason::TimeLimit)
  {
    this->Result.reason = StopReason::NoProgress;
  }
  this->Result.unchanged = true;
  this->Result.restored = 0;
}
}
