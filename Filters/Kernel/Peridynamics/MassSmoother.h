// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MassSmoother.h
 * @brief An approximate inverse of a nonlocal matrix on waves shorter than the horizon.
 * Internal: not installed.
 */
#ifndef tautline_MassSmoother_h
#define tautline_MassSmoother_h

#include "PeridynamicOptions.h"

#include <array>

namespace tautline
{
/**
 * @brief z = Q r, Q symmetric positive definite: the inverse of the diagonal or, with a linear
 * basis and an integrable kernel, of the mass matrix scaled to that diagonal.
 *
 * On short waves, the form of an integrable kernel is a multiple of the mass matrix M. The
 * eigenvalues of M relative to its diagonal are between 1/2 and 2 on every mesh (Wathen 1987), so
 * that three Chebyshev steps reduce the error to 7 %. For other kernels, the form grows with the
 * frequency about as much as M decreases, and the diagonal is the better choice; with the constant
 * basis, both are the same.
 *
 * Source: A. J. Wathen, IMA J. Numer. Anal. 7 (1987) 449-457; Y. Saad, Iterative Methods for Sparse
 * Linear Systems, 2nd ed., algorithm 12.1.
 */
class MassSmoother
{
public:
  /// Throws Error if a diagonal entry of the system is not above 0.
  MassSmoother(
    const HorizonMesh& mesh, const PeridynamicOptions& options, const PeridynamicSystem& system);
  void apply(const double* r, double* z);

private:
  void subtractProduct(const std::vector<double>& x, std::vector<double>& y) const;

  Index Components;
  std::vector<double> Inverse; ///< of the diagonal of the system
  /// Per triangle: its unknown functions (-1 if given) and its area; empty: use the diagonal only.
  std::vector<std::array<std::int32_t, 3>> Functions;
  std::vector<double> Areas;
  std::vector<double> Scale; ///< per row: root of its diagonal entry over the diagonal entry of M
  std::vector<double> Residual, Step;
};

/// The order in q at which the form grows on waves exp(i q x) shorter than the horizon; at most 0:
/// the kernel is integrable.
double formOrder(const PeridynamicOptions& options);
}
#endif
