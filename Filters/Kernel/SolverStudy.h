/**
 * @file SolverStudy.h
 * @brief Solves one system by many combinations of solver and preconditioner (Table 2.5) and recommends one.
 */
#ifndef tautline_SolverStudy_h
#define tautline_SolverStudy_h

#include "ConditionEstimate.h"

namespace tautline
{
struct SolverCombination
{
  KrylovMethod method = KrylovMethod::ConjugateGradient;
  Preconditioner preconditioner = Preconditioner::BoomerAMG;
  bool nearNullSpace = true; ///< elasticity with multigrid: tell it the rigid body modes
};

/// "CG + ILU(0)".
TAUTLINE_KERNEL_EXPORT std::string nameOf(const SolverCombination& combination);
/// The sixteen of Table 2.5, in its order.
TAUTLINE_KERNEL_EXPORT std::vector<SolverCombination> dissertationCombinations();

struct SolverStudyOptions
{
  std::vector<SolverCombination> combinations = dissertationCombinations();
  SolverOptions solver;        ///< the rest: tolerances, restart, omega, limits per combination
  bool conditions = true;      ///< estimate the condition of each P^-1 A by Ritz values
  int repetitions = 1;         ///< the best time of so many
  double maximumSeconds = 0.0; ///< of the whole study; 0: no limit
  std::function<bool(double)> progress;
};

struct SolverStudyRow
{
  SolverCombination combination;
  LinearSolution linear;
  double condition = 0.0;    ///< of P^-1 A, estimated; 0: not known
  double trueResidual = 0.0; ///< norm of b - A x over that of b
  bool run = false;          ///< false when the time was over before
};

struct SolverStudy
{
  std::vector<SolverStudyRow> rows;
  Index recommended = -1; ///< row; -1: none converged
  std::string why;        ///< a sentence or two for the user
};

TAUTLINE_KERNEL_EXPORT SolverStudy studySolvers(
  const EllipticSystem& system, const SolverStudyOptions& options);
}
#endif
