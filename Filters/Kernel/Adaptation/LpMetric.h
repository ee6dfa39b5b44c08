// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LpMetric.h
 * @brief The metric that minimizes the interpolation error of a field in the L^p norm.
 *
 * M = D det(|H|)^(-1 / (2 p + d)) |H| in d dimensions, where |H| is the Hessian H with the absolute
 * values of its eigenvalues, and D sets the number of elements. See A. Loseille and F. Alauzet,
 * "Continuous mesh framework part I: well-posed continuous interpolation error", SIAM J. Numerical
 * Analysis 49 (2011).
 */
#ifndef tautline_LpMetric_h
#define tautline_LpMetric_h

#include "FieldDerivatives.h"

namespace tautline
{
/// The absolute values of Hessians, positive definite, in a unit that avoids overflow and
/// underflow.
struct HessianMagnitudes
{
  std::vector<MetricTensor> tensors; ///< per point; flattened() for planar meshes and surfaces
  double unit = 1.0;                 ///< of the tensors
  bool vanish = false;               ///< the field is linear, to rounding: there are no tensors
};

/**
 * @brief |H| of a field. Where it has several components, the intersection() of their |H|.
 *
 * Eigenvalues within the rounding of the values are treated as 0. Eigenvalues are raised to at
 * least the largest one at the point over ratio^2, and at least 1e-12 of the largest one of all
 * points.
 * @param values `components` per point of the mesh, finite
 * @param precision of the values, see hessianNoise()
 * @param ratio of sizes at a point, at least 1, finite
 */
TAUTLINE_KERNEL_EXPORT HessianMagnitudes hessianMagnitudes(const AdaptationMesh& mesh,
  const std::vector<double>& values, int components, HessianRecovery recovery, double precision,
  double ratio);

/**
 * @class tautline::LpMetric
 * @brief The metrics for any factor D, within limits.
 */
class TAUTLINE_KERNEL_EXPORT LpMetric
{
public:
  /**
   * @param mesh outlives this
   * @param hessians per point, positive definite
   * @param norm p, at least 1; infinity: the largest error
   */
  LpMetric(const AdaptationMesh& mesh, const std::vector<MetricTensor>& hessians, double norm,
    const MetricLimits& limits);

  /// The metrics with a factor D, within the limits.
  std::vector<MetricTensor> at(double factor) const;

  /// The factor with which the integral of the root of the determinant, with these weights of the
  /// points, is `target`; where the limits prevent this, the factor with the nearest integral.
  /// @param weights AdaptationMesh::volumes() or idealVolumes()
  double factorFor(const std::vector<double>& weights, double target) const;

  /**
   * @brief The factor for an interpolation error, without limits. Let t be the trace of
   * M^(-1/2) |H| M^(-1/2). With a finite p it is the L^p norm of the mean error of each element,
   * t / 16 in the plane and t / 20 in space; with infinity the largest error of all elements,
   * t / 12 and t / 16. Exact for ideal elements with edges of length 1 where the eigenvalues of H
   * have the same sign.
   */
  double factorForError(double error) const;

private:
  double integralAt(const std::vector<double>& weights, double factor) const;

  const AdaptationMesh& TheMesh;
  double Norm;
  MetricLimits Limits;
  std::vector<MetricAxes> Axes; ///< of the metrics with D = 1
  std::vector<double> Determinants;
};
}
#endif
