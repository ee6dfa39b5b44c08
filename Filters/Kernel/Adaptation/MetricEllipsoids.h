// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricEllipsoids.h
 * @brief Metric tensors as ellipsoids for display: the ends of all edges of unit length, scaled.
 */
#ifndef tautline_MetricEllipsoids_h
#define tautline_MetricEllipsoids_h

#include "MetricTensor.h"

namespace tautline
{
/// Ellipsoids of triangles, all with the same number of points and triangles.
struct MetricEllipsoids
{
  std::vector<double> points;   ///< 3 each
  std::vector<Index> triangles; ///< 3 points each
  std::vector<Index> centers;   ///< per ellipsoid the point of the mesh
  /// Per ellipsoid: the geometric mean of the sizes, and the ratio of the largest to the smallest.
  std::vector<double> sizes, ratios;

  std::size_t pointsOfEach() const
  {
    return this->centers.empty() ? 0 : this->points.size() / 3 / this->centers.size();
  }
};

/**
 * @brief Selects evenly spread points: one per cell of a grid that is as fine as the maximum number
 * allows; all points if they are few enough.
 * @param places of all points, 3 numbers each
 * @param candidates the first one in each cell is chosen
 * @param most the maximum number chosen, at least 0
 */
TAUTLINE_KERNEL_EXPORT std::vector<Index> spreadPoints(
  const double* places, const std::vector<Index>& candidates, Index most);

/**
 * @brief Adds an ellipsoid at a point, with the sizes times `scale` as semi-axes.
 * @param point its number
 * @param normal of a planar mesh or surface, or null; the thickness along it is a tenth of the
 * smallest size
 */
TAUTLINE_KERNEL_EXPORT void addEllipsoid(Index point, const Vec3& center,
  const MetricTensor& metric, const Vec3* normal, double scale, MetricEllipsoids& ellipsoids);
}
#endif
