// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LeaveSurface.h
 * @brief Improves the worst elements by points that leave the surface. Internal: not installed.
 */
#ifndef tautline_LeaveSurface_h
#define tautline_LeaveSurface_h

#include "ImproveWorst.h"

namespace tautline
{
/**
 * @brief Where corners, curves and bends of the surface bound the worst elements, lets the points
 * near these leave it, within OptimizeOptions::surfaceTolerance: those of OptimizeOptions::leaving.
 * Goes on with the elements that are the worst then, until the worst value no longer improves.
 * Points that are far from the worst elements do not move.
 * @param mesh where the points were at first, which has the surface
 * @param problem starts there, and ends at the points reached
 * @param allowance see WorstLimits
 * @param report called after each round that improved the mesh, with the problem at that time;
 * returns false to stop
 * @return the number of points that left
 */
TAUTLINE_KERNEL_EXPORT Index leaveSurface(const Mesh& mesh, OptimizationProblem& problem,
  const QualityGuard& guard, double allowance, const Stopwatch& clock,
  const std::function<bool(OptimizationProblem&, const IterationRecord&)>& report);
}
#endif
