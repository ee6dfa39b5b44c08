// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlideWorst.h
 * @brief Improves the worst element by all points together, with those of the boundary.
 * Internal: not installed.
 */
#ifndef tautline_SlideWorst_h
#define tautline_SlideWorst_h

#include "ImproveWorst.h"

namespace tautline
{
/**
 * @brief Whether slideWorst() has a measure for what judges the worst element, and can keep the
 * constraints of the points: of planar and volume meshes of one process, by the scaled Jacobian or
 * the inverse mean ratio without targets, without limits of the distance of points.
 */
bool canSlideWorst(const OptimizationProblem& problem, const Objective& judged);

/**
 * @brief Raises the worst corner by a barrier, see improveSliding(). The mean counts as in
 * improveWorst().
 * @param mesh where the points were at first, which has the surface
 * @param report called after each round that improved the mesh; returns false to stop
 * @return whether the time limit ended it
 */
bool slideWorst(const Mesh& mesh, OptimizationProblem& problem, const QualityGuard& guard,
  const WorstLimits& limits, const std::function<bool(const IterationRecord&)>& report);
}
#endif
