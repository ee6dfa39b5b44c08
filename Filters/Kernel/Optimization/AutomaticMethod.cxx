// SPDX-License-Identifier: BSD-3-Clause
#include "AutomaticMethod.h"

#include "HarmonicStart.h"
#include "OptionChecks.h"
#include "tautline/Core/Memory.h"

#include <cmath>

namespace tautline
{
namespace
{
/// The maximum number of Newton runs between sweeps; a run that reduces the objective by less than
/// this fraction is the last.
constexpr int maxTurns = 20;
constexpr double worthTurn = 1e-3;

/// A stage of an optimization, and its contribution to the result of the run.
class Stage
{
public:
  Stage(OptimizationSteps& steps, const OptimizeOptions& options,
    std::vector<IterationRecord>& history, StopReason& reason)
    : Steps(steps)
    , Problem(steps.problem())
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
  void takeTurns(const IterationRecord& first);
  void sweep(Slowness* slow)
  {
    this->Reason = this->Steps.sweep(slow, this->Failed, this->Repaired);
  }

  OptimizationSteps& Steps;
  OptimizationProblem& Problem;
  const OptimizeOptions& Options;
  std::vector<IterationRecord>& History;
  StopReason& Reason;
  bool Failed = false, Repaired = false;
  bool Fits = true;    ///< whether the matrix of Newton's method fits into memory
  bool TooFar = false; ///< whether its result was too far from the surface in space
};

//------------------------------------------------------------------------------
/// Whether Newton's method costs less than the sweeps needed to estimate their convergence: for
/// elements whose patches have no closed form.
bool Stage::startsWithNewton(const IterationRecord& first)
{
  return this->Options.objectives.size() == 1 && this->Steps.hasManyCorners() &&
    first.inverted == 0 && this->Steps.hasConvexPart();
}

//------------------------------------------------------------------------------
/// Starts near the harmonic map of the input if elements have no targets, are valid there, and the
/// objective is smaller. The map does not depend on how the input is stretched, and is often close
/// to the minimum.
void Stage::takeHarmonicStart(const std::vector<double>& start)
{
  const IterationRecord& first = this->History.front();
  if (this->Steps.hasConstraintsOrTargets() ||
    this->Options.objectives[0].metric != Metric::InverseMeanRatio || this->Problem.outOfTime() ||
    first.mean[0] < enoughForHarmonicStart)
  {
    return;
  }
  const std::vector<double> harmonic = this->Steps.harmonic(start);
  if (this->Problem.ranks().any(harmonic.size() != start.size()))
  {
    return;
  }
  const auto leads = [&](const std::vector<double>& points)
  {
    this->Problem.restart(points);
    const IterationRecord record = this->Problem.record(0);
    return record.inverted == 0 && record.objective < first.objective;
  };
  if (!leads(harmonic))
  {
    this->Problem.restart(start);
    return;
  }
  // Move away from a saddle as far as elements stay valid.
  constexpr double mostShifted = 0.2, leastShifted = 0.02;
  for (double part = mostShifted; part > leastShifted; part *= 0.5)
  {
    std::vector<double> shifted = harmonic;
    shiftFreePoints(this->Problem, part, shifted);
    if (leads(shifted))
    {
      return;
    }
  }
  this->Problem.restart(harmonic);
}

//------------------------------------------------------------------------------
/// Returns whether the result improves on the sweeps; if not, their points are kept.
bool Stage::useNewton(Slowness slow, const std::vector<double>& start)
{
  // Sweeps smooth local roughness, which may yield a start farther from the minimum for Newton's
  // method.
  this->Problem.store();
  const std::vector<double> swept = this->Problem.points();
  const double reached = this->History.back().objective;
  this->Fits = true;
  try
  {
    if (slow != Slowness::Near)
    {
      this->Problem.restart(start);
      this->takeHarmonicStart(start);
    }
    this->Reason = this->Steps.minimizeAll(Optimizer::NewtonConjugateGradient);
  }
  catch (const MemoryError&)
  {
    this->Fits = false;
    this->Problem.restart(swept);
    return false;
  }
  // If the start is close to the minimum, no iteration may be recorded.
  const IterationRecord found = this->Problem.record(this->History.back().iteration);
  // Inverted elements are excluded from the objective. Newton's method cannot hold individual
  // points of a surface in space that move too far from the original surface.
  this->TooFar =
    this->Problem.moving().dimension() == Dimension::Surface && !this->Problem.isWithinTolerance();
  const bool valid = found.inverted <= this->History.front().inverted && !this->TooFar;
  if (valid && found.objective < this->History.back().objective)
  {
    const bool atStart = this->History.size() == 1; // keep its row
    this->History.resize(this->History.size() + (atStart ? 1 : 0));
    this->History.back() = found;
    this->History.back().iteration += atStart ? 1 : 0;
  }
  if (valid && found.objective < reached)
  {
    return true;
  }
  this->Problem.restart(swept);
  this->History.back() = this->Problem.record(this->History.back().iteration);
  return false;
}

//------------------------------------------------------------------------------
bool Stage::mayGoOn() const
{
  return this->Reason != StopReason::Aborted && this->Reason != StopReason::TimeLimit &&
    this->Reason != StopReason::IterationLimit;
}

//------------------------------------------------------------------------------
/**
 * @brief Alternates sweeps and Newton's method while both pay off: Newton's method holds some
 * points, or stops before the minimum if no step reduces the objective.
 * @param first the record of the start
 */
void Stage::takeTurns(const IterationRecord& first)
{
  // The same on all ranks, including a rank without points.
  const bool slides = this->Steps.slidesOnSurface();
  const std::vector<double> start = slides ? std::vector<double>() : this->Problem.points();
  for (int turn = 0; turn < maxTurns; ++turn)
  {
    Slowness slow = Slowness::Costly;
    if (turn > 0 || slides || !this->startsWithNewton(first))
    {
      slow = Slowness::None;
      this->sweep(&slow);
      if (slow == Slowness::None)
      {
        return;
      }
    }
    const double reached = this->History.back().objective;
    const bool fromStart = turn == 0 && !slides;
    const bool gained = this->useNewton(fromStart ? slow : Slowness::Near, start);
    if (this->Fits && !this->mayGoOn())
    {
      return;
    }
    const bool holds = this->Steps.holdsPoints();
    if (gained && !holds && this->Reason != StopReason::NoProgress)
    {
      return;
    }
    // From the start, it may have ended at a worse result: continue from the result of the sweeps.
    const bool worthAnother = gained
      ? reached - this->History.back().objective > worthTurn * std::abs(reached)
      : this->Fits && !this->TooFar && fromStart && slow != Slowness::Near;
    if (!worthAnother)
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
  if (needDifferences(this->Options))
  {
    this->Reason = this->Steps.minimizeAll(Optimizer::LimitedMemoryBFGS);
    return false;
  }
  if (!onlyLocal && mayUseNewton(this->Options))
  {
    this->takeTurns(first);
  }
  else
  {
    this->sweep(nullptr);
  }
  const bool onPatches = this->Problem.objectives() > 1 && this->Problem.scalarizer().onPatches();
  if (this->Failed && !onlyLocal && !onPatches && !this->Steps.slidesOnSurface())
  {
    this->Reason = this->Steps.minimizeAll(Optimizer::LimitedMemoryBFGS);
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
