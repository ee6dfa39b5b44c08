// SPDX-License-Identifier: BSD-3-Clause
#include "SolverOptions.h"

#include <iterator>

namespace tautline
{
namespace
{
constexpr int TableMethods = 4, TablePreconditioners = 4; // of Table 2.5
}

//------------------------------------------------------------------------------
int combinationNumber(KrylovMethod method, Preconditioner preconditioner)
{
  const int column = static_cast<int>(method), row = static_cast<int>(preconditioner);
  const bool inTable =
    column >= 0 && column < TableMethods && row >= 0 && row < TablePreconditioners;
  return inTable ? TableMethods * row + column + 1 : 0;
}

const char* nameOf(KrylovMethod method)
{
  constexpr const char* names[] = { "CG", "GMRES", "MINRES", "Bi-CGSTAB", "direct" };
  const auto number = static_cast<std::size_t>(method);
  return number < std::size(names) ? names[number] : "unknown";
}

const char* nameOf(Preconditioner preconditioner)
{
  constexpr const char* names[] = { "Jacobi", "SSOR", "ILU(0)", "BoomerAMG", "ICC(0)", "GAMG",
    "none" };
  const auto number = static_cast<std::size_t>(preconditioner);
  return number < std::size(names) ? names[number] : "unknown";
}

const char* fastMultigridOptions()
{
  return "-pc_hypre_boomeramg_coarsen_type HMIS -pc_hypre_boomeramg_interp_type ext+i "
         "-pc_hypre_boomeramg_agg_nl 1 -pc_hypre_boomeramg_P_max 4";
}

bool converged(SolveReason reason)
{
  // A switch without a default: the compiler reports a missing reason.
  switch (reason)
  {
    case SolveReason::RelativeTolerance:
    case SolveReason::AbsoluteTolerance:
    case SolveReason::Exact:
    case SolveReason::OtherConvergence:
      return true;
    case SolveReason::IterationLimit:
    case SolveReason::IndefinitePreconditioner:
    case SolveReason::IndefiniteMatrix:
    case SolveReason::Breakdown:
    case SolveReason::Diverged:
    case SolveReason::NotANumber:
    case SolveReason::PreconditionerFailed:
    case SolveReason::TimeLimit:
    case SolveReason::Aborted:
    case SolveReason::OtherFailure:
    case SolveReason::FalseConvergence:
      break;
  }
  return false;
}

const char* describe(SolveReason reason)
{
  switch (reason)
  {
    case SolveReason::RelativeTolerance:
      return "converged to the relative tolerance";
    case SolveReason::AbsoluteTolerance:
      return "converged to the absolute tolerance";
    case SolveReason::Exact:
      return "solved";
    case SolveReason::OtherConvergence:
      return "converged by the test of the PETSc options";
    case SolveReason::IterationLimit:
      return "not converged: the iteration limit was reached";
    case SolveReason::IndefinitePreconditioner:
      return "failed: the preconditioner is indefinite; try GMRES or another preconditioner";
    case SolveReason::IndefiniteMatrix:
      return "failed: the matrix is not positive definite; try MINRES or GMRES";
    case SolveReason::Breakdown:
      return "failed: the method broke down; try GMRES or another preconditioner";
    case SolveReason::Diverged:
      return "failed: the residual diverged";
    case SolveReason::NotANumber:
      return "failed: a number is infinite or not a number";
    case SolveReason::PreconditionerFailed:
      return "failed: the preconditioner or factorization could not be built";
    case SolveReason::TimeLimit:
      return "not converged: the time limit was reached";
    case SolveReason::Aborted:
      return "stopped by the user";
    case SolveReason::FalseConvergence:
      return "not converged: the method stopped, but the true residual is above the tolerance; "
             "try another solver or preconditioner, or a lower tolerance";
    case SolveReason::OtherFailure:
      break;
  }
  return "failed";
}
}
