/**
 * @file SolverStudy.h
 * @brief Solves one system by many combinations of solver and preconditioner (Table 2.5) and
 * recommends one.
 */
#ifndef tautline_SolverStudy_h
#define tautline_SolverStudy_h

#include "EllipticSystem.h"
#include "tautline/SolversExport.h"

namespace tautline
{
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
/// The sixteen of Table 2.5, in its order; as there, multigrid only sees the matrix (nearNullSpace
/// = false).
TAUTLINE_SOLVERS_EXPORT std::vector<SolverCombination> dissertationCombinations();

struct SolverStudyOptions
{
  std::vector<SolverCombination> combinations = dissertationCombinations();
  /**
   * @brief The rest: tolerances, restart, omega, limits per combination. PETSc options go to the
   * combinations in which they have an effect; one that has none in any of them is an error. The
   * observer is called, too.
   */
  SolverOptions solver;
  /// Estimate the condition of each P^-1 A by the Ritz values of CG, which is run besides where it
  /// is not in the list.
  bool conditions = true;
  int repetitions = 1;         ///< the best time of so many
  double maximumSeconds = 0.0; ///< of the whole study; 0: no limit
  /// Called with the fraction done, 0 to 1; the study stops when it returns false. On several ranks
  /// all have one or none has.
  std::function<bool(double)> progress;
};

struct SolverStudyRow
{
  SolverCombination combination;
  LinearSolution linear;     ///< of the fastest repetition
  double seconds = 0.0;      ///< set-up and solve, as time passes; of several ranks the slowest
  double cpuSeconds = 0.0;   ///< what this process computed for that, on all threads
  double condition = 0.0;    ///< of P^-1 A, estimated from inside its spectrum; 0: not known
  double trueResidual = 0.0; ///< norm of b - A x over that of b
  bool run = false;          ///< false when the time was over before, or the study was stopped
};

struct SolverStudy
{
  std::vector<SolverStudyRow> rows; ///< one per combination
  Index recommended = -1;           ///< the fastest that converged; -1: none did
  std::string why;                  ///< a few sentences for the user
  bool aborted = false, timeLimit = false;
};

/**
 * @brief Solves the system by each combination, from 0. Collective over the ranks. Failures are
 * reasons of their rows; bad options throw Error.
 */
TAUTLINE_SOLVERS_EXPORT SolverStudy studySolvers(
  const EllipticSystem& system, const SolverStudyOptions& options = {});
}
#endif
