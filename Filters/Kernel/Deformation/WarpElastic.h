/**
 * @file WarpElastic.h
 * @brief A mesh moved as an elastic body, small or inverted elements stiffer than others. Internal:
 * not installed.
 *
 * IterativeStiffening: the part of "Untangling Before Newton" (S. P. Sastry, S. M. Shontz and S. A.
 * Vavasis) the dissertation compares with: wherever elements come out inverted, they are made
 * stiffer and the linear problem is solved anew. JacobianStiffening: K. Stein, T. Tezduyar and R.
 * Benson, "Mesh moving techniques for fluid-structure interactions with large displacements", J.
 * Appl. Mech. 70, 2003: the Jacobian J of an element enters as J (J_0 / J)^chi, J_0 the mean.
 */
#ifndef tautline_WarpElastic_h
#define tautline_WarpElastic_h

#include "WarpParts.h"
#include "WarpSystem.h"

namespace tautline
{
class ElasticWarp
{
public:
  ElasticWarp(const Mesh& mesh, const WarpParts& parts, WarpControl& control);

  /// Displacements of all points.
  std::vector<double> warp(const double* displacement, WarpControl& control);

private:
  void assemble(WarpControl& control);
  bool solve(const double* displacement, WarpControl& control, std::vector<double>& moved);

  const Mesh& Input;
  const WarpParts& Parts;
  int Components;
  std::vector<double> Stiffening; ///< of the next assembly
  std::unique_ptr<WarpSystem> System;
  bool Uniform = true; ///< what System has
};
}
#endif
