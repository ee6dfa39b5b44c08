/**
 * @file LinearSolverState.h
 * @brief PETSc's objects and the state of a LinearSolver. Not a public header.
 */
#ifndef tautline_LinearSolverState_h
#define tautline_LinearSolverState_h

#include "PetscObjects.h"
#include "SolverOptions.h"

#include "tautline/Core/Stopwatch.h"

namespace tautline
{
/// The objects of one solver.
struct LinearSolverState
{
  LinearSolverState(const LinearSystem& system, const SolverOptions& options);

  /// Throws Error if PETSc has been shut down since: nothing of it may be touched.
  void requireAlive() const;
  double setUp();
  LinearSolution solve(const double* b, double* x);

  LinearSystem System;
  SolverOptions Options;
  int Generation = petscGeneration();
  PetscOptionSet OptionSet;
  PetscSystem Objects;
  PetscSolver Solver;
  bool Ready = false;                       // set up, or failed to
  SolveReason Failure = SolveReason::Exact; // of the set-up; Exact: none
  std::string FailureText;

  // The convergence test that PETSc or its options chose; Tautline's calls it first.
  PetscErrorCode (*Test)(KSP, PetscInt, PetscReal, KSPConvergedReason*, void*) = nullptr;
  void* TestContext = nullptr;
  PetscErrorCode (*DestroyTest)(void*) = nullptr;

  // Of the current solve.
  Stopwatch Time;
  std::vector<double> Residuals;
  SolveReason Stopped = SolveReason::Exact; // TimeLimit or Aborted
  std::exception_ptr Thrown;                // by the observer

  ~LinearSolverState();

private:
  void configure();
  void applyTolerances();
  void findEmptyRows();
  void runSolver(Vec b, Vec x, LinearSolution& solution);
  void measure(Vec b, Vec x, LinearSolution& solution);
  void ritzValues(LinearSolution& solution);
  bool shouldStop(int iteration, double norm);
  static PetscErrorCode test(
    KSP solver, PetscInt iteration, PetscReal norm, KSPConvergedReason* reason, void* self);
};
}
#endif
