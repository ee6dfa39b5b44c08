// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SolverOptions.h
 * @brief The options of linear solvers, and the result of a solve.
 */
#ifndef tautline_SolverOptions_h
#define tautline_SolverOptions_h

#include "tautline/Core/Types.h"
#include "tautline/SolversExport.h"

#include <functional>
#include <vector>

namespace tautline
{
/// The methods of section 2.5; the numbers are stable: ParaView state files store them.
enum class KrylovMethod : int
{
  ConjugateGradient = 0,
  GMRES = 1,
  MINRES = 2,
  BiCGStab = 3,
  Direct = 4 ///< a Cholesky or LU factorization; the preconditioner is not used
};

/// The preconditioners of section 2.6, and others. The numbers are stable.
enum class Preconditioner : int
{
  Jacobi = 0,
  SSOR = 1,
  ILU = 2, ///< no fill-in; on several ranks: block Jacobi with ILU(0) in each block
  BoomerAMG = 3,
  ICC = 4,  ///< incomplete Cholesky, no fill-in; on several ranks: like ILU
  GAMG = 5, ///< smoothed aggregation
  None = 6
};

/// The number of a combination in Table 2.5, 1 to 16; 0 if it is not in the table.
TAUTLINE_SOLVERS_EXPORT int combinationNumber(KrylovMethod method, Preconditioner preconditioner);
/// The usual name, "Bi-CGSTAB", "BoomerAMG", ...; "unknown" for other numbers.
TAUTLINE_SOLVERS_EXPORT const char* nameOf(KrylovMethod method);
TAUTLINE_SOLVERS_EXPORT const char* nameOf(Preconditioner preconditioner);

/**
 * @brief PETSc options that make BoomerAMG's setup and iterations several times cheaper than
 * PETSc's defaults in 3D, at the cost of a few more iterations: HMIS coarsening, aggressive on the
 * finest level, and ext+i interpolation from at most four points. For
 * SolverOptions::defaultPetscOptions. The tables of chapter 2 use PETSc's defaults.
 *
 * Source: H. De Sterck, U. M. Yang, J. J. Heys, SIAM J. Matrix Anal. Appl. 27 (2006); U. M. Yang,
 * Numer. Linear Algebra Appl. 17 (2010).
 */
TAUTLINE_SOLVERS_EXPORT const char* fastMultigridOptions();

/// The method with its tolerances and limits.
struct SolverOptions
{
  KrylovMethod method = KrylovMethod::ConjugateGradient;
  Preconditioner preconditioner = Preconditioner::BoomerAMG;
  double relativeTolerance = 1e-5;  ///< of the preconditioned residual, as PETSc measures it (2.7)
  double absoluteTolerance = 1e-50; ///< of the same residual; at least 0
  int maximumIterations = 10000;    ///< at least 0
  int restart = 30;                 ///< m of GMRES(m), at least 1
  double omega = 1.0;               ///< of SSOR, 0 to 2 (exclusive)
  /// Limit on the wall time of setUp(), and of solve() including its setup; 0: no limit. Checked
  /// between iterations. Work that cannot be interrupted, such as a factorization or the setup of
  /// multigrid, is abandoned half a second later (for longer limits, a tenth of the limit, at most
  /// 5 s) and ends in the background; see LinearSolver.
  double maximumSeconds = 0.0;
  bool initialGuess = false; ///< start from the x passed in rather than from 0
  bool ritzValues = false;   ///< estimate extreme eigenvalues of P^-1 A (CG, GMRES)
  /// PETSc options, "-ksp_rtol 1e-8 -pc_hypre_boomeramg_strong_threshold 0.5"; they take precedence
  /// over the above. Only options that choose and tune methods and preconditioners and do not read,
  /// write, or display anything are permitted; others throw Error.
  std::string petscOptions;
  /// Like petscOptions, but set by the program: the user's options take precedence, and messages do
  /// not mention these.
  std::string defaultPetscOptions;
  int threads = 0; ///< 0: all cores; used for Tautline's own computations
  /// Called with iteration and residual norm, from the calling thread; the solve stops if it
  /// returns false. On several ranks, all have an observer or none has.
  std::function<bool(int, double)> observer;
  /// Minimum wall time between two calls of the observer; 0: every iteration. If a limit is set,
  /// each call costs two thread switches.
  double observerSeconds = 0.0;
  /// Whether to stop: called about twenty times a second from the calling thread, also during a
  /// setup. On several ranks, like the observer.
  std::function<bool()> cancelled;
};

/// The reason why a solve ended. The numbers are stable.
enum class SolveReason : int
{
  RelativeTolerance = 0,
  AbsoluteTolerance = 1,
  Exact = 2,            ///< a direct solve, or nothing to do
  OtherConvergence = 3, ///< converged by a test of the PETSc options
  IterationLimit = 4,
  IndefinitePreconditioner = 5, ///< shown as '*' in Tables 2.8 to 2.12
  IndefiniteMatrix = 6,
  Breakdown = 7,
  Diverged = 8, ///< the residual diverged
  NotANumber = 9,
  PreconditionerFailed = 10, ///< zero pivot, or its setup failed
  TimeLimit = 11,
  Aborted = 12,
  OtherFailure = 13,
  /// The method reported convergence, but |b - A x| exceeds ResidualFactor times the tolerance.
  FalseConvergence = 14
};

/**
 * @brief The permitted ratio of the true residual to the tolerance.
 *
 * Methods test the preconditioned residual (2.7), which may be smaller by a factor of about the
 * condition number of the preconditioner. A solve has converged only if |b - A x| is at most
 * ResidualFactor times relativeTolerance |b| (but at most half of |b|, or the tolerance if that is
 * larger), at most ResidualFactor times absoluteTolerance, or as small as rounding allows. A method
 * whose own test is met earlier continues from there with a lower tolerance, up to four times.
 * Direct solves must reach 1e-6 |b|.
 */
constexpr double ResidualFactor = 1e3;

/// Whether a solve reached its tolerance.
TAUTLINE_SOLVERS_EXPORT bool converged(SolveReason reason);
/// A description for the user.
TAUTLINE_SOLVERS_EXPORT const char* describe(SolveReason reason);

/// The report of a solve.
struct LinearSolution
{
  SolveReason reason = SolveReason::OtherFailure;
  std::string message; ///< PETSc's message on failure, or ""
  int iterations = 0;
  double setupSeconds = 0.0; ///< of the preconditioner or factorization; 0 if it already existed
  double solveSeconds = 0.0; ///< without the setup
  /// |b - A x| / |b| of the returned x, regardless of how the solve ended; 0 if b is 0 or not
  /// finite.
  double trueResidual = 0.0;
  std::vector<double> residuals; ///< residual norms of the method; [0] is the initial norm
  /// of P^-1 A if requested and available; otherwise 0
  double ritzSmallest = 0.0, ritzLargest = 0.0;
};
}
#endif
