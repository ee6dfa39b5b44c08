// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlideWorst.h
 * @brief Improves the worst element by moving all points together, including the boundary.
 * Internal: not installed.
 */
#ifndef tautline_SlideWorst_h
#define tautline_SlideWorst_h

#include "ImproveWorst.h"

namespace tautline
{
/**
 * @brief Whether slideWorst() supports the metric of the worst element and the constraints of the
 * points: for planar and volume meshes on one process, with the scaled Jacobian or the inverse mean
 * ratio without targets, and without limits on point distances.
 */
bool canSlideWorst(const OptimizationProblem& problem, const Objective& judged);

/**
 * @brief Improves the worst corner with a barrier, see improveSliding(). The mean is treated as in
 * improveWorst().
 * @param mesh the initial mesh, which defines the surface
 * @param report called after each round that improved the mesh; returns false to stop
 * @return whether the time limit ended it
 */
bool slideWorst(const Mesh& mesh, OptimizationProblem& problem, const QualityGuard& guard,
  const WorstLimits& limits, const std::function<bool(const IterationRecord&)>& report);
}
#endif
