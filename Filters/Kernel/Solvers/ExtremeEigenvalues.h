// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ExtremeEigenvalues.h
 * @brief The smallest and the largest eigenvalue of A, or of P^-1 A, for a PETSc matrix.
 * Internal: not installed.
 */
#ifndef tautline_ExtremeEigenvalues_h
#define tautline_ExtremeEigenvalues_h

#include "ConditionOptions.h"
#include "PetscObjects.h"
#include "Watchdog.h"

#include "tautline/Core/Stopwatch.h"

namespace tautline
{
/// Stops an eigensolver at limits common to all methods, on all ranks together.
class EigensolverStoppingTest
{
public:
  /// @param work progress() is called in its waiting thread; null: in this thread
  EigensolverStoppingTest(
    const PetscSystem& system, const ConditionOptions& options, WatchedWork* work = nullptr)
    : System(system)
    , Options(options)
    , Work(work)
  {
  }
  /// Reports the fraction done of the current stage; returns whether to stop.
  bool stop(double fraction);
  /// Maps the next stage to the fractions from `begin` to `end`.
  void stage(double begin, double end);
  bool stopped() const { return this->Late || this->Aborted; }
  double seconds() const { return this->Time.seconds(); }
  /// The stop reason, or "".
  std::string message() const;
  /// Rethrows the exception of progress().
  void rethrow() const;

private:
  bool userStops(double fraction);

  const PetscSystem& System;
  const ConditionOptions& Options;
  WatchedWork* Work;
  Stopwatch Time, SinceAsked;
  double Begin = 0.0, End = 1.0;
  bool Late = false, Aborted = false;
  std::exception_ptr Thrown;
};

/// The smallest or the largest eigenvalue.
struct ExtremeEigenvalue
{
  bool found = false;
  double value = 0.0;
  double bound = 0.0; ///< on the absolute error, from the residual
  int iterations = 0;
  std::string method;
  std::string message; ///< the reason why it was not found, or not to the tolerance
  PetscVector vector;  ///< of P^-1 A
};

/// Both ends of a spectrum.
struct ExtremeEigenvalues
{
  ExtremeEigenvalue smallest, largest;
};

/// Numbers from 0.25 to 1.25 that only depend on the row: the lowest mode is never missed, for any
/// number of ranks.
void fillStartVector(Vec vector, std::uint64_t seed = 0);

/**
 * @brief The Lanczos method for P^-1 A in the inner product of P, without reorthogonalization, in
 * two passes: the first finds the weights of the two eigenvectors, the second accumulates the
 * eigenvectors. Needs five vectors for any number of steps. (SLEPc's Krylov-Schur for the same
 * operator, in the inner product of A, needs 16; for the Laplacian on a grid of 60 x 60 points, it
 * takes 4 times as long with SSOR, ILU(0) and ICC(0), and 1.4 times as long with BoomerAMG.)
 *
 * For each of the two eigenvalues the tridiagonal matrix of the step at which it converged is used,
 * before rounding creates copies of the eigenvalue. With the accumulated y and x = P^-1 y, the
 * value is the Rayleigh quotient x^T A x / x^T y. The distance to an eigenvalue is at most the norm
 * of A x - theta y in the inner product of P^-1; rounding in the recurrence does not matter. If
 * that bound is far too large because eigenvalues are clustered, the error is estimated from the
 * last half of the steps.
 *
 * Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., sections 10.1 to 10.3; C. C.
 * Paige, J. Inst. Maths Applics 18 (1976), on the effect of rounding; bounds: B. N. Parlett, The
 * Symmetric Eigenvalue Problem, sections 10.6 and 15.9.
 */
ExtremeEigenvalues lanczosExtremeEigenvalues(
  Mat matrix, PC preconditioner, const ConditionOptions& options, EigensolverStoppingTest& test);

/**
 * @brief Both eigenvalues of a symmetric matrix by SLEPc: the largest by Krylov-Schur; the smallest
 * by Krylov-Schur on the inverse if a factorization is affordable, otherwise by LOBPCG with
 * BoomerAMG as the preconditioner.
 */
ExtremeEigenvalues slepcExtremeEigenvalues(Mat matrix, const LinearSystem& system, int ranks,
  const ConditionOptions& options, PetscOptionSet& optionSet, EigensolverStoppingTest& test);

/// Only the largest.
ExtremeEigenvalue slepcLargestEigenvalue(Mat matrix, const ConditionOptions& options,
  PetscOptionSet& optionSet, EigensolverStoppingTest& test);
}
#endif
