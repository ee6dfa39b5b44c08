#include "LinearSolver.h"

#include "LinearSolverState.h"

namespace tautline
{
LinearSolver::LinearSolver(const LinearSystem& system, const SolverOptions& options)
{
  const PetscScope scope;
  this->Impl = std::make_unique<LinearSolverState>(system, options);
}

LinearSolver::~LinearSolver()
{
  // Once PETSc has gone, nothing is left to destroy, and it must not be initialized for that.
  if (petscUsable())
  {
    const PetscScope scope;
    this->Impl.reset();
  }
}

double LinearSolver::setUp()
{
  this->Impl->requireAlive();
  const PetscScope scope(this->Impl->OptionSet.database());
  return this->Impl->setUp();
}

LinearSolution LinearSolver::solve(const double* b, double* x)
{
  this->Impl->requireAlive();
  const PetscScope scope(this->Impl->OptionSet.database());
  return this->Impl->solve(b, x);
}

SolverOptions& LinearSolver::options()
{
  return this->Impl->Options;
}
}
