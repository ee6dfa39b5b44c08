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
  double enough = 2.0; ///< stop as soon as the worst corner is this good; above 1: never
  int threads = 0;     ///< the result does not depend on it
  /// Whether points, 3 coordinates each, are acceptable; called when the worst corner has improved.
  std::function<bool(const std::vector<double>& points)> accept;
  /// Called after each round; return false to stop.
  std::function<bool()> proceed;
};

/**
 * @brief Improves the worst corner of a valid planar or volume mesh, see MovingBarrier. Elements
 * stay valid everywhere, and facets stay as close to the surface as in `mesh`, plus the tolerance.
 * @param mesh with the points for reference distances
 * @param from the initial points, 3 coordinates each
 * @return the resulting points, or the initial points if there is no improvement
 */
TAUTLINE_KERNEL_EXPORT std::vector<double> improveSliding(const Mesh& mesh,
  const BoundaryConstraints& constraints, const std::vector<double>& from,
  const SlidingImprovement& options);
}
#endif
