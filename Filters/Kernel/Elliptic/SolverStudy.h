// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SolverStudy.h
 * @brief Solves one system with many combinations of solver and preconditioner (Table 2.5) and
 * recommends one.
 */
#ifndef tautline_SolverStudy_h
#define tautline_SolverStudy_h

#include "EllipticSystem.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/// A solver and a preconditioner.
struct SolverCombination
{
  KrylovMethod method = KrylovMethod::ConjugateGradient;
  Preconditioner preconditioner = Preconditioner::BoomerAMG;
  /// Elasticity: multigrid gets the unknowns of each point as a block, and the rigid body modes.
  /// Other preconditioners do not use them.
  bool nearNullSpace = true;
};

/// "CG + ILU(0)".
TAUTLINE_SOLVERS_EXPORT std::string nameOf(const SolverCombination& combination);
/// The sixteen of Table 2.5, in its order; as there, multigrid gets only the matrix (nearNullSpace
/// = false).
TAUTLINE_SOLVERS_EXPORT std::vector<SolverCombination> dissertationCombinations();

/// The combinations to run, and the limits.
struct SolverStudyOptions
{
  std::vector<SolverCombination> combinations = dissertationCombinations();
  /**
   * @brief The remaining options: tolerances, restart, omega, limits per combination. PETSc options
   * are passed to the combinations in which they have an effect; an option without effect in all of
   * them is an error. The observer is also called, and `cancelled` ends the study.
   */
  SolverOptions solver;
  /// Estimate the condition of each P^-1 A from the Ritz values of CG, which is run additionally if
  /// it is not in the list.
  bool conditions = true;
  int repetitions = 1;         ///< the best time is used; at least 1
  double maximumSeconds = 0.0; ///< of the whole study; 0: no limit
  /// Called with the fraction done, 0 to 1; the study stops when it returns false. On several
  /// ranks, either all or none must have it.
  std::function<bool(double)> progress;
};

/// The result of one combination.
struct SolverStudyRow
{
  SolverCombination combination;
  LinearSolution linear;     ///< of the fastest repetition
  double seconds = 0.0;      ///< wall time of setup and solve; on several ranks, of the slowest
  double cpuSeconds = 0.0;   ///< corresponding CPU time of this process, all threads
  double condition = 0.0;    ///< of P^-1 A, estimated from inside its spectrum; 0: not estimated
  double trueResidual = 0.0; ///< norm of b - A x over the norm of b
  bool run = false;          ///< false if the study ended before it
};

/// The results of all combinations, and a recommendation.
struct SolverStudy
{
  std::vector<SolverStudyRow> rows; ///< one per combination
  Index recommended = -1;           ///< the fastest that converged; -1: none did
  /// The number of others that took the same time up to noise: a tenth or a millisecond more. If
  /// above 0, the recommendation is not clear, and `why` begins with this remark.
  Index ties = 0;
  std::string why; ///< a few sentences for the user
  bool aborted = false, timeLimit = false;
};

/**
 * @brief Solves the system with each combination, starting from 0. Collective over the ranks.
 * Failures are reasons in their rows; invalid options throw Error.
 */
TAUTLINE_SOLVERS_EXPORT SolverStudy studySolvers(
  const EllipticSystem& system, const SolverStudyOptions& options = {});
}
#endif
