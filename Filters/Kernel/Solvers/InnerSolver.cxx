// SPDX-License-Identifier: BSD-3-Clause
#include "InnerSolver.h"

#include "LinearSolverState.h"

namespace tautline
{
InnerSolver::InnerSolver(SparseMatrix matrix, int blockSize, Kind kind)
  : Matrix(std::make_shared<SparseMatrix>(std::move(matrix)))
{
  LinearSystem system;
  system.matrix = this->Matrix.get();
  system.blockSize = blockSize;
  system.owner = this->Matrix;
  SolverOptions options;
  options.method = kind == Kind::Multigrid ? KrylovMethod::ConjugateGradient : KrylovMethod::Direct;
  options.preconditioner = Preconditioner::BoomerAMG;
  this->Solver = std::make_unique<LinearSolver>(system, options);
  this->Solver->setUp();
  const LinearSolverState& own = this->Solver->state();
  if (own.Failure != SolveReason::Exact)
  {
    throw Error("an inner solver cannot be set up: " +
      (own.FailureText.empty() ? std::string(describe(own.Failure)) : own.FailureText));
  }
}

//------------------------------------------------------------------------------
void InnerSolver::apply(const double* r, double* z)
{
  LinearSolverState& own = this->Solver->state();
  own.requireAlive();
  const PetscScope scope(own.OptionSet.database());
  PetscVector right = own.Objects.createVector(), left = own.Objects.createVector();
  PC inner = nullptr;
  own.Objects.copyIn(r, right);
  // Only the preconditioner is applied: a multigrid cycle, or the substitutions of a factorization.
  petsc(KSPGetPC(own.Solver, &inner));
  petsc(PCApply(inner, right, left));
  own.Objects.copyOut(left, z);
}
}
