// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LeaveSurface.h
 * @brief Improves the worst elements by letting points leave the surface.
 * Internal: not installed.
 */
#ifndef tautline_LeaveSurface_h
#define tautline_LeaveSurface_h

#include "ImproveWorst.h"

namespace tautline
{
/// The result of leaveSurface().
struct LeavingResult
{
  std::vector<Index> points;     ///< that may have left the surface
  std::vector<double> onSurface; ///< 3 each: their last positions on the surface
  bool stopped = false;          ///< on request
  bool outOfTime = false;

  /// The number of these points that have moved off the surface.
  Index count(const std::vector<double>& coordinates) const;
};

/**
 * @brief If corners, curves and bends of the surface limit the worst elements, lets the nearby
 * points of OptimizeOptions::leaving leave the surface within OptimizeOptions::surfaceTolerance.
 * Continues with the next worst elements until the worst value no longer improves. Points far from
 * the worst elements do not move. Each round prepares the mesh again.
 * @param mesh the initial mesh, which defines the surface
 * @param problem starts at its current points, and ends at the final points
 * @param limits of the whole run; the mean must be set
 * @param report called after each round that improved the mesh, with the problem at that time;
 * returns false to stop
 */
TAUTLINE_KERNEL_EXPORT LeavingResult leaveSurface(const Mesh& mesh, OptimizationProblem& problem,
  const QualityGuard& guard, const WorstLimits& limits, const Stopwatch& clock,
  const std::function<bool(OptimizationProblem&, const IterationRecord&)>& report);
}
#endif
