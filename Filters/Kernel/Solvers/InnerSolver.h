// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InnerSolver.h
 * @brief A multigrid cycle or a factorization from PETSc inside a method of Tautline.
 * Internal: not installed.
 */
#ifndef tautline_InnerSolver_h
#define tautline_InnerSolver_h

#include "LinearSolver.h"

namespace tautline
{
/**
 * @class tautline::InnerSolver
 * @brief z = S r with a symmetric positive definite S: one cycle of BoomerAMG, or the inverse.
 */
class InnerSolver
{
public:
  enum class Kind
  {
    Multigrid,
    Factorization
  };

  /**
   * @brief Sets up the map.
   * @param matrix symmetric positive definite; at least one row
   * @param blockSize unknowns per point
   *
   * Throws Error with PETSc's reason if the setup fails.
   */
  InnerSolver(SparseMatrix matrix, int blockSize, Kind kind);

  /// z = S r. Throws Error if PETSc fails.
  void apply(const double* r, double* z);

private:
  std::shared_ptr<const SparseMatrix> Matrix; // PETSc reads it
  std::unique_ptr<LinearSolver> Solver;
};
}
#endif
