// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImproveSliding.h
 * @brief Improves the worst corner of a mesh whose boundary points slide.
 * Internal: not installed.
 */
#ifndef tautline_ImproveSliding_h
#define tautline_ImproveSliding_h

#include "ConstrainedPoints.h"
#include "CornerShape.h"

#include <functional>

namespace tautline
{
struct SlidingImprovement
{
  CornerMeasure measure = CornerMeasure::ScaledJacobian;
  double enough = 2.0; ///< stop as soon as the worst corner is as good; above 1: never
  int threads = 0;     ///< the result does not depend on it
  /// Whether points, 3 coordinates each, are acceptable; called where the worst corner has risen.
  std::function<bool(const std::vector<double>& points)> accept;
  /// Called after each round; return false to stop.
  std::function<bool()> proceed;
};

/**
 * @brief Raises the worst corner of a planar or volume mesh, see MovingBarrier, whose elements are
 * valid. Elements stay valid everywhere, and the facets as near to the surface as `mesh` has them,
 * plus the tolerance.
 * @param mesh with the points that the distances are compared with
 * @param from the points of the start, 3 coordinates each
 * @return the points; where there is no better place, those of the start
 */
TAUTLINE_KERNEL_EXPORT std::vector<double> improveSliding(const Mesh& mesh,
  const BoundaryConstraints& constraints, const std::vector<double>& from,
  const SlidingImprovement& options);
}
#endif
