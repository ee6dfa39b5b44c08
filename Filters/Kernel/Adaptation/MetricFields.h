// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricFields.h
 * @brief Metrics at the points of a mesh: complexity, extremes, limits, gradation.
 *
 * In planar meshes and on surfaces, the metrics are flattened(): along the normal they have the
 * larger of the two sizes in the plane.
 */
#ifndef tautline_MetricFields_h
#define tautline_MetricFields_h

#include "AdaptationMesh.h"

namespace tautline
{
/// The determinant of a metric from its eigenvalues in increasing order. For a flattened metric,
/// the in-plane determinant: along the normal, the smallest eigenvalue is repeated.
inline double metricDeterminant(const std::array<double, 3>& values, int dimension)
{
  return dimension == 3 ? values[0] * values[1] * values[2] : values[0] * values[2];
}

/**
 * @brief The area or volume of the mesh in the metrics: the integral of the square root of their
 * determinant, which is interpolated linearly in each element.
 */
TAUTLINE_KERNEL_EXPORT double complexity(
  const AdaptationMesh& mesh, const std::vector<MetricTensor>& metrics);

/**
 * @brief The number of elements of a mesh with edges of unit length: the same integral over the
 * area or volume of the ideal element (AdaptationMesh::idealVolumes()). This is the complexity
 * times 4 / sqrt(3) = 2.31 for triangles, 6 sqrt(2) = 8.49 for tetrahedra, 1 for quadrilaterals and
 * hexahedra. Tetrahedral meshes have about 10 % more elements because regular tetrahedra do not
 * fill space.
 */
TAUTLINE_KERNEL_EXPORT double expectedElements(
  const AdaptationMesh& mesh, const std::vector<MetricTensor>& metrics);

/// The extremes of the sizes at all points.
struct MetricExtremes
{
  double smallest = 0.0, largest = 0.0; ///< sizes
  double ratio = 1.0;                   ///< the largest ratio of two sizes at a point
};
TAUTLINE_KERNEL_EXPORT MetricExtremes extremesOf(
  const AdaptationMesh& mesh, const std::vector<MetricTensor>& metrics);

/// Changes the metrics to limited() ones; flattens them in planar meshes and on surfaces.
TAUTLINE_KERNEL_EXPORT void limitMetrics(
  const AdaptationMesh& mesh, const MetricLimits& limits, std::vector<MetricTensor>& metrics);

/// Changes metrics to their intersection() with others.
TAUTLINE_KERNEL_EXPORT void intersectMetrics(const AdaptationMesh& mesh,
  const std::vector<MetricTensor>& others, std::vector<MetricTensor>& metrics);

struct GradationResult
{
  int rounds = 0;       ///< in which metrics changed
  bool complete = true; ///< false: they still change after MaximumGradationRounds
};
constexpr int MaximumGradationRounds = 2000;

/**
 * @brief Reduces sizes until neighbors differ at most by the growth of grownMetric(), to a
 * tolerance of 1e-7: the metric at each point is the intersection() with the grown metrics of its
 * neighbors. Isotropic sizes then grow at most by log(growth) times the distance.
 *
 * No size grows, except by rounding, and none falls below 0.9 times the smallest one given:
 * intersections of metrics with different axes would reduce it further from round to round. The
 * result depends neither on the number of threads nor on the order of the points; a second call
 * changes nothing.
 * @param metrics with size ratios of at most 1e4, so that rounding is below the tolerance
 * @param growth the largest growth factor, above 1; otherwise throws Error
 */
TAUTLINE_KERNEL_EXPORT GradationResult gradeMetrics(
  const AdaptationMesh& mesh, double growth, std::vector<MetricTensor>& metrics);
}
#endif
