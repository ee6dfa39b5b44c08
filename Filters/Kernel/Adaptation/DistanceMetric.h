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
 * @brief Per point: the straight-line distance from the walls, which are the boundary facets (on
 * surfaces: the border edges) with all points marked.
 * @param marks one flag per point of the mesh; empty: the whole boundary
 *
 * Throws Error if there is no such facet.
 */
TAUTLINE_KERNEL_EXPORT std::vector<double> wallDistances(
  const AdaptationMesh& mesh, const std::vector<unsigned char>& marks);

struct LayerSizes
{
  double first = 1.0;  ///< size at the wall, along the gradient of the distance; above 0
  double growth = 1.2; ///< thickness ratio of consecutive layers; at least 1
  double ratio = 1.0;  ///< of the tangential size at the wall to the first size; at least 1
};

/**
 * @brief The metrics of boundary layers. At a distance s, the size is h(s) = first + (growth - 1) s
 * along the gradient of the distance, so that layers grow by this factor, and max(ratio first,
 * h(s)) across it. Where the distance has no clear gradient, as between two walls, the size is h(s)
 * in all directions.
 * @param distances per point of the mesh; the sign is ignored
 */
TAUTLINE_KERNEL_EXPORT std::vector<MetricTensor> distanceMetrics(
  const AdaptationMesh& mesh, const std::vector<double>& distances, const LayerSizes& sizes);
}
#endif
