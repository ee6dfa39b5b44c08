// SPDX-License-Identifier: BSD-3-Clause
#include "AutomaticMethod.h"

#include "HarmonicStart.h"
#include "tautline/Core/Memory.h"

#include <cmath>

namespace tautline
{
namespace
{
/// Runs of Newton's method between sweeps, at most; one that reduces the objective by less than
/// this fraction of it is the last.
constexpr int maxTurns = 20;
constexpr double worthTurn = 1e-3;

/// A stage of an optimization, and what it leaves in the result of the run.
class Stage
{
public:
  Stage(OptimizationSteps& steps, const OptimizeOptions& options,
    std::vector<IterationRecord>& history, StopReason& reason)
    : Steps(steps)
    , Options(options)
    , History(history)
    , Reason(reason)
  {
  }

  bool move(bool onlyLocal, const IterationRecord& first);

private:
  bool startsWithNewton(const IterationRecord& first);
  void takeHarmonicStart(const std::vector<double>& start);
  bool useNewton(Slowness slow, const std::vector<double>& start);
  bool mayGoOn() const;
  void takeTurns();
  void sweep(Slowness* slow)
  {
    this->Reason = this->Steps.sweep(slow, this->Failed, this->Repaired);
  }

  OptimizationSteps& Steps;
  const OptimizeOptions& Options;
  std::vector<IterationRecord>& History;
  StopReason& Reason;
  bool Failed = false, Repaired = false;
};

//------------------------------------------------------------------------------
/// Whether Newton's method costs less than the sweeps that would tell how they converge: for
/// elements whose patches have no closed form.
bool Stage::startsWithNewton(const IterationRecord& first)
{
  return this->Steps.hasMostlyCorners() && first.inverted == 0 && this->Steps.hasConvexPart();
}

//------------------------------------------------------------------------------
/// Starts at the harmonic map of the input if elements are free of targets there, valid, and the
/// objective is smaller. It does not depend on how the input is stretched, and is often close to
/// the minimum.
void Stage::takeHarmonicStart(const std::vector<double>& start)
{
  const IterationRecord& first = this->History.front();
  if (this->Steps.slidesOrHasTargets() ||
    this->Options.objectives[0].metric != Metric::InverseMeanRatio || this->Steps.outOfTime() ||
    first.mean[0] < enoughForHarmonicStart)
  {
    return;
  }
  std::vector<double> harmonic = start;
  if (!this->Steps.findHarmonicPoints(harmonic))
  {
    return;
  }
  this->Steps.restart(harmonic);
  const IterationRecord record = this->Steps.record(0);
  if (record.inverted > 0 || !(record.objective < first.objective))
  {
    this->Steps.restart(start);
  }
}

//------------------------------------------------------------------------------
/// Returns whether that leads further than the sweeps have; if not, it sweeps to the end where that
/// is worth it.
bool Stage::useNewton(Slowness slow, const std::vector<double>& start)
{
  // Sweeps smooth what is rough and leave a start that is often further for Newton's method.
  this->Steps.store();
  const std::vector<double> swept = this->Steps.stored();
  const double reached = this->History.back().objective;
  bool fits = true;
  try
  {
    if (slow != Slowness::Near)
    {
      this->Steps.restart(start);
      this->takeHarmonicStart(start);
    }
    this->Reason = this->Steps.minimizeAll(Optimizer::NewtonConjugateGradient);
  }
  catch (const MemoryError&)
  {
    fits = false;
  }
  if (!fits)
  {
    this->Steps.restart(swept);
    this->sweep(nullptr);
    return false;
  }
  // Where the harmonic map is the minimum, no iteration is recorded.
  IterationRecord& last = this->History.back();
  const IterationRecord found = this->Steps.record(last.iteration);
  last = found.objective < last.objective ? found : last;
  if (found.objective < reached)
  {
    return true;
  }
  this->Steps.restart(swept);
  last = this->Steps.record(last.iteration);
  const bool stuck = slow == Slowness::Costly && this->Reason == StopReason::NoProgress;
  if (stuck || (slow == Slowness::Near && this->Reason != StopReason::Aborted))
  {
    this->sweep(nullptr);
  }
  return false;
}

//------------------------------------------------------------------------------
bool Stage::mayGoOn() const
{
  return this->Reason != StopReason::Aborted && this->Reason != StopReason::TimeLimit &&
    this->Reason != StopReason::IterationLimit;
}

//------------------------------------------------------------------------------
/// Sweeps for all points, and Newton's method for those that it does not hold, while both pay.
void Stage::takeTurns()
{
  for (int turn = 0; turn < maxTurns; ++turn)
  {
    Slowness slow = Slowness::None;
    this->sweep(&slow);
    if (slow == Slowness::None)
    {
      return;
    }
    const double reached = this->History.back().objective;
    const bool gained = this->useNewton(Slowness::Near, {});
    if (!gained || !this->mayGoOn() || !this->Steps.holdsPoints())
    {
      return;
    }
    if (reached - this->History.back().objective < worthTurn * std::abs(reached))
    {
      break;
    }
  }
  this->sweep(nullptr);
}

//------------------------------------------------------------------------------
bool Stage::move(bool onlyLocal, const IterationRecord& first)
{
  const Optimizer optimizer = this->Options.optimizer;
  if (isGlobal(optimizer))
  {
    this->Reason = this->Steps.minimizeAll(optimizer);
    return false;
  }
  Slowness slow = Slowness::None;
  const bool mayGoOver = !onlyLocal && mayUseNewton(this->Options);
  if (this->Steps.slidesOnSurface())
  {
    mayGoOver ? this->takeTurns() : this->sweep(nullptr);
    return this->Repaired;
  }
  const std::vector<double> start = mayGoOver ? this->Steps.stored() : std::vector<double>();
  if (mayGoOver && this->startsWithNewton(first))
  {
    slow = Slowness::Costly;
  }
  else
  {
    this->sweep(mayGoOver ? &slow : nullptr);
  }
  if (this->Failed && !onlyLocal)
  {
    this->Reason = this->Steps.minimizeAll(Optimizer::LimitedMemoryBFGS);
  }
  else if (slow != Slowness::None)
  {
    this->useNewton(slow, start);
  }
  return this->Repaired;
}
}

//------------------------------------------------------------------------------
bool movePoints(OptimizationSteps& steps, const OptimizeOptions& options, bool onlyLocal,
  const IterationRecord& first, std::vector<IterationRecord>& history, StopReason& reason)
{
  const bool local = onlyLocal || isLocal(options.optimizer);
  return Stage(steps, options, history, reason).move(local, first);
}
}
