// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LeaveSurface.h
 * @brief Improves the worst elements by points that leave the surface.
 * Internal: not installed.
 */
#ifndef tautline_LeaveSurface_h
#define tautline_LeaveSurface_h

#include "ImproveWorst.h"

namespace tautline
{
/// What leaveSurface() did.
struct LeavingResult
{
  std::vector<Index> points;     ///< that may have left
  std::vector<double> onSurface; ///< 3 each: where these were on the surface last
  bool stopped = false;          ///< on request
  bool outOfTime = false;

  /// How many of them are elsewhere.
  Index count(const std::vector<double>& coordinates) const;
};

/**
 * @brief Where corners, curves and bends of the surface bound the worst elements, lets the points
 * near these leave it, within OptimizeOptions::surfaceTolerance: those of OptimizeOptions::leaving.
 * Goes on with the elements that are the worst then, until the worst value no longer improves.
 * Points that are far from the worst elements do not move. Each round prepares the mesh anew.
 * @param mesh where the points were at first, which has the surface
 * @param problem starts where it is, and ends at the points reached
 * @param limits of the whole run; the mean must be set
 * @param report called after each round that improved the mesh, with the problem at that time;
 * returns false to stop
 */
TAUTLINE_KERNEL_EXPORT LeavingResult leaveSurface(const Mesh& mesh, OptimizationProblem& problem,
  const QualityGuard& guard, const WorstLimits& limits, const Stopwatch& clock,
  const std::function<bool(OptimizationProblem&, const IterationRecord&)>& report);
}
#endif
