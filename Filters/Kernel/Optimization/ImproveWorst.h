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
