// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricEllipsoids.h
 * @brief Metric tensors as ellipsoids, to be drawn: the ends of all edges of length 1, scaled.
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
  /// Per ellipsoid the geometric mean of the sizes, and the quotient of the largest and smallest.
  std::vector<double> sizes, ratios;

  std::size_t pointsOfEach() const
  {
    return this->centers.empty() ? 0 : this->points.size() / 3 / this->centers.size();
  }
};

/**
 * @brief Some of the points, evenly spread: one of each cell of a grid, which is made as fine as
 * their number allows; all if they are few enough.
 * @param places of all points, 3 numbers each
 * @param candidates of each cell the first one counts
 * @param most how many are chosen at most, at least 0
 */
TAUTLINE_KERNEL_EXPORT std::vector<Index> spreadPoints(
  const double* places, const std::vector<Index>& candidates, Index most);

/**
 * @brief Adds an ellipsoid at a point whose semi-axes are the sizes times `scale`.
 * @param point its number
 * @param normal of a planar mesh or surface, or null: along it the ellipsoid is a tenth as thick as
 * the smallest size
 */
TAUTLINE_KERNEL_EXPORT void addEllipsoid(Index point, const Vec3& center,
  const MetricTensor& metric, const Vec3* normal, double scale, MetricEllipsoids& ellipsoids);
}
#endif
