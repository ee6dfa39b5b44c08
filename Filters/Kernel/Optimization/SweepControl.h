// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SweepControl.h
 * @brief Stopping rules of sweeps and other iterations.
 * Internal: not installed.
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
/// Sums of element values differ in the last digits from sums of patches; smaller differences are
/// not a deterioration.
constexpr double roundingOfSums = 1e-12;

/// Decides whether an optimization ends.
class StoppingTest
{
public:
  /// @param outOfTime returns whether the time limit is reached, on any rank
  StoppingTest(const OptimizeOptions& options, std::function<bool()> outOfTime)
    : Stop(options.stopping)
    , Shape(!options.objectives.empty() && options.objectives[0].metric == Metric::InverseMeanRatio)
    , OutOfTime(std::move(outOfTime))
  {
  }

  /// Whether to stop at the last record of the history.
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
  /**
   * @brief The reduction to the best known objective, or to the limit of a geometric series of the
   * last decreases; infinity if inconclusive. Ratios of decreases tend to grow: the largest of the
   * last ones is used, plus its growth.
   */
  double possibleReduction(const std::vector<IterationRecord>& history) const
  {
    if (std::isfinite(this->Stop.bestKnown))
    {
      return history.front().objective - this->Stop.bestKnown;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double slowest = 0.9;           // a ratio above this gives no estimate of the limit
    const std::size_t n = history.size() - 1; // decreases
    if (n < this->decreasesNeeded(history.back()))
    {
      return infinity;
    }
    const auto decrease = [&](std::size_t i)
    { return history[n - i - 1].objective - history[n - i].objective; };
    const auto ratioAt = [&](std::size_t i)
    { return decrease(i + 1) > 0 ? decrease(i) / decrease(i + 1) : 0.0; };
    double ratio = 0;
    for (std::size_t i = 0; i + 1 < n && i < ratiosCompared; ++i)
    {
      ratio = std::max(ratio, ratioAt(i));
    }
    ratio += n > 2 ? std::max(0.0, ratioAt(0) - ratioAt(1)) : 0.0;
    return ratio > slowest
      ? infinity
      : history.front().objective - history.back().objective + decrease(0) * ratio / (1.0 - ratio);
  }

  /// The first decreases are dominated by individual nearly flat elements, if there are any.
  std::size_t decreasesNeeded(const IterationRecord& now) const
  {
    constexpr double flat = 3; // mean inverse mean ratio; 1 is ideal
    constexpr std::size_t ofGoodShape = 2, ofOtherMetrics = 3, ofFlat = 6;
    return !this->Shape ? ofOtherMetrics : now.mean[0] > flat ? ofFlat : ofGoodShape;
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

  static constexpr std::size_t ratiosCompared = 3;

  StoppingCriteria Stop;
  bool Shape; ///< whether the first metric is the inverse mean ratio
  std::function<bool()> OutOfTime;
};

/// The value of the scalarization at the last record. The value stored in the record may refer to
/// the previous objective of the lexicographic method.
inline double scalarized(const Scalarizer& scalarizer, const IterationRecord& record)
{
  return record.objectives.size() > 1 ? scalarizer.value(record.objectives) : record.objective;
}

/// The record with a finite objective for the history, if possible. In the lexicographic method, it
/// is infinite if restored points have increased an earlier objective beyond its bound: then the
/// objective of the current stage is used.
inline IterationRecord presentable(const Scalarizer& scalarizer, IterationRecord record)
{
  if (scalarizer.stage() > 0 && !std::isfinite(record.objective))
  {
    record.objective = record.objectives[scalarizer.stage()];
  }
  return record;
}

/// Whether the objective is larger than at the start. The lexicographic method has a different
/// objective in each stage: the first one is used, which may increase by the tolerance.
inline bool isLarger(const ScalarizationOptions& options, const Scalarizer& scalarizer,
  const IterationRecord& now, const IterationRecord& first)
{
  const bool other = options.method == Scalarization::Lexicographic && scalarizer.stage() > 0;
  const double start = other ? first.objectives[0] : first.objective;
  const double rise = roundingOfSums + (other ? options.tolerance : 0.0);
  return !((other ? now.objectives[0] : now.objective) <= start + rise * std::abs(start));
}

/// The gains of sweeps so far, and the expected gains of further ones.
class SweepGains
{
public:
  /// @param costly whether a sweep takes much of the time of Newton's method
  explicit SweepGains(bool costly)
    : Trial(costly ? 4 : 7)
  {
  }

  void add(double gain) { this->Gains.push_back(gain); }
  /// Starts over for another objective.
  void clear() { this->Gains.clear(); }

  /// The distance of the objective from its minimum if the gains continue as a geometric series; at
  /// least the last gain.
  double remaining() const
  {
    const double ratio = std::min(this->ratio(), slowest);
    return this->Gains.back() * std::max(1.0, ratio / (1.0 - ratio));
  }

  /// Whether sweeps converge so slowly that a global method pays off.
  bool stiff(double objective) const
  {
    constexpr double slow = 0.6;     // isotropic meshes have ratios below a half
    constexpr double worthIt = 0.01; // fraction of the objective that can still be gained
    return this->Gains.size() >= this->Trial && this->ratio() > slow &&
      this->remaining() > worthIt * std::abs(objective);
  }

  /**
   * @brief Whether, with gains continuing as a geometric series, the sweeps needed until the rest
   * is this fraction of the objective cost more than Newton's method near the minimum.
   */
  bool slow(double objective, double relativeChange) const
  {
    constexpr double worthNewton = 25; // sweeps; a Newton run from a distant start costs 30 to 85
    const double ratio = std::min(this->ratio(), slowest);
    const double rest = this->remaining() / (relativeChange * std::abs(objective));
    return this->Gains.size() >= this->Trial && relativeChange > 0 && ratio > 0 && rest > 1 &&
      std::log(rest) > -worthNewton * std::log(ratio);
  }

private:
  static constexpr std::size_t window = 3; // number of sweeps over which a ratio is averaged
  static constexpr double slowest = 0.99;  // ratio that gives an estimate

  /// The ratio of a gain to the previous one; 0 if there are too few, or none.
  double ratio() const
  {
    const std::size_t n = this->Gains.size();
    return n > window && this->Gains[n - 1 - window] > 0 && this->Gains[n - 1] > 0
      ? std::cbrt(this->Gains[n - 1] / this->Gains[n - 1 - window])
      : 0.0;
  }

  std::size_t Trial; // number of sweeps before the rate is estimated
  std::vector<double> Gains;
};

/// The convergence of sweeps.
enum class Slowness
{
  None,   ///< fast enough
  Costly, ///< each sweep takes so long that none is tried
  Far,    ///< too slowly, and the minimum is far away
  Near    ///< too slowly near the minimum
};

/// Whether Automatic may switch to Newton's method: for a single, sufficiently smooth function that
/// is minimized to convergence.
inline bool mayUseNewton(const OptimizeOptions& options)
{
  const auto rough = [](const Objective& o)
  { return o.objectiveTemplate == ObjectiveTemplate::Maximum; };
  const bool lexicographic =
    options.objectives.size() > 1 && options.scalarization.method == Scalarization::Lexicographic;
  const bool onPatches = options.objectives.size() > 1 && options.scalarization.onPatches;
  const StoppingCriteria& stop = options.stopping;
  return options.optimizer == Optimizer::Automatic && !lexicographic && !onPatches &&
    stop.maximumIterations > 0 &&
    std::none_of(options.objectives.begin(), options.objectives.end(), rough) &&
    !options.allowInversion && !(stop.reduction < 1) && !stop.twoDigits && !stop.allValid;
}

/// Converts the criteria for a global method. @param alone whether it runs alone, not after sweeps
inline MinimizeOptions minimizeOptions(const StoppingCriteria& stop, Optimizer method, bool alone)
{
  // After sweeps, the first iterations may reduce the objective only slightly.
  constexpr double afterSweeps = 0.1;
  MinimizeOptions options;
  options.method = method;
  options.maximumIterations = stop.maximumIterations;
  options.gradientNorm = stop.gradientNorm;
  options.relativeChange = alone ? stop.relativeChange : afterSweeps * stop.relativeChange;
  options.decrement = stop.relativeChange;
  if (method == Optimizer::NewtonConjugateGradient)
  {
    constexpr double worthIterations = 0.05;
    options.leastGain = alone ? 0.0 : worthIterations; // sweeps may achieve more
    // Only its steps indicate the distance to the minimum.
    options.relativeChange = options.gradientNorm = 0;
  }
  return options;
}

/**
 * @brief Whether the sweeps have converged, and the reason. A small gradient, compared with a start
 * with nearly flat elements, is not conclusive if much can still be gained.
 * @param all whether the sweep visited every vertex
 * @param remaining the expected gain of further sweeps, for relativeChange
 * @param possible their possible gain
 * @param size of the objective
 */
inline bool converged(const StoppingCriteria& stop, const SweepResult& sweep, bool all,
  double firstGradient, double lowered, double remaining, double possible, double size,
  StopReason& reason)
{
  constexpr double little = 1e-3; // of the objective
  const bool near = stop.relativeChange == 0 || possible <= little * size;
  if (all && near && sweep.gradientNorm <= stop.gradientNorm * firstGradient)
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
