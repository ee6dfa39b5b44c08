/**
 * @file LinearSolver.h
 * @brief Sparse linear systems solved by PETSc: Krylov methods and preconditioners of chapter 2,
 * and direct solvers.
 *
 * Each solver has options of its own; those of other users of PETSc in the process are neither read
 * nor changed. PETSc is initialized at first use, on the MPI the program has (or its own), without
 * its signal handler. Its errors become Error.
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
   * that are not finite, or no memory.
   */
  LinearSolver(const LinearSystem& system, const SolverOptions& options);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// Builds the preconditioner or factorization, unless it exists; returns the seconds it took.
  double setUp();

  /**
   * @brief Solves A x = b. On several ranks b holds this rank's contributions (added up like the
   * matrix) and x gets the values of all of this rank's unknowns, shared ones too. A failure is a
   * reason, with x the last iterate; it does not throw.
   */
  LinearSolution solve(const double* b, double* x);

  /// Tolerances, limits, observer and initial guess may change between solves; the rest is read
  /// once.
  SolverOptions& options();

  /// PETSc's objects; in LinearSolverState.h, for the kernel itself.
  LinearSolverState& state() { return *this->Impl; }

private:
  std::unique_ptr<LinearSolverState> Impl;
};
}
#endif
