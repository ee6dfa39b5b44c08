// SPDX-License-Identifier: BSD-3-Clause
// Steps of all vertices of a mesh on several ranks at once, and when Automatic takes them; see
// Optimize.cxx for the same on one process.
#include "GlobalFunctionOnRanks.h"
#include "HarmonicStart.h"
#include "OptimizationOnRanks.h"
#include "tautline/Core/Memory.h"

namespace tautline
{
//------------------------------------------------------------------------------
const RankRows& OptimizationOnRanks::rows()
{
  if (!this->Rows)
  {
    this->Rows = std::make_unique<RankRows>(this->TheMesh, this->Free);
  }
  return *this->Rows;
}

//------------------------------------------------------------------------------
/// Moves the points to convergence, by the optimizer wanted.
void OptimizationOnRanks::move(const IterationRecord& first, bool& repaired)
{
  const Optimizer optimizer = this->Options.optimizer;
  if (isGlobal(optimizer))
  {
    this->Result.reason = this->minimizeAll(optimizer);
    return;
  }
  const bool onlyLocal = isLocal(optimizer) || this->Group.any(this->Options.limits != nullptr);
  const bool mayGoOver = !onlyLocal && mayUseNewton(this->Options);
  const std::vector<double> start = mayGoOver ? this->Points : std::vector<double>();
  Slowness slow = Slowness::None;
  bool failed = false;
  if (mayGoOver && this->startsWithNewton(first))
  {
    slow = Slowness::Costly;
  }
  else
  {
    this->Result.reason = this->sweep(mayGoOver ? &slow : nullptr, failed, repaired);
  }
  if (failed && !onlyLocal)
  {
    this->Result.reason = this->minimizeAll(Optimizer::LimitedMemoryBFGS);
  }
  else if (slow != Slowness::None)
  {
    this->useNewton(slow, start, failed, repaired);
  }
}

//------------------------------------------------------------------------------
/// See optimizeGlobally() in Optimize.cxx.
StopReason OptimizationOnRanks::minimizeAll(Optimizer method)
{
  const StoppingCriteria& stop = this->Options.stopping;
  std::vector<IterationRecord>& history = this->Result.history;
  StopReason reason = StopReason::NoProgress;
  if (this->Watch.ends(history, reason))
  {
    return reason;
  }
  const bool alone = isGlobal(this->Options.optimizer);
  GlobalFunctionOnRanks function(this->TheMesh, this->rows(), this->Problem.get(),
    *this->TheScalarizer, this->Options.objectives.size(), method, this->Coordinates,
    this->Options.threads);
  std::vector<double> x(function.size(), 0.0);
  const auto put = [&](const double* at)
  {
    function.put(at);
    // Points of the piece without a cell here.
    this->TheMesh.exchange(this->Points.data(), 3);
  };
  for (;;)
  {
    const int before = history.back().iteration;
    MinimizeOptions options = minimizeOptions(stop, method, alone);
    options.maximumIterations -= before;
    options.outOfTime = [&] { return this->outOfTime(); };
    options.threads = this->Options.threads;
    options.group = &this->Group;
    bool ended = false;
    options.observer = [&](int iteration, double, double gradientNorm, const double* now)
    {
      put(now);
      IterationRecord record = this->record(before + iteration);
      record.gradientNorm = gradientNorm;
      if (!this->report(record))
      {
        reason = StopReason::Aborted;
        ended = true;
      }
      else
      {
        ended = this->Watch.ends(history, reason);
      }
      return !ended;
    };
    const MinimizeResult found = minimize(function, x.data(), options);
    put(x.data());
    if (ended)
    {
      return reason;
    }
    if (!this->TheScalarizer->next(this->record(0).objectives))
    {
      return found.reason;
    }
  }
}

//------------------------------------------------------------------------------
/// Whether Newton's method costs less than the sweeps that would tell how they converge.
bool OptimizationOnRanks::startsWithNewton(const IterationRecord& first)
{
  Index simplices = 0, others = 0;
  const MeshView& view = this->TheMesh.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellTopology& t = topology(cornerType(view.cellTypes[cell]));
    if (this->TheMesh.ownedCells()[cell] && t.dimension == this->Coordinates)
    {
      ++(t.samples > 1 ? others : simplices);
    }
  }
  const bool most = this->Group.sum(others) > this->Group.sum(simplices);
  const bool convex = !this->Problem || HessianMatrix::hasConvexPart(this->Problem->resolved()[0]);
  return most && first.inverted == 0 && !this->Group.any(!convex);
}

//------------------------------------------------------------------------------
/// Starts at the harmonic map of the input where that helps; see Optimize.cxx.
void OptimizationOnRanks::takeHarmonicStart(const std::vector<double>& start)
{
  const IterationRecord& first = this->Result.history.front();
  if (this->Group.any(this->Options.slidePlanes || this->Options.slideLines) ||
    this->Options.objectives[0].metric != Metric::InverseMeanRatio || this->outOfTime() ||
    first.mean[0] < enoughForHarmonicStart)
  {
    return;
  }
  std::vector<double> harmonic = start;
  if (!harmonicPointsOnRanks(
        this->TheMesh, this->rows(), this->Problem.get(), this->Options.threads, harmonic))
  {
    return;
  }
  this->load(harmonic);
  const IterationRecord record = this->record(0);
  if (record.inverted > 0 || !(record.objective < first.objective))
  {
    this->load(start);
  }
}

//------------------------------------------------------------------------------
/// Newton's method where sweeps cost too much or converge too slowly; see Optimize.cxx.
void OptimizationOnRanks::useNewton(
  Slowness slow, const std::vector<double>& start, bool& failed, bool& repaired)
{
  this->store();
  const std::vector<double> swept = this->Points;
  const double reached = this->Result.history.back().objective;
  bool fits = true;
  try
  {
    if (slow != Slowness::Near)
    {
      this->load(start);
      this->takeHarmonicStart(start);
    }
    this->Result.reason = this->minimizeAll(Optimizer::NewtonConjugateGradient);
  }
  catch (const MemoryError&) // on all ranks
  {
    fits = false;
  }
  if (!fits)
  {
    this->load(swept);
    this->Result.reason = this->sweep(nullptr, failed, repaired);
    return;
  }
  std::vector<IterationRecord>& history = this->Result.history;
  const IterationRecord found = this->record(history.back().iteration);
  if (found.objective < history.back().objective)
  {
    history.back() = found;
  }
  if (!(found.objective < reached))
  {
    this->load(swept);
    history.back() = this->record(history.back().iteration);
    const bool stuck = slow == Slowness::Costly && this->Result.reason == StopReason::NoProgress;
    if (stuck || (slow == Slowness::Near && this->Result.reason != StopReason::Aborted))
    {
      this->Result.reason = this->sweep(nullptr, failed, repaired);
    }
  }
}
}
