// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LinearSolverState.h
 * @brief PETSc's objects and the state of a LinearSolver.
 * Internal: not installed.
 */
#ifndef tautline_LinearSolverState_h
#define tautline_LinearSolverState_h

#include "PetscCompatibility.h"
#include "PetscObjects.h"
#include "Residual.h"
#include "SolverOptions.h"
#include "Watchdog.h"

#include "tautline/Core/Stopwatch.h"

namespace tautline
{
/// Limits after which the work on a system is abandoned, somewhat later than the limits at which it
/// ends by itself; none on several ranks, which must all end together.
WatchLimits hardLimits(
  double maximumSeconds, const std::function<bool()>& cancelled, const LinearSystem& system);

/// The system, with copies of the data it does not own.
LinearSystem owned(const LinearSystem& system);

/// The objects of one solver.
struct LinearSolverState
{
  LinearSolverState(const LinearSystem& system, const SolverOptions& options);

  /// Throws Error if PETSc has been shut down since: its objects must not be accessed.
  void requireAlive() const;
  double setUp();
  LinearSolution solve(const double* b, double* x);

  LinearSystem System;
  SolverOptions Options;
  int Generation = petscGeneration();
  PetscOptionSet OptionSet;
  PetscSystem Objects;
  PetscSolver Solver;
  bool Ready = false;                       // the setup has been attempted
  SolveReason Failure = SolveReason::Exact; // of the setup; Exact: none
  std::string FailureText;

  // The convergence test selected by PETSc or its options; Tautline's test calls it first.
  PetscErrorCode (*Test)(KSP, PetscInt, PetscReal, KSPConvergedReason*, void*) = nullptr;
  void* TestContext = nullptr;
  ContextDestructor DestroyTest = nullptr;

  // The current setup or solve.
  // calls back to the waiting thread; null: this thread does all the work
  WatchedWork* Work = nullptr;
  Stopwatch Time;
  Stopwatch SinceObserved, SinceAsked;
  std::vector<double> Residuals;
  int Before = 0;                           // iterations of earlier rounds
  double Relative = 0.0, Absolute = 0.0;    // tolerances
  SolveReason Stopped = SolveReason::Exact; // TimeLimit or Aborted
  std::exception_ptr Thrown;                // thrown by the observer
  bool Verified = false;                    // whether the residual of the solution is known

  ~LinearSolverState();

private:
  std::string subject() const;
  void configure();
  void applyTolerances();
  void findEmptyRows();
  void runSolver(Vec b, Vec x, LinearSolution& solution);
  bool tighten(const LinearSolution& solution, int most);
  void takeSolution(const double* b, Vec unknowns, double* x, LinearSolution& solution);
  double allowedResidual() const;
  double norm(const std::vector<double>& contributions) const;
  double roundingLevel(const double* b, const double* x) const;
  LinearSolution attempt(const double* b, double* x);
  Residual residual(const double* b, const double* x) const;
  void verify(const double* b, const double* x, const Residual& residual, LinearSolution& solution);
  void ritzValues(LinearSolution& solution);
  bool shouldStop(int iteration, double norm);
  bool userStops(int iteration, double norm);
  static PetscErrorCode test(
    KSP solver, PetscInt iteration, PetscReal norm, KSPConvergedReason* reason, void* self);
};
}
#endif
