// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpElastic.h
 * @brief Deforms a mesh as an elastic body whose small or inverted elements are stiffer.
 * Internal: not installed.
 *
 * IterativeStiffening: the stiffening step of "Untangling Before Newton" (S. P. Sastry, S. M.
 * Shontz and S. A. Vavasis), used for comparison in the dissertation: inverted elements are made
 * stiffer and the linear problem is solved again. JacobianStiffening: K. Stein, T. Tezduyar and R.
 * Benson, "Mesh moving techniques for fluid-structure interactions with large displacements", J.
 * Appl. Mech. 70, 2003: the Jacobian J of an element enters as J (J_0 / J)^chi, J_0 the mean.
 */
#ifndef tautline_WarpElastic_h
#define tautline_WarpElastic_h

#include "WarpParts.h"
#include "WarpSystem.h"

namespace tautline
{
/**
 * @class tautline::ElasticWarp
 * @brief The two elastic methods; keeps the matrix for the next boundary position.
 */
class ElasticWarp
{
public:
  /// Sets the stiffness of the elements; mesh and parts must outlive this object.
  ElasticWarp(const Mesh& mesh, const WarpParts& parts, WarpControl& control);

  /// Displacements of all points, 3 each.
  std::vector<double> warp(const double* displacement, WarpControl& control);

private:
  void assemble(WarpControl& control);
  bool solve(const double* displacement, WarpControl& control, std::vector<double>& moved);

  const Mesh& Input;
  const WarpParts& Parts;
  int Components;
  std::vector<double> Stiffening; ///< of the next assembly
  std::unique_ptr<WarpSystem> System;
  bool Uniform = true; ///< whether System has uniform stiffness
};
}
#endif
