// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MakeMetric.h
 * @brief The metric tensors of a mesh from one source, limited and graded; the algorithm of the
 * Metric Tensor filter.
 *
 * Example: a metric for about 5000 triangles that minimizes the interpolation error of a field.
 *
 *     tautline::MetricOptions options;
 *     options.source = tautline::MetricSource::Hessian;
 *     options.field = u.data();        // one value per point
 *     options.targetValue = 5000;
 *     options.limits = { 1e-4, 1.0, 1000 };
 *     options.gradation = 1.5;
 *     const tautline::MetricResult metric = tautline::makeMetric(mesh, options);
 *     // metric.tensors has 6 numbers per point, xx yy zz xy yz xz
 */
#ifndef tautline_MakeMetric_h
#define tautline_MakeMetric_h

#include "DistanceMetric.h"
#include "FieldDerivatives.h"
#include "MetricFields.h"

#include <string>

namespace tautline
{
enum class MetricSource
{
  Sizes,     ///< given sizes or metrics
  Hessian,   ///< minimizes the interpolation error of a field, see LpMetric
  Curvature, ///< of the surface, see curvatureMetrics()
  Distance   ///< from a wall, see distanceMetrics()
};

/// The criterion that sets the sizes of MetricSource::Hessian.
enum class MetricTarget
{
  Elements,   ///< expectedElements()
  Complexity, ///< complexity()
  Error       ///< of the interpolation, see LpMetric::factorForError()
};

/// Sizes per point: one number, or six numbers of a metric tensor.
struct PointSizes
{
  const double* values = nullptr;
  int components = 1;
};

/// Arrays have a row per point of the mesh and outlive the call.
struct MetricOptions
{
  MetricSource source = MetricSource::Curvature;
  PointSizes sizes; ///< MetricSource::Sizes

  const double* field = nullptr; ///< MetricSource::Hessian, `fieldComponents` per point
  int fieldComponents = 1;
  /// relative precision of its values
  double fieldPrecision = std::numeric_limits<double>::epsilon();
  HessianRecovery recovery = HessianRecovery::QuadraticFit;
  double norm = 2.0; ///< p, at least 1; infinity: the largest error
  MetricTarget target = MetricTarget::Elements;
  double targetValue = 10000.0; ///< above 0; for the final metric, unless it is an error

  double chordError = 1.0;    ///< MetricSource::Curvature, above 0
  double featureAngle = 40.0; ///< degrees, 0 to 180

  const double* distances = nullptr;    ///< MetricSource::Distance; null: from the walls
  const unsigned char* walls = nullptr; ///< marks of points; null: the whole boundary
  LayerSizes layers;

  PointSizes others; ///< the metric is intersected with these; without values: none
  /// Smallest size at least 0, largest finite, ratio of 1 to MaximumSizeRatio.
  MetricLimits limits;
  double gradation = 0.0; ///< growth factor above 1; 0: none

  /// One per point: the first of the points merged with it; empty: no merged points.
  std::vector<Index> representative;
  const unsigned char* skip = nullptr; ///< per cell: excluded from volumes, for example a ghost
  int threads = 0;
};

/// Larger ratios are lost to rounding in a tensor.
constexpr double MaximumSizeRatio = 1e4;

struct MetricResult
{
  std::vector<double> tensors; ///< 6 per point; the largest size at points without an element
  /// Per point of the mesh: the unit normal of a planar mesh or surface; empty for a volume.
  std::vector<Vec3> normals;
  /// The points of elements in the order of their coordinates; the first of merged points.
  std::vector<Index> points;
  double complexity = 0.0, elements = 0.0; ///< see complexity() and expectedElements()
  MetricExtremes extremes;
  GradationResult gradation;
  std::string note; ///< sentences about targets that were not reached, or ""
};

/**
 * @brief Computes the metrics from the source, intersects them with the others, limits and grades
 * them, and limits the smallest size and the ratio again.
 *
 * With a target number of elements or a target complexity, the factor of the Hessian is corrected
 * until the final metric reaches it to 1 %, where the limits and the gradation allow it. Throws
 * Error for options out of range, array values that are not finite or not positive, and meshes
 * without elements.
 */
TAUTLINE_KERNEL_EXPORT MetricResult makeMetric(const Mesh& mesh, const MetricOptions& options);
}
#endif
