// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricCertifier.h
 * @brief The minimum of a quality metric over a whole curved element, with certified bounds.
 *
 * A metric is a function of T = A W^-1 at each point of the element, where A is the Jacobian of its
 * map from the reference element and W is the Jacobian of the ideal element of its shape (edges of
 * length 1; the equilateral triangle and tetrahedron, square, cube, right wedge, equilateral
 * pyramid). det T,
 * |T|^2 and |adj T|^2 are polynomials in Bernstein form; bounds of their quotient follow from the
 * coefficients (see BernsteinQuotient.h) and are improved by subdivision.
 *
 * The method follows A. Johnen, C. Geuzaine, T. Toulorge, J.-F. Remacle, "Quality measures for
 * curvilinear finite elements", in TILDA: Towards Industrial LES/DNS in Aeronautics, Springer
 * (2021), with bounds of second order.
 */
#ifndef tautline_MetricCertifier_h
#define tautline_MetricCertifier_h

#include "ElementType.h"

#include <memory>

namespace tautline
{
/// Pointwise metrics, 1 for the ideal element and 0 for a degenerate one; d is the dimension.
enum class ElementMetric
{
  MeanRatio,        ///< d det(T)^(2/d) / |T|^2, the reciprocal of the inverse mean ratio
  InverseCondition, ///< d / (|T| |T^-1|), the reciprocal of the condition number; in 2D MeanRatio
  /// det A over the product of the edge lengths at a corner (for a simplex, the corner where it is
  /// smallest), scaled to 1 for the ideal element. Not for pyramids.
  ScaledJacobian
};

/// Bounds of the minimum of a metric over an element.
struct MetricBound
{
  double lower = 0;
  double upper = 0;      ///< the value at a point of the element
  Vec3 at = { 0, 0, 0 }; ///< the point, as in JacobianBound
};

/**
 * @class MetricCertifier
 * @brief Bounds one metric for elements of one type.
 *
 * For elements of a surface in space, the length of their normal is used as the determinant.
 *
 * Has its own memory and allocates none per element: use one object per thread. The type must
 * outlive it.
 */
class TAUTLINE_KERNEL_EXPORT MetricCertifier
{
public:
  /// The same arguments as for JacobianCertifier; throws Error for the scaled Jacobian of a
  /// pyramid.
  MetricCertifier(const ElementType& type, ElementMetric metric, const Vec3& normal = { 0, 0, 0 },
    bool mirrored = false);
  ~MetricCertifier();
  MetricCertifier(MetricCertifier&&) noexcept;
  MetricCertifier(const MetricCertifier&) = delete;
  void operator=(const MetricCertifier&) = delete;

  /**
   * @brief The minimum over one element.
   * @param tolerance the largest distance of the bounds; at least 1e-9
   *
   * If the determinant is found to be negative, the search ends: the upper bound is the value
   * there, with the sign of the determinant (|det| in the formula), and the lower bound is
   * -infinity. Use JacobianCertifier to decide whether it is negative anywhere. If a coordinate is
   * not finite, the bounds are NaN.
   */
  MetricBound minimum(const double* points, const Index* nodes, double tolerance = 1e-3);

  /// The value at a point, with the sign of the determinant; 0 where it is undefined.
  double valueAt(const double* points, const Index* nodes, const Vec3& at);

  /// The total number of bisections so far.
  Index splits() const;

private:
  struct Work;
  std::unique_ptr<Work> Memory;
};
}
#endif
