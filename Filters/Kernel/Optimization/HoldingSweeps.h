// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HoldingSweeps.h
 * @brief Sweeps that hold the worst element.
 * Internal: not installed.
 */
#ifndef tautline_HoldingSweeps_h
#define tautline_HoldingSweeps_h

#include "QualityGuard.h"
#include "SweepControl.h"

#include <functional>

namespace tautline
{
/**
 * @brief Sweeps until convergence, from points that the guard accepts. After each sweep, the points
 * of elements that it has made invalid, or worse than all elements of the input, are moved back. If
 * that increases the objective or moves the surface too far, all points are moved back, and these
 * points are fixed in later sweeps.
 * @param report adds a record to the history; false if that stops the run
 * @param history with the record of these points at its end
 */
StopReason sweepHoldingWorst(OptimizationProblem& problem, const QualityGuard& guard,
  const StoppingTest& watch, const std::function<bool(const IterationRecord&)>& report,
  const std::vector<IterationRecord>& history);
}
#endif
