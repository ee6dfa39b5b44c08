// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricTensor.h
 * @brief Algebra of metric tensors, which define the target edge lengths at a point.
 *
 * A metric tensor M is symmetric and positive definite. The length of an edge e in it is
 * sqrt(e . M e). Along a principal axis with eigenvalue v, edges of size 1 / sqrt(v) have length 1;
 * all edges of length 1 end on an ellipsoid.
 *
 *     const MetricTensor fine = isotropicMetric(0.1); // edges of length 0.1 have length 1
 *     const MetricTensor both = intersection(fine, other);
 *
 * The functions require finite, positive definite tensors (isPositiveDefinite()) unless stated
 * otherwise, and do not check this.
 */
#ifndef tautline_MetricTensor_h
#define tautline_MetricTensor_h

#include "tautline/Core/Types.h"

#include <limits>
#include <vector>

namespace tautline
{
/// xx yy zz xy yz xz of a symmetric tensor, in VTK's order.
using MetricTensor = std::array<double, 6>;

/// The eigenvalues of a symmetric tensor, in increasing order, and its principal axes, orthonormal.
struct MetricAxes
{
  std::array<double, 3> values;
  std::array<Vec3, 3> axes;
};

/// The allowed sizes.
struct MetricLimits
{
  double smallest = 0.0;                                    ///< size, at least 0
  double largest = std::numeric_limits<double>::infinity(); ///< size, at least the smallest
  /// The largest ratio of two sizes at a point, at least 1.
  double ratio = std::numeric_limits<double>::infinity();
};

/// The squared length of an edge; for any symmetric tensor, e . m e.
inline double squaredLength(const Vec3& e, const MetricTensor& m)
{
  return m[0] * e[0] * e[0] + m[1] * e[1] * e[1] + m[2] * e[2] * e[2] +
    2.0 * (m[3] * e[0] * e[1] + m[4] * e[1] * e[2] + m[5] * e[0] * e[2]);
}

/// The square of the length of an edge in the mean of two metrics.
inline double squaredLength(const Vec3& e, const MetricTensor& a, const MetricTensor& b)
{
  const auto m = [&](int k) { return 0.5 * (a[k] + b[k]); };
  return squaredLength(e, { m(0), m(1), m(2), m(3), m(4), m(5) });
}

/// The length of an edge whose size varies geometrically from one metric to
/// another: the logarithmic mean of the lengths in both.
TAUTLINE_KERNEL_EXPORT double edgeLength(
  const Vec3& e, const MetricTensor& a, const MetricTensor& b);

/// The metric in which all edges of the given length, above 0, have length 1.
inline MetricTensor isotropicMetric(double length)
{
  const double m = 1.0 / (length * length);
  return { m, m, m, 0.0, 0.0, 0.0 };
}

/// Whether a tensor is finite and positive definite.
TAUTLINE_KERNEL_EXPORT bool isPositiveDefinite(const MetricTensor& m);

/// The eigenvalues and axes of any symmetric tensor.
TAUTLINE_KERNEL_EXPORT MetricAxes principalAxes(const MetricTensor& m);

/// The tensor with these eigenvalues and axes.
TAUTLINE_KERNEL_EXPORT MetricTensor tensorOf(const MetricAxes& axes);

/// A symmetric tensor expressed in the coordinates x . axes[i].
TAUTLINE_KERNEL_EXPORT MetricTensor turned(const MetricTensor& m, const std::array<Vec3, 3>& axes);

/// The symmetric tensor with f of the eigenvalues: its logarithm, its absolute value, ...
template <class Function>
MetricTensor functionOf(const MetricTensor& m, const Function& f)
{
  MetricAxes axes = principalAxes(m);
  for (double& value : axes.values)
  {
    value = f(value);
  }
  return tensorOf(axes);
}

/**
 * @brief The metric in which no edge is shorter than in either of the two: both are diagonalized
 * simultaneously, and the larger entries are taken.
 *
 * It is `a` itself if no edge is longer in b, and b if none is in a.
 * @param tolerance relative to the entries of b: smaller differences are treated as equal
 */
TAUTLINE_KERNEL_EXPORT MetricTensor intersection(
  const MetricTensor& a, const MetricTensor& b, double tolerance = 1e-9);

/**
 * @brief The log-Euclidean mean: exp of the weighted mean of the logarithms (Arsigny et al. 2006).
 * @param weights one per metric, at least 0, with a sum above 0
 */
TAUTLINE_KERNEL_EXPORT MetricTensor logEuclideanMean(
  const std::vector<MetricTensor>& metrics, const std::vector<double>& weights);

/// The eigenvalues, in increasing order, limited: first by the sizes, then by their ratio, which
/// reduces the largest sizes.
TAUTLINE_KERNEL_EXPORT std::array<double, 3> limitedValues(
  std::array<double, 3> values, const MetricLimits& limits);

/// A metric, or a tensor without negative eigenvalues, with its sizes within limits.
TAUTLINE_KERNEL_EXPORT MetricTensor limited(const MetricTensor& m, const MetricLimits& limits);

/**
 * @brief The metric at the other end of an edge along which sizes grow, by the mixed-space law of
 * F. Alauzet, "Size gradation control of anisotropic meshes", Finite Elements in Analysis and
 * Design 46 (2010), with the exponent 1/8. An isotropic size grows by rate |e|.
 * @param axes of the metric at the first end
 * @param rate the logarithm of the growth factor, at least 0
 */
TAUTLINE_KERNEL_EXPORT MetricTensor grownMetric(const MetricAxes& axes, const Vec3& e, double rate);

/**
 * @brief A tensor of a planar mesh or surface: the in-plane part for this unit normal and, along
 * the normal, its smaller eigenvalue (the larger size). The normal direction thus changes neither
 * the smallest size nor the size ratio, and lengthens no edge.
 */
TAUTLINE_KERNEL_EXPORT MetricTensor flattened(const MetricTensor& m, const Vec3& normal);
}
#endif
