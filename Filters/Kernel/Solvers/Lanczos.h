// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Lanczos.h
 * @brief Extreme eigenvalues of a sparse symmetric matrix, and the conjugate gradient method.
 *
 * For well-conditioned matrices of any size that fit in memory: nothing is factorized. Results are
 * bitwise the same for any number of threads.
 */
#ifndef tautline_Lanczos_h
#define tautline_Lanczos_h

#include "SparseMatrix.h"
#include "tautline/SolversExport.h"

#include <functional>

namespace tautline
{
/// Accuracy and limits.
struct LanczosOptions
{
  double tolerance = 1e-8;    ///< relative error bound of both eigenvalues to reach
  Index maxIterations = 2000; ///< maximum number of iterations; each keeps a vector
  double timeLimit = 0.0;     ///< seconds; 0: none
  int threads = 0;            ///< 0: all cores
  /// Called with the fraction done, 0 to 1; the method stops if it returns false.
  std::function<bool(double)> progress;
};

/// The computed eigenvalues, with bounds and vectors.
struct Spectrum
{
  double smallest = 0.0, largest = 0.0; ///< eigenvalues
  /// Absolute error bounds: the norm r of the residual or, if smaller, r^2 over the distance to the
  /// next Ritz value (Kato-Temple, with the Ritz value as the eigenvalue).
  double smallestBound = 0.0, largestBound = 0.0;
  /// largest / smallest, the condition number of a positive definite matrix in the 2-norm; 0 if the
  /// smallest eigenvalue is not positive beyond its bound.
  double condition = 0.0;
  bool definite = false;  ///< whether the smallest eigenvalue is positive beyond its error bound
  bool converged = false; ///< whether both bounds are within the tolerance
  Index iterations = 0;
  std::vector<double> smallestVector, largestVector; ///< of norm 1
};

/**
 * @brief The extreme eigenvalues of a symmetric matrix by the Lanczos method with full
 * reorthogonalization (twice), from a fixed pseudo-random vector.
 *
 * If a limit is reached or progress() returns false, the result is the best so far, with its bounds
 * and `converged` false. Throws Error for an empty matrix or entries that are not finite.
 *
 * SLEPc's Krylov-Schur is not a substitute: it does not return unconverged pairs, only checks for a
 * stop between restarts, and takes 1 to 3 times as long for nonlocal matrices.
 *
 * Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., section 10.1-10.3; the bound:
 * B. N. Parlett, The Symmetric Eigenvalue Problem, section 10.6.
 */
TAUTLINE_SOLVERS_EXPORT Spectrum extremeEigenvalues(
  const SparseMatrix& matrix, const LanczosOptions& options = {});

/// How the conjugate gradient method ended.
struct SolveReport
{
  Index iterations = 0;
  double residual = 0.0; ///< norm of b - A x over the norm of b, computed from x
  /// Whether the method reached the tolerance, and `residual` is at most ResidualFactor times the
  /// tolerance.
  bool converged = false;
  /// Extreme Ritz values of the preconditioned matrix: they lie inside its spectrum; 0 without a
  /// step.
  double ritzSmallest = 0.0, ritzLargest = 0.0;
};

/// z = B r, both with as many entries as the matrix has rows; B symmetric positive definite.
using Preconditioning = std::function<void(const double* r, double* z)>;

/**
 * @brief Solves A x = b, A symmetric positive definite, by preconditioned conjugate gradients, from
 * x = 0, to a relative residual of `tolerance`.
 * @param precondition null: division by the diagonal of A (Jacobi)
 *
 * Throws Error if A or B proves not to be positive definite.
 *
 * Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., sections 11.3.8 and 11.5.
 */
TAUTLINE_SOLVERS_EXPORT SolveReport solveConjugateGradients(const SparseMatrix& matrix,
  const std::vector<double>& b, std::vector<double>& x, double tolerance = 1e-10,
  const LanczosOptions& options = {}, const Preconditioning& precondition = nullptr);

/// 1 / a_ii. Throws Error if a diagonal entry is not above 0.
TAUTLINE_SOLVERS_EXPORT std::vector<double> inverseDiagonal(const SparseMatrix& matrix);
}
#endif
