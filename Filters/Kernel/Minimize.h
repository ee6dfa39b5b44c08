/**
 * @file Minimize.h
 * @brief Minimises a smooth function of many variables: nonlinear conjugate gradients, L-BFGS, truncated
 * Newton. Internal: not installed.
 */
#ifndef tautline_Minimize_h
#define tautline_Minimize_h

#include "Optimize.h"

#include <functional>
#include <vector>

namespace tautline
{
/// A function to be minimised, on the side of the barrier where the start is.
class SmoothFunction
{
public:
  virtual ~SmoothFunction() = default;
  virtual std::size_t size() const = 0;
  /// The value at x; +infinity where x is not allowed (an element would invert).
  virtual double value(const double* x) = 0;
  /// The value and the gradient at an allowed x.
  virtual double valueAndGradient(const double* x, double* gradient) = 0;
  /**
   * @brief The largest step t in (0, wanted] for which x + t d is certainly allowed, or `wanted` if
   * not known: value() then decides.
   */
  virtual double largestStep(const double* /*x*/, const double* /*d*/, double wanted)
  {
    return wanted;
  }
  /// Applies a symmetric positive definite approximation of the inverse Hessian; returns false if there is none.
  virtual bool precondition(const double* /*r*/, double* /*z*/) { return false; }
  /// Makes ready for hessianTimes() and precondition() at x; called at most once per iteration.
  virtual void linearize(const double* /*x*/) {}
  /// The product of a positive semidefinite approximation of the Hessian with d; false if there is none.
  virtual bool hessianTimes(const double* /*d*/, double* /*product*/) { return false; }
};

struct MinimizeOptions
{
  Optimizer method = Optimizer::LimitedMemoryBFGS; ///< a global one
  int maximumIterations = 100;
  double gradientNorm = 1e-6;  ///< relative to the first; 0: never
  double relativeChange = 0.0; ///< of the value in an iteration; 0: never
  int threads = 0;
  /// After each iteration: iteration, value, gradient norm, x. Returns false to stop.
  std::function<bool(int, double, double, const double*)> observer;
};

struct Minimization
{
  double value = 0;
  double gradientNorm = 0;
  int iterations = 0;
  int evaluations = 0;
  StopReason reason = StopReason::IterationLimit; ///< Aborted if the observer said so
};

/// Minimises from x, which is overwritten by the best found. Never returns a larger value than at the start.
Minimization minimize(SmoothFunction& function, double* x, const MinimizeOptions& options);
}
#endif
