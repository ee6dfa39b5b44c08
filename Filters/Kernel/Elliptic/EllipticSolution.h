// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EllipticSolution.h
 * @brief The solution of a boundary value problem on the points and cells of a mesh.
 */
#ifndef tautline_EllipticSolution_h
#define tautline_EllipticSolution_h

#include "tautline/Solvers/SolverOptions.h"

namespace tautline
{
/// The fields of a solution on this rank, and the report of the linear solver.
struct EllipticSolution
{
  int components = 1; ///< 1, or 3 for elasticity
  /// Components per point; NaN at points outside all cells, which have no equation.
  std::vector<double> values;
  /// Per cell, at its center: the gradient (3), or the stress for elasticity (6, as
  /// SymmetricTensor). Also for ghosts; NaN for faces of volumes and where a value is NaN.
  std::vector<double> gradients;
  LinearSolution linear;
};
}
#endif
