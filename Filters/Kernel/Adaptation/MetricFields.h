// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricFields.h
 * @brief Metrics at the points of a mesh: complexity, extremes, limits, gradation.
 *
 * In planar meshes and on surfaces the metrics are flattened(): along the normal they have the
 * larger of the two sizes in the plane.
 */
#ifndef tautline_MetricFields_h
#define tautline_MetricFields_h

#include "AdaptationMesh.h"

namespace tautline
{
/// The determinant of a metric, of a flattened one in its plane, by its eigenvalues in increasing
/// order: along the normal it has the smallest one a second time.
inline double metricDeterminant(const std::array<double, 3>& values, int dimension)
{
  return dimension == 3 ? values[0] * values[1] * values[2] : values[0] * values[2];
}

/**
 * @brief The area or volume of the mesh as the metrics measure it: the integral of the root of
 * their determinant, which is linear in each element.
 */
TAUTLINE_KERNEL_EXPORT double complexity(
  const AdaptationMesh& mesh, const std::vector<MetricTensor>& metrics);

/**
 * @brief How many elements a mesh has whose edges have length 1: the same integral over the area or
 * volume of the ideal element (AdaptationMesh::idealVolumes()). So it is the complexity times
 * 4 / sqrt(3) = 2.31 for triangles, 6 sqrt(2) = 8.49 for tetrahedra, 1 for quadrilaterals and
 * hexahedra. Meshes of tetrahedra have about a tenth more, as regular ones do not fill space.
 */
TAUTLINE_KERNEL_EXPORT double expectedElements(
  const AdaptationMesh& mesh, const std::vector<MetricTensor>& metrics);

/// The extremes of the sizes at all points.
struct MetricExtremes
{
  double smallest = 0.0, largest = 0.0; ///< sizes
  double ratio = 1.0;                   ///< the largest quotient of two sizes at a point
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
 * @brief Reduces sizes until neighbors differ at most by the growth of grownMetric(), to
 * 1e-7: at each point the metric is the intersection() with what its neighbors have grown
 * to. Isotropic sizes then grow at most by log(growth) times the distance.
 *
 * No size grows, except by rounding, and none falls below 0.9 times the smallest one given:
 * intersections of metrics with different axes would reduce it further from round to round. The
 * result depends neither on the threads nor on the order of the points; a second call changes
 * nothing.
 * @param metrics with ratios of sizes of at most 1e4: rounding is then below the tolerance
 * @param growth the largest growth factor, above 1. Throws Error for others.
 */
TAUTLINE_KERNEL_EXPORT GradationResult gradeMetrics(
  const AdaptationMesh& mesh, double growth, std::vector<MetricTensor>& metrics);
}
#endif
