// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetBound.h
 * @brief The bound given by a fixed facet: the best quality of a tetrahedron on it.
 * Internal: not installed.
 */
#ifndef tautline_FacetBound_h
#define tautline_FacetBound_h

#include "StarSmoothing.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief The largest (mean ratio)^(3/2) of a tetrahedron on a triangle: its fourth point is over
 * the centroid, at the height sqrt(2/9 S) of the sum S of the squared edges.
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT double facetMeanRatio(
  const Vec3& a, const Vec3& b, const Vec3& c);

/**
 * @brief The largest quality of a tetrahedron on a triangle, over all positions of the fourth
 * point, to about a thousandth. With the mean ratio alone it is facetMeanRatio().
 * @param smoothing workspace
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT double facetQuality(const Vec3& a, const Vec3& b, const Vec3& c,
  const QualityWeights& weights, StarSmoothing& smoothing);
}
#endif
