// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PeridynamicsKernel.h
 * @brief A radial kernel and its radial integrals.
 * Internal: not installed.
 */
#ifndef tautline_PeridynamicsKernel_h
#define tautline_PeridynamicsKernel_h

#include "PeridynamicOptions.h"

#include <array>

namespace tautline
{
/// Points that are evaluated together.
constexpr int NodeCount = 8;
using Nodes = std::array<double, NodeCount>;

/// s of the bilinear form, see Peridynamics.h.
double kernelScale(const PeridynamicOptions& options);

/**
 * @brief k(r) for 0 < r <= delta, and F_m(R) = int_0^R r^(m+1) k(r) dr, m = 0 .. 6.
 *
 * For powers whose integral from 0 diverges (m + 2 < p), F_m is the primitive that vanishes at
 * infinity or, near m + 2 = p, the primitive that vanishes at the horizon. Sums of F_m over closed
 * directions that do not enclose the point are still correct; sums around the point need the
 * integral from 0, which then exists (fromOrigin).
 */
class RadialKernel
{
public:
  static constexpr int Orders = 7;

  RadialKernel(const KernelFunction& function, double horizon);

  /// k at given squares of r; 0 if r is at most 1e-10 horizons.
  void evaluate(const double* squares, double* values, Index count) const;
  /// F_m(R) / R^(m+2) at given squares of R, for m from first to last, into ratios[m].
  void ratios(
    const Nodes& squares, int first, int last, Nodes* ratios, bool fromOrigin = false) const;
  /// F_m(horizon).
  double atHorizon(int m, bool fromOrigin = false) const
  {
    return this->isShifted(m) && !fromOrigin ? 0.0 : this->Full[m];
  }

private:
  void power(const double* squares, double* values, Index count) const;
  double value(double r) const;
  bool isShifted(int m) const
  {
    constexpr double near = 0.25;
    return this->Function.shape == KernelShape::Power &&
      std::abs(m + 2.0 - this->Function.exponent) < near;
  }

  KernelFunction Function;
  double Horizon;
  int Quarters = -1; ///< of r^2 in the power, if it is a whole number of quarters
  double Full[Orders];
  /// Shapes other than powers: values of F_m at equal distances from 0 to the horizon.
  std::vector<double> Radii, Integrals[Orders];
};
}
#endif
