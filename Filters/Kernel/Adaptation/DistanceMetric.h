// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DistanceMetric.h
 * @brief Sizes that grow with the distance from a wall, as in boundary layers.
 */
#ifndef tautline_DistanceMetric_h
#define tautline_DistanceMetric_h

#include "AdaptationMesh.h"

namespace tautline
{
/**
 * @brief Per point, the distance along a straight line from the walls: facets of the boundary (of
 * surfaces edges of the border) of which all points are marked.
 * @param marks one flag per point of the mesh; empty: the whole boundary
 *
 * Throws Error if there is no such facet.
 */
TAUTLINE_KERNEL_EXPORT std::vector<double> wallDistances(
  const AdaptationMesh& mesh, const std::vector<unsigned char>& marks);

struct LayerSizes
{
  double first = 1.0;  ///< size at the wall, along the gradient of the distance; above 0
  double growth = 1.2; ///< of each layer against the one before; at least 1
  double ratio = 1.0;  ///< of the tangential size at the wall to the first one; at least 1
};

/**
 * @brief The metrics of layers: at a distance s the size is h(s) = first + (growth - 1) s along the
 * gradient of the distance, which makes layers grow by this factor, and across it
 * max(ratio first, h(s)). Where the distance has no clear gradient, as between two walls, h(s) in
 * all directions.
 * @param distances per point of the mesh; the sign does not count
 */
TAUTLINE_KERNEL_EXPORT std::vector<MetricTensor> distanceMetrics(
  const AdaptationMesh& mesh, const std::vector<double>& distances, const LayerSizes& sizes);
}
#endif
