// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LinearSolver.h
 * @brief Sparse linear systems solved by PETSc: Krylov methods and preconditioners of chapter 2,
 * and direct solvers.
 *
 * Each solver has options of its own; those of other users of PETSc in the process are neither read
 * nor changed. PETSc is initialized at first use, on the MPI the program has (or its own), without
 * its signal handler and without .petscrc. Its errors become Error.
 *
 * Limits: on one rank, PETSc works in a thread of its own if there is a time limit or a `cancelled`
 * function, and the calling thread waits for it; the observer is called from there. A set-up that
 * is given up goes on in the background until it ends by itself, and then frees its memory. The
 * next solver waits for that, under its own limits. If the process ends meanwhile, it ends without
 * waiting. On several ranks, where the program has started MPI with less than MPI_THREAD_MULTIPLE
 * (pvserver, pvbatch, MPI_Init()) or has started PETSc itself, the calling thread does the work,
 * and limits are checked after the set-up and between iterations.
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
   * @brief Hands the matrix to PETSc; the SparseMatrix must outlive the solver. Collective over the
   * ranks. Throws Error for an invalid option string (naming the option), an empty matrix, entries
   * that are not finite, no memory, or if a limit is reached while an abandoned set-up still
   * occupies PETSc.
   */
  LinearSolver(const LinearSystem& system, const SolverOptions& options);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// Builds the preconditioner or factorization, unless it exists; returns the seconds it took. A
  /// failure, or a limit that is reached, is the reason of the following solves.
  double setUp();

  /**
   * @brief Solves A x = b. On several ranks b holds this rank's contributions (added up like the
   * matrix) and x gets the values of all of this rank's unknowns, shared ones too. A failure is a
   * reason, with x the last iterate; it does not throw. If the work was given up, x is 0 (or the
   * initial guess) and this solver is used up: later solves return the same reason.
   *
   * Whatever PETSc reports, the residual |b - A x| is computed by Tautline's own product: see
   * ResidualFactor.
   */
  LinearSolution solve(const double* b, double* x);

  /// Tolerances, limits, observer and initial guess may change between solves; the rest is read
  /// once.
  SolverOptions& options();

  /// PETSc's objects; in LinearSolverState.h, for the kernel itself.
  LinearSolverState& state() { return *this->Impl; }

private:
  void abandon(SolveReason reason, const std::string& stage);
  LinearSolution lost(const double* b, double* x) const;

  std::shared_ptr<LinearSolverState> Impl; // null when it was given up
  LinearSystem System;
  SolverOptions Options;
  SolveReason Lost = SolveReason::Exact; // why it was given up; Exact: it was not
  std::string LostMessage;
};
}
#endif
