// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SweepControl.h
 * @brief When sweeps and other iterations end. Internal: not installed.
 */
#ifndef tautline_SweepControl_h
#define tautline_SweepControl_h

#include "LocalSweep.h"
#include "Minimize.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace tautline
{
/// Sums of element values differ in the last digits from sums of patches; so much is no loss.
constexpr double roundingOfSums = 1e-12;

/// Whether an optimization ends.
class StoppingTest
{
public:
  /// @param outOfTime whether the time limit is reached; of several ranks, on any
  StoppingTest(const StoppingCriteria& stop, std::function<bool()> outOfTime)
    : Stop(stop)
    , OutOfTime(std::move(outOfTime))
  {
  }

  /// Whether the last record of the history is one to stop at.
  bool ends(const std::vector<IterationRecord>& history, StopReason& reason) const
  {
    const IterationRecord& now = history.back();
    const double lowered = history.front().objective - now.objective;
    if (this->Stop.allValid && now.inverted == 0)
    {
      reason = StopReason::AllValid;
    }
    else if (this->Stop.reduction < 1 && history.size() > 1 &&
      lowered >= this->Stop.reduction * this->possibleReduction(history))
    {
      reason = StopReason::Reduction;
    }
    else if (this->Stop.twoDigits && history.size() > 1 && this->sameDigits(history))
    {
      reason = StopReason::TwoDigits;
    }
    else if (now.iteration >= this->Stop.maximumIterations)
    {
      reason = StopReason::IterationLimit;
    }
    else if (this->OutOfTime())
    {
      reason = StopReason::TimeLimit;
    }
    else
    {
      return false;
    }
    return true;
  }

  double progress(const IterationRecord& record) const
  {
    const double byCount =
      static_cast<double>(record.iteration) / std::max(1, this->Stop.maximumIterations);
    const double byTime =
      this->Stop.maximumSeconds > 0 ? record.seconds / this->Stop.maximumSeconds : 0.0;
    return std::min(1.0, std::max(byCount, byTime));
  }

private:
  /// To the best known objective, or to the limit of a geometric series of the last decreases.
  double possibleReduction(const std::vector<IterationRecord>& history) const
  {
    if (std::isfinite(this->Stop.bestKnown))
    {
      return history.front().objective - this->Stop.bestKnown;
    }
    const std::size_t n = history.size();
    if (n < 3)
    {
      return std::numeric_limits<double>::infinity();
    }
    const double last = history[n - 2].objective - history[n - 1].objective;
    const double before = history[n - 3].objective - history[n - 2].objective;
    constexpr double slowest = 0.9; // a ratio above this gives no estimate of the limit
    const double ratio = before > 0 ? std::clamp(last / before, 0.0, slowest) : 0.0;
    return history.front().objective - history.back().objective + last * ratio / (1.0 - ratio);
  }

  static bool sameDigits(const std::vector<IterationRecord>& history)
  {
    constexpr double hundredths = 100;
    const std::vector<double>&now = history.back().mean, &before = history[history.size() - 2].mean;
    for (std::size_t i = 0; i < now.size(); ++i)
    {
      if (std::round(hundredths * now[i]) != std::round(hundredths * before[i]))
      {
        return false;
      }
    }
    return true;
  }

  StoppingCriteria Stop;
  std::function<bool()> OutOfTime;
};

/// The value of the scalarization at the last record. That of the record itself may be of the
/// objective that the lexicographic method reduced before.
inline double scalarized(const Scalarizer& scalarizer, const IterationRecord& record)
{
  return record.objectives.size() > 1 ? scalarizer.value(record.objectives) : record.objective;
}

/// Whether the objective is larger than at the start. In the lexicographic method it is another one
/// in each stage: the first one counts then, which may rise by the tolerance.
inline bool isLarger(const ScalarizationOptions& options, const Scalarizer& scalarizer,
  const IterationRecord& now, const IterationRecord& first)
{
  const bool other = options.method == Scalarization::Lexicographic && scalarizer.stage() > 0;
  const double start = other ? first.objectives[0] : first.objective;
  const double rise = roundingOfSums + (other ? options.tolerance : 0.0);
  return !((other ? now.objectives[0] : now.objective) <= start + rise * std::abs(start));
}

/// What sweeps have gained so far, and what is to be expected of further ones.
class SweepGains
{
public:
  /// @param costly whether a sweep takes much of the time of Newton's method
  explicit SweepGains(bool costly)
    : Trial(costly ? 4 : 7)
  {
  }

  void add(double gain) { this->Gains.push_back(gain); }
  /// Of another objective, from here on.
  void clear() { this->Gains.clear(); }

  /// The objective's distance from its minimum if the gains go on as a geometric series; at least
  /// the last gain.
  double remaining() const
  {
    const double ratio = std::min(this->ratio(), slowest);
    return this->Gains.back() * std::max(1.0, ratio / (1.0 - ratio));
  }

  /// Whether sweeps converge so slowly that a global method is worth its start.
  bool stiff(double objective) const
  {
    constexpr double slow = 0.6;     // isotropic meshes have ratios below a half
    constexpr double worthIt = 0.01; // of the objective, that is still to be gained
    return this->Gains.size() >= this->Trial && this->ratio() > slow &&
      this->remaining() > worthIt * objective;
  }

  /**
   * @brief Whether, if the gains go on as a geometric series, more sweeps are needed until the rest
   * is this fraction of the objective than Newton's method costs near the minimum.
   */
  bool slow(double objective, double relativeChange) const
  {
    constexpr double worthNewton = 25; // sweeps; a run of Newton's method from afar takes 30 to 85
    const double ratio = std::min(this->ratio(), slowest);
    const double rest = this->remaining() / (relativeChange * objective);
    return this->Gains.size() >= this->Trial && relativeChange > 0 && ratio > 0 && rest > 1 &&
      std::log(rest) > -worthNewton * std::log(ratio);
  }

private:
  static constexpr std::size_t window = 3; // sweeps that a ratio is the mean of
  static constexpr double slowest = 0.99;  // ratio that gives an estimate

  /// Of a gain to the one before; 0 where there are too few, or none.
  double ratio() const
  {
    const std::size_t n = this->Gains.size();
    return n > window && this->Gains[n - 1 - window] > 0 && this->Gains[n - 1] > 0
      ? std::cbrt(this->Gains[n - 1] / this->Gains[n - 1 - window])
      : 0.0;
  }

  std::size_t Trial; // sweeps before they are judged
  std::vector<double> Gains;
};

/// How sweeps converge.
enum class Slowness
{
  None,   ///< fast enough
  Costly, ///< each takes so long that none is tried
  Far,    ///< too slowly, and the minimum is far away
  Near    ///< too slowly near the minimum
};

/// Whether Automatic may go over to Newton's method: for one sum that is wanted at its minimum.
inline bool mayUseNewton(const OptimizeOptions& options)
{
  const ObjectiveTemplate objectiveTemplate = options.objectives[0].objectiveTemplate;
  const bool sum = objectiveTemplate != ObjectiveTemplate::PowerMean &&
    objectiveTemplate != ObjectiveTemplate::Maximum;
  const StoppingCriteria& stop = options.stopping;
  return options.optimizer == Optimizer::Automatic && options.objectives.size() == 1 && sum &&
    !options.allowInversion && !(stop.reduction < 1) && !stop.twoDigits && !stop.allValid;
}

/// The criteria as those of a global method. @param alone or after sweeps
inline MinimizeOptions minimizeOptions(const StoppingCriteria& stop, Optimizer method, bool alone)
{
  // After sweeps, an iteration may reduce the objective little at first.
  constexpr double afterSweeps = 0.1;
  MinimizeOptions options;
  options.method = method;
  options.maximumIterations = stop.maximumIterations;
  options.gradientNorm = stop.gradientNorm;
  options.relativeChange = alone ? stop.relativeChange : afterSweeps * stop.relativeChange;
  if (method == Optimizer::NewtonConjugateGradient)
  {
    // Its steps tell how far the minimum is. A gradient small beside that of a start with nearly
    // flat elements tells nothing.
    options.decrement = stop.relativeChange;
    options.relativeChange = options.gradientNorm = 0;
  }
  return options;
}

/// Whether the sweeps have converged, and why; `all`: it visited every vertex.
inline bool converged(const StoppingCriteria& stop, const SweepResult& sweep, bool all,
  double firstGradient, double lowered, double remaining, double size, StopReason& reason)
{
  if (all && sweep.gradientNorm <= stop.gradientNorm * firstGradient)
  {
    reason = StopReason::GradientNorm;
    return true;
  }
  if (remaining <= stop.relativeChange * size)
  {
    reason = StopReason::RelativeChange;
    return true;
  }
  if (lowered == 0)
  {
    reason = StopReason::NoProgress;
    return true;
  }
  return false;
}
}
#endif
