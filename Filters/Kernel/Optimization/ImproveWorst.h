/**
 * @file ImproveWorst.h
 * @brief Reduces the largest inverse mean ratio at little cost to the mean. Internal: not
 * installed.
 */
#ifndef tautline_ImproveWorst_h
#define tautline_ImproveWorst_h

#include "OptimizationProblem.h"

namespace tautline
{
/**
 * @brief Sweeps with sum q^2 + K sum (q / q_w)^p, p large and q_w the worst value so far: only
 * elements near the worst feel the second sum. Stops when the worst value no longer falls, or the
 * mean has risen by `allowance` of itself. The first objective's metric is q; meshes of cells with
 * several corners and other metrics take the p-mean in place of the second sum.
 * @param report called after each round that improved the mesh; returns false to stop
 */
void improveWorst(OptimizationProblem& problem, double allowance,
  const std::function<bool(const IterationRecord&)>& report);
}
#endif
