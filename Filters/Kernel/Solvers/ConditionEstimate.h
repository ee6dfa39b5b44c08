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
  double smallest = 0.0, largest = 0.0; ///< eigenvalues; 0 where not found
  /// Relative errors: bounds from residuals or, where eigenvalues crowd, an estimate from the last
  /// half of the iterations; infinity where there is no bound (Ritz values).
  double smallestError = 0.0, largestError = 0.0;
  double condition = 0.0; ///< largest / smallest; 0 where the smallest is not positive
  bool converged = false;
  std::string method;  ///< "Krylov-Schur, shift-invert (Cholesky)", ...
  std::string message; ///< what limits the accuracy, or why it failed; or ""
  /// Steps of Lanczos, restarts of Krylov-Schur, iterations of CG or LOBPCG; for both eigenvalues
  /// together.
  int iterations = 0;
  double seconds = 0.0;
  /// Eigenvectors, this rank's unknowns; empty where not found (Ritz values, or no time).
  std::vector<double> smallestVector, largestVector;
};

/**
 * @brief Extreme eigenvalues of A or of P^-1 A, and their ratio. Collective over the ranks.
 *
 * Failures of PETSc or SLEPc, a matrix that is singular or not definite, a preconditioner that is
 * not symmetric or not definite, the time limit and an abort are messages, not exceptions; what was
 * found is kept, unless a factorization or a set-up had to be given up (see LinearSolver). Invalid
 * options throw Error, and so does what LinearSolver rejects. Errors are those of the computed
 * vectors: that no eigenvalue lies further out rests on the start vector, which is random, and for
 * a factorized A on its number of negative pivots.
 */
TAUTLINE_SOLVERS_EXPORT ConditionEstimate estimateCondition(
  const LinearSystem& system, const ConditionOptions& options);
}
#endif
