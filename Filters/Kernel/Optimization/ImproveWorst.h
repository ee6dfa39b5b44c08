// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImproveWorst.h
 * @brief Improves the worst element at little cost to the mean.
 * Internal: not installed.
 */
#ifndef tautline_ImproveWorst_h
#define tautline_ImproveWorst_h

#include "QualityGuard.h"

#include <functional>

#include <optional>

namespace tautline
{
/// The limits of the improvement.
struct WorstLimits
{
  /// How much the mean of the metric of the first objective may get worse, as a fraction.
  double allowance = 0.0;
  /// Stop as soon as no element is worse than the worst one of the input.
  bool onlyAsInput = false;
  /// The reference mean of the allowance; not set: the mean at the start.
  std::optional<double> mean = std::nullopt;
};

/**
 * @brief Sweeps with sum q^2 + K sum (q / q_w)^p, with large p and the worst value q_w so far: the
 * second sum only affects elements near the worst. Stops when the worst value no longer improves,
 * or when the mean has worsened by the allowance, which is ignored as long as the worst element is
 * worse than in the input. The metric of the worst element is worstMetric(); meshes of cells with
 * several corners, and metrics other than the inverse mean ratio, use its p-mean instead of the
 * second sum.
 * @param report called after each round that improved the mesh; returns false to stop
 * @return whether the time limit ended it
 */
TAUTLINE_KERNEL_EXPORT bool improveWorst(OptimizationProblem& problem, const QualityGuard& guard,
  const WorstLimits& limits, const std::function<bool(const IterationRecord&)>& report);
}
#endif
