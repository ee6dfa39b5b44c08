// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InnerSolver.h
 * @brief A cycle of multigrid or a factorization of PETSc inside a method of Tautline's own.
 * Internal: not installed.
 */
#ifndef tautline_InnerSolver_h
#define tautline_InnerSolver_h

#include "LinearSolver.h"

namespace tautline
{
/**
 * @class tautline::InnerSolver
 * @brief z = S r, S symmetric positive definite: one cycle of BoomerAMG, or the inverse.
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
   * @brief Sets the map up.
   * @param matrix symmetric positive definite; at least one row
   * @param blockSize unknowns per point
   *
   * Throws Error with PETSc's reason where the set-up fails.
   */
  InnerSolver(SparseMatrix matrix, int blockSize, Kind kind);

  /// z = S r. Throws Error where PETSc fails.
  void apply(const double* r, double* z);

private:
  std::shared_ptr<const SparseMatrix> Matrix; // PETSc reads it
  std::unique_ptr<LinearSolver> Solver;
};
}
#endif
