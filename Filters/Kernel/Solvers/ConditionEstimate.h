// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ConditionEstimate.h
 * @brief Extreme eigenvalues and 2-norm condition numbers of A and of P^-1 A.
 */
#ifndef tautline_ConditionEstimate_h
#define tautline_ConditionEstimate_h

#include "ConditionOptions.h"
#include "LinearSystem.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/// Extreme eigenvalues with their errors and vectors.
struct ConditionEstimate
{
  double smallest = 0.0, largest = 0.0; ///< eigenvalues; 0 if not found
  /// Relative errors: bounds from residuals or, for clustered eigenvalues, an estimate from the
  /// last half of the iterations; infinity if there is no bound (Ritz values).
  double smallestError = 0.0, largestError = 0.0;
  double condition = 0.0; ///< largest / smallest; 0 if the smallest is not positive
  bool converged = false;
  std::string method;  ///< "Krylov-Schur, shift-invert (Cholesky)", ...
  std::string message; ///< what limits the accuracy, or why it failed; or ""
  /// Steps of Lanczos, restarts of Krylov-Schur, iterations of CG or LOBPCG; for both eigenvalues
  /// together.
  int iterations = 0;
  double seconds = 0.0;
  /// Eigenvectors, for the unknowns of this rank; empty if not found (Ritz values, or out of time).
  std::vector<double> smallestVector, largestVector;
};

/**
 * @brief Extreme eigenvalues of A or of P^-1 A, and their ratio. Collective over the ranks.
 *
 * Failures of PETSc or SLEPc, a matrix that is singular or not definite, a preconditioner that is
 * not symmetric or not definite, the time limit and an abort are reported as messages, not
 * exceptions; partial results are kept, unless a factorization or a setup had to be abandoned (see
 * LinearSolver). Invalid options and inputs rejected by LinearSolver throw Error. Errors refer to
 * the computed vectors: the assumption that no eigenvalue lies farther out relies on the random
 * start vector and, for a factorized A, on its number of negative pivots.
 */
TAUTLINE_SOLVERS_EXPORT ConditionEstimate estimateCondition(
  const LinearSystem& system, const ConditionOptions& options);
}
#endif
