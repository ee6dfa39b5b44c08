// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FieldDerivatives.h
 * @brief Gradient and Hessian of a field that is known at the points of a mesh.
 *
 * On surfaces, they are tangential: the components along the normal are 0.
 */
#ifndef tautline_FieldDerivatives_h
#define tautline_FieldDerivatives_h

#include "AdaptationMesh.h"

namespace tautline
{
enum class HessianRecovery
{
  /// A quadratic is fitted to the values at the neighbors of a point: exact for quadratics where
  /// the neighbors determine it. Supports all element types.
  QuadraticFit,
  /// The volume-weighted mean of the element gradients, applied twice for second derivatives.
  /// Smoother; first-order accurate where the mesh is smoothly graded, not convergent where it is
  /// irregular. At and next to the boundary, values are extrapolated from the interior. Triangles
  /// and tetrahedra only.
  DoubleProjection
};

/// The gradients at the points, by a quadratic fit. @param values one per point of the mesh
TAUTLINE_KERNEL_EXPORT std::vector<Vec3> recoverGradients(
  const AdaptationMesh& mesh, const std::vector<double>& values);

/**
 * @brief The Hessians at the points.
 * @param values one per point of the mesh
 *
 * Throws Error if the double projection is requested for a mesh with other elements.
 */
TAUTLINE_KERNEL_EXPORT std::vector<MetricTensor> recoverHessians(
  const AdaptationMesh& mesh, const std::vector<double>& values, HessianRecovery recovery);

/**
 * @brief Per point: an upper bound on the eigenvalues of a Hessian that results only from rounding
 * of the values.
 * @param precision relative, of the values: 2^-52 for double, 2^-23 for single precision
 */
TAUTLINE_KERNEL_EXPORT std::vector<double> hessianNoise(
  const AdaptationMesh& mesh, const std::vector<double>& values, double precision);
}
#endif
