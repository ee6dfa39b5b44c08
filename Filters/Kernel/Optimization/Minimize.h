// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Minimize.h
 * @brief Minimizes a smooth function of many variables: nonlinear conjugate gradients, L-BFGS,
 * truncated Newton.
 * Internal: not installed.
 *
 * Every accepted step reduces the value (Armijo) and satisfies the weak Wolfe condition, for
 * conjugate gradients the strong one, unless largestStep() ends it before. Sources: J. Nocedal and
 * S. J. Wright, "Numerical Optimization", 2nd ed. 2006, sections 3.5 (line search), 5.2
 * (Fletcher-Reeves, Polak-Ribiere+), 7.1 (truncated Newton), 7.2 (L-BFGS); S. G. Nash and A. Sofer,
 * "Assessing a search direction within a truncated-Newton method", Oper. Res. Lett. 9 (1990).
 */
#ifndef tautline_Minimize_h
#define tautline_Minimize_h

#include "OptimizeOptions.h"
#include "tautline/Core/RankGroup.h"

#include <functional>
#include <vector>

namespace tautline
{
/// A function to minimize, on the side of the barrier that contains the start.
class SmoothFunction
{
public:
  virtual ~SmoothFunction() = default;
  virtual std::size_t size() const = 0;
  /**
   * @brief The value and the gradient at x; +infinity if x is not allowed (an element would
   * invert); the gradient is then ignored. The minimizer obtains values only from this function.
   */
  virtual double valueAndGradient(const double* x, double* gradient) = 0;
  /**
   * @brief The largest step t in (0, wanted] for which x + t d is certainly allowed, or `wanted` if
   * unknown: the value then limits the step. Longer steps are not tried. Called once per iteration.
   */
  virtual double largestStep(const double* /*x*/, const double* /*d*/, double wanted)
  {
    return wanted;
  }
  /// Applies a symmetric positive definite approximation of the inverse Hessian; returns false if
  /// there is none.
  virtual bool precondition(const double* /*r*/, double* /*z*/) { return false; }
  /**
   * @brief Prepares hessianTimes() and precondition() at x, where the last gradient was computed.
   * Called before every direction of NewtonConjugateGradient; for the other methods, called at
   * iterations 0, 1, 3, 9 and so on, at most MinimizeOptions::refresh iterations apart. L-BFGS then
   * discards its pairs, if there is a preconditioner.
   */
  virtual void linearize(const double* /*x*/) {}
  /// The product of the Hessian, which may be indefinite, with d; false if there is none.
  virtual bool hessianTimes(const double* /*d*/, double* /*product*/) { return false; }
};

struct MinimizeOptions
{
  Optimizer method = Optimizer::LimitedMemoryBFGS; ///< a global one
  int maximumIterations = 100;
  double gradientNorm = 1e-6;  ///< relative to the first; 0: never
  double relativeChange = 0.0; ///< of the value in an iteration; 0: never
  /**
   * @brief Half of the squared Newton decrement, g H^-1 g / 2, estimates the distance of the value
   * from its minimum, independently of the start (S. Boyd and L. Vandenberghe, "Convex
   * Optimization", 2004, section 9.5.1). NewtonConjugateGradient stops after a step whose model
   * predicted less than this, relative to the value. The other methods only have estimates of H^-1:
   * if these predict more, gradientNorm and relativeChange do not stop them, unless the prediction
   * is within the rounding of the first value. 0: not used.
   */
  double decrement = 0.0;
  /**
   * @brief NewtonConjugateGradient: stop (NoProgress) if 20 iterations have reduced the value by
   * less than this fraction although more is predicted; 0: never.
   */
  double leastGain = 0.0;
  /// Polled between the inner iterations of Newton's method: true ends them with the current
  /// result.
  std::function<bool()> outOfTime;
  int refresh = 20; ///< maximum number of iterations between calls of linearize(); at least 1
  int threads = 0;  ///< 0: all cores. The result does not depend on it.
  /**
   * @brief Null, or ranks that each have some of the variables and call minimize() together. The
   * methods of the function are then collective and must return the same value on all ranks, as
   * must outOfTime and the observer. The sums are rounded once, independently of the ranks.
   */
  RankGroup* group = nullptr;
  /// After each iteration: iteration, value, gradient norm, x. Returns false to stop.
  std::function<bool(int, double, double, const double*)> observer;
};

struct MinimizeResult
{
  double value = 0;
  double gradientNorm = 0;
  int iterations = 0;
  int evaluations = 0;                            ///< of the value and gradient
  StopReason reason = StopReason::IterationLimit; ///< Aborted if the observer stopped it
};

/**
 * @brief Minimizes from x, which is overwritten by the best point found; it is never worse than the
 * start. If the start is not allowed, nothing is done (NoProgress, value +infinity); without
 * variables: NoFreeVertices.
 */
TAUTLINE_KERNEL_EXPORT MinimizeResult minimize(
  SmoothFunction& function, double* x, const MinimizeOptions& options);
}
#endif
