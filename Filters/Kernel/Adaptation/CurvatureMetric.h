// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvatureMetric.h
 * @brief Sizes by the curvature of a surface, so that edges stay close to it.
 */
#ifndef tautline_CurvatureMetric_h
#define tautline_CurvatureMetric_h

#include "AdaptationMesh.h"

namespace tautline
{
/**
 * @brief At points of a surface, of the boundary of a volume, or of the border of a planar mesh,
 * the size along each principal direction of curvature with radius R is sqrt(8 chordError R): the
 * middle of an edge is then chordError away from the circle through its ends. Elsewhere, and in
 * other directions, it is the largest size.
 *
 * The curvature of a surface comes from a quadric fitted to rings of neighbors over their tangent
 * plane. Where facets meet at more than featureAngle degrees, the neighbors on each side of the
 * sharp edge are fitted separately, and the metric is the intersection() of the two metrics. On the
 * border of a planar mesh it comes from the circle through a point and its two neighbors; corners,
 * which bend by more than the angle, have no curvature.
 * @param chordError above 0
 * @param featureAngle 0 to 180
 * @param largest size, above 0
 */
TAUTLINE_KERNEL_EXPORT std::vector<MetricTensor> curvatureMetrics(
  const AdaptationMesh& mesh, double chordError, double featureAngle, double largest);
}
#endif
