// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoopProgress.h
 * @brief The progress of the loops of a computation, for display.
 *
 * Kernel functions without a callback report their loops here; the loops of Parallel.h do so by
 * themselves. It has an effect only on a thread with a LoopProgress.
 *
 * @code
 * const tautline::LoopProgress progress([](double done) { show(done); }, 0.0, 0.5);
 * evaluateMetric(mesh, metric, options, values); // shows growing numbers, at last 0.5
 * @endcode
 * Internal: not installed.
 */
#ifndef tautline_LoopProgress_h
#define tautline_LoopProgress_h

#include "Types.h"

#include <functional>

namespace tautline
{
/**
 * @class tautline::LoopProgress
 * @brief While this object exists, the loops of this thread report. The number of loops is not
 * known in advance: each loop takes half of the remaining progress. Scopes nest; the innermost one
 * receives the reports.
 */
class TAUTLINE_KERNEL_EXPORT LoopProgress
{
public:
  /**
   * @param report receives numbers that grow from `from` to `to` (`to` is the last unless an
   * exception ends the scope); called on this thread, must not throw
   */
  explicit LoopProgress(std::function<void(double)> report, double from = 0.0, double to = 1.0);
  ~LoopProgress();
  LoopProgress(const LoopProgress&) = delete;
  LoopProgress& operator=(const LoopProgress&) = delete;

  /// For loops: the fraction done, 0 to 1. If it is smaller than before, another loop has begun.
  static void at(double done);

  /// The same for short passes: reports every 1024th.
  static void atPass(Index pass, Index passes)
  {
    constexpr Index every = 1024;
    if (pass % every == 0)
    {
      LoopProgress::at(static_cast<double>(pass) / static_cast<double>(passes));
    }
  }

  /// While this object exists, the loops of this thread are parts of an outer loop and do not
  /// report.
  class TAUTLINE_KERNEL_EXPORT Nested
  {
  public:
    Nested();
    ~Nested();
    Nested(const Nested&) = delete;
    Nested& operator=(const Nested&) = delete;

  private:
    LoopProgress* Outer;
  };

private:
  void take(double done);

  std::function<void(double)> Report;
  double From, To;       ///< of the current loop and the following ones
  double Last = 0.0;     ///< of the current loop
  double Reported = 0.0; ///< the largest number so far
  LoopProgress* Outer;
};
}
#endif
