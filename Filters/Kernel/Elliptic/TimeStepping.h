// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TimeStepping.h
 * @brief The heat equation u_t + L u = f and the wave equation u_tt + L u = f, with the elliptic
 * operator L, right-hand side and Dirichlet data of an EllipticSystem.
 *
 * Linear finite elements in space, steps of equal length in time. The step matrix and its
 * preconditioner stay the same. f and the given values do not depend on time.
 *
 * Example: 100 steps of the heat equation by the Crank-Nicolson method, from u = 0.
 *
 *     tautline::TimeOptions time;
 *     time.scheme = tautline::TimeScheme::CrankNicolson;
 *     time.step = 0.01;
 *     time.steps = 100;
 *     std::vector<double> zero(system.matrix().size, 0.0);
 *     tautline::TimeSeries series = tautline::integrate(system, time, zero, zero, {});
 */
#ifndef tautline_TimeStepping_h
#define tautline_TimeStepping_h

#include "EllipticSystem.h"

namespace tautline
{
/// The numbers are stable: ParaView state files hold them.
enum class TimeScheme : int
{
  Stationary = 0,    ///< no time: L u = f
  BackwardEuler = 1, ///< heat, order 1, L-stable
  Bdf2 = 2,          ///< heat, order 2, L-stable; the first step uses backward Euler
  CrankNicolson = 3, ///< heat, order 2, A-stable
  Newmark = 4        ///< wave, order 2: beta = 1/4, gamma = 1/2, conserves the energy
};

/// The mass matrix. The numbers are stable.
enum class MassMatrix : int
{
  Consistent = 0, ///< integrals of phi_i phi_j
  Lumped = 1      ///< the sums of its rows, on the diagonal
};

/// Steps in time.
struct TimeOptions
{
  TimeScheme scheme = TimeScheme::BackwardEuler; ///< not Stationary
  double step = 0.01;                            ///< above 0, the same for all steps
  int steps = 100;                               ///< at least 1
  MassMatrix mass = MassMatrix::Consistent;
  /// Factor of the mass matrix, above 0: density, or heat capacity.
  double density = 1.0;
  /// Whether multigrid gets the rigid body modes of an elastic body.
  bool rigidBodyModes = true;
};

/// The computed series; entry 0 is the start.
struct TimeSeries
{
  std::vector<double> times;
  std::vector<std::vector<double>> values; ///< of the unknowns of this rank
  /// Per step: the report of its linear system, without the residual norms of the iterations.
  std::vector<LinearSolution> solves;
  /// The norm of the last residual of each step, in the norm of the method.
  std::vector<double> residuals;
  /// Seconds of the preconditioners of all matrices, and of all solves.
  double setupSeconds = 0.0, solveSeconds = 0.0;
  int iterations = 0;
  /// How the last step ended; steps after one that did not converge are missing.
  SolveReason reason = SolveReason::Exact;
};

/**
 * @brief The mass matrix of the free unknowns, with the rows and columns of system.matrix(): this
 * rank's contributions. Throws Error if there is no memory.
 */
TAUTLINE_SOLVERS_EXPORT SparseMatrix massMatrix(const EllipticSystem& system, MassMatrix kind);

/// Extracts the unknowns from values at all points, 1 (elasticity: 3) each.
TAUTLINE_SOLVERS_EXPORT std::vector<double> unknownsOf(
  const EllipticSystem& system, const std::vector<double>& pointValues);

/// Throws MemoryError if there is no memory for the solution at all steps on this rank.
TAUTLINE_SOLVERS_EXPORT void requireSeriesMemory(
  const EllipticSystem& system, const TimeOptions& time);

/**
 * @brief Integrates in time. Collective. On one rank, it calls requireSeriesMemory(); several ranks
 * must call that before, and agree on the outcome.
 *
 * @param start the unknowns at time 0
 * @param velocity their derivatives at time 0, for Newmark
 * @param options for the linear systems: the time limit applies to all steps together. Each solve
 * starts from the extrapolation of the previous steps; a residual below the rounding error of the
 * largest one so far is treated as 0. The observer is called after each step with its number and
 * the norm of its residual; it returns false to end the integration.
 *
 * Throws Error for a step, a number of steps or a density out of range, and values that are not
 * finite. A step that does not converge ends the integration; its reason becomes the reason of the
 * result.
 */
TAUTLINE_SOLVERS_EXPORT TimeSeries integrate(const EllipticSystem& system, const TimeOptions& time,
  const std::vector<double>& start, const std::vector<double>& velocity,
  const SolverOptions& options);
}
#endif
