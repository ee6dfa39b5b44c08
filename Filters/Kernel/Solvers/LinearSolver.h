// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LinearSolver.h
 * @brief Sparse linear systems solved by PETSc: Krylov methods and preconditioners of chapter 2,
 * and direct solvers.
 *
 * Each solver has its own options; options of other users of PETSc in the process are neither read
 * nor changed. PETSc is initialized at first use, with the MPI of the program (or its own), without
 * its signal handler and without .petscrc. Its errors are converted to Error.
 *
 * Limits: on one rank, PETSc runs in a separate thread if there is a time limit or a `cancelled`
 * function, and the calling thread waits for it and calls the observer. An abandoned setup
 * continues in the background until it ends by itself, and then frees its memory. The next solver
 * waits for it, under its own limits. If the process ends in the meantime, it does not wait. On
 * several ranks, or if the program has started MPI with less than MPI_THREAD_MULTIPLE (pvserver,
 * pvbatch, MPI_Init()) or has started PETSc itself, the calling thread does the work, and limits
 * are checked after the setup and between iterations.
 */
#ifndef tautline_LinearSolver_h
#define tautline_LinearSolver_h

#include "LinearSystem.h"
#include "SolverOptions.h"
#include "tautline/SolversExport.h"

#include <memory>

namespace tautline
{
struct LinearSolverState;

/**
 * @class tautline::LinearSolver
 * @brief Keeps a matrix and its preconditioner or factorization for many right-hand sides.
 */
class TAUTLINE_SOLVERS_EXPORT LinearSolver
{
public:
  /**
   * @brief Passes the matrix to PETSc; the SparseMatrix must outlive the solver. Collective over
   * the ranks. Throws Error for an invalid option string (stating the option), an empty matrix,
   * entries that are not finite, insufficient memory, or if a limit is reached while an abandoned
   * setup still occupies PETSc.
   */
  LinearSolver(const LinearSystem& system, const SolverOptions& options);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// Builds the preconditioner or factorization unless it exists; returns the elapsed seconds. A
  /// failure or a reached limit becomes the reason of the following solves.
  double setUp();

  /**
   * @brief Solves A x = b. On several ranks, b holds the contributions of this rank (summed like
   * the matrix), and x receives the values of all unknowns of this rank, including shared ones.
   * Failures do not throw: they are reported as a reason, with x as the last iterate. If the work
   * was abandoned, x is 0 (or the initial guess), and this solver cannot be used again: later
   * solves return the same reason.
   *
   * Independent of PETSc's report, Tautline computes the residual |b - A x| with its own product:
   * see ResidualFactor.
   */
  LinearSolution solve(const double* b, double* x);

  /// Tolerances, limits, observer and initial guess may change between solves; other options are
  /// read once.
  SolverOptions& options();

  /// The PETSc objects, declared in LinearSolverState.h, for use in the kernel.
  LinearSolverState& state() { return *this->Impl; }

private:
  void abandon(SolveReason reason, const std::string& stage);
  LinearSolution lost(const double* b, double* x) const;

  std::shared_ptr<LinearSolverState> Impl; // null if it was abandoned
  LinearSystem System;
  SolverOptions Options;
  // the reason for abandoning it; Exact: it was not abandoned
  SolveReason Lost = SolveReason::Exact;
  std::string LostMessage;
};
}
#endif
