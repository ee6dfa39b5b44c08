/**
 * @file EllipticSolution.h
 * @brief The solution of a boundary value problem on the points and cells of a mesh.
 */
#ifndef tautline_EllipticSolution_h
#define tautline_EllipticSolution_h

#include "tautline/Solvers/SolverOptions.h"

namespace tautline
{
struct EllipticSolution
{
  int components = 1; ///< 1, or 3 for elasticity
  /// Components per point; NaN at points outside all cells: no equation is about them.
  std::vector<double> values;
  /// Per cell, at its centre: gradient (3), or stress of elasticity (6, as SymmetricTensor). Ghosts
  /// have theirs, too; NaN for faces beside volumes and where a value is NaN.
  std::vector<double> gradients;
  LinearSolution linear;
};
}
#endif
