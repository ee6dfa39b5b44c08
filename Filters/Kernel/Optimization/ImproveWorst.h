// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImproveWorst.h
 * @brief Improves the worst element at little cost to the mean. Internal: not installed.
 */
#ifndef tautline_ImproveWorst_h
#define tautline_ImproveWorst_h

#include "QualityGuard.h"

#include <functional>

#include <optional>

namespace tautline
{
/// How far to go.
struct WorstLimits
{
  /// How much the mean of the first objective's metric may get worse, as a fraction of it.
  double allowance = 0.0;
  /// Stop as soon as no element is worse than the worst one of the input.
  bool onlyAsInput = false;
  /// The mean that the allowance counts from; not set: that at the start.
  std::optional<double> mean = std::nullopt;
};

/// Sweeps of a round, and, in closed form, the fraction of the worst value above which elements are
/// where the first begins: the others have a share below 1e-5.
constexpr int sweepsPerRound = 4;
constexpr double nearWorst = 0.7;

/**
 * @class tautline::WorstSteps
 * @brief What the rules of improveWorst() need of an optimization. On ranks all methods are
 * collective and return the same everywhere.
 */
class WorstSteps
{
public:
  virtual ~WorstSteps() = default;
  virtual bool outOfTime() const = 0;
  /// Of the points as they are.
  virtual IterationRecord record() = 0;
  /// The worst value of the metric that judges, among the elements with a free point; infinite
  /// without any.
  virtual double worst() = 0;
  /// The same after sweep().
  virtual double reached() = 0;
  /// Whether the last sweep() had both sums in one closed form, without a pull.
  virtual bool isFast() = 0;
  /**
   * @brief A few sweeps, and stores the points.
   * @param worst the worst value so far
   * @param power of the second sum
   * @param pull how much more that counts than the first
   * @return false without a sweep if one of the sums is 0 already
   */
  virtual bool sweep(double worst, double power, double pull) = 0;
  /// Keeps the points as they are; and goes back to those kept last, or to those of the start.
  virtual void keep() = 0;
  virtual void goBack() = 0;
};

/// An objective with the metric that judges the worst element, without targets if it is another.
Objective judgedAs(Objective objective, Metric metric, int threads);
/// The options of the sweeps.
LocalOptions worstOptions(const OptimizationProblem& problem);
/// The sums by the changes relative to where they start. @param first their values there; empty:
/// one closed form
Scalarizer worstScalarizer(
  const std::vector<double>& first, double pull, const std::vector<double>& now);

/**
 * @brief The rules of improveWorst() below, for steps of any kind.
 * @param judged, ofMean the metrics of the worst element and of the first objective
 * @param isWorse whether a value is worse than the worst one of the input
 */
bool improveWorst(WorstSteps& steps, Metric judged, Metric ofMean,
  const std::function<bool(double)>& isWorse, const WorstLimits& limits,
  const std::function<bool(const IterationRecord&)>& report);

/**
 * @brief Sweeps with sum q^2 + K sum (q / q_w)^p, p large and q_w the worst value so far: only
 * elements near the worst feel the second sum. Stops when the worst value no longer improves, or
 * the mean has got worse by the allowance, which does not count as long as the worst element is
 * worse than that of the input. The metric of the worst element is worstMetric(); meshes of cells
 * with several corners, and other metrics than the inverse mean ratio, take its p-mean in place of
 * the second sum.
 * @param report called after each round that improved the mesh; returns false to stop
 * @return whether the time limit ended it
 */
TAUTLINE_KERNEL_EXPORT bool improveWorst(OptimizationProblem& problem, const QualityGuard& guard,
  const WorstLimits& limits, const std::function<bool(const IterationRecord&)>& report);
}
#endif
