// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ConditionOptions.h
 * @brief The options of estimateCondition().
 */
#ifndef tautline_ConditionOptions_h
#define tautline_ConditionOptions_h

#include "SolverOptions.h"

namespace tautline
{
/// The methods for extreme eigenvalues. The numbers are stable: ParaView state files hold them.
enum class SpectrumMethod : int
{
  Automatic = 0,  ///< Accurate
  RitzValues = 1, ///< of the Krylov solver (CG): cheap, from inside the spectrum, no error bound
  /// To a tolerance: SLEPc for A and D^-1 A (Krylov-Schur, shift-invert if a factorization is
  /// affordable, otherwise LOBPCG), the Lanczos method in the inner product of P for other P^-1 A.
  Accurate = 2
};

/// The spectrum to estimate, the accuracy and the limits.
struct ConditionOptions
{
  SpectrumMethod method = SpectrumMethod::Automatic;
  /// None: the spectrum of A; otherwise, of P^-1 A.
  Preconditioner preconditioner = Preconditioner::None;
  double omega = 1.0; ///< of SSOR, 0 to 2 (exclusive)
  /// Relative, of each eigenvalue, 0 to 1 (exclusive); multigrid takes ten times longer for 1e-6.
  double tolerance = 1e-4;
  int maximumIterations = 10000; ///< at least 1
  /// Wall time; 0: no limit. Like SolverOptions::maximumSeconds.
  double maximumSeconds = 0.0;
  std::string petscOptions; ///< "-name value ...", like SolverOptions::petscOptions
  /// Called with the fraction done, 0 to 1, from the calling thread; the estimate stops if it
  /// returns false.
  std::function<bool(double)> progress;
  /// Whether to stop: like SolverOptions::cancelled.
  std::function<bool()> cancelled;
};
}
#endif
