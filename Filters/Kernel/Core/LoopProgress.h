// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoopProgress.h
 * @brief How far the loops of a computation are, for those that show it.
 * Internal: not installed.
 *
 * Functions of the kernel that take no callback report their loops here; the loops of Parallel.h
 * do so by themselves. It has an effect only on a thread with a LoopProgress.
 *
 * @code
 * const tautline::LoopProgress progress([](double done) { show(done); }, 0.0, 0.5);
 * evaluateMetric(mesh, metric, options, values); // shows growing numbers, at last 0.5
 * @endcode
 */
#ifndef tautline_LoopProgress_h
#define tautline_LoopProgress_h

#include "Types.h"

#include <functional>

namespace tautline
{
/**
 * @class tautline::LoopProgress
 * @brief While it exists, the loops of this thread report. How many there will be is not known:
 * each of them stands for half of what the ones before have left. Scopes nest; the innermost one
 * receives the reports.
 */
class TAUTLINE_KERNEL_EXPORT LoopProgress
{
public:
  /**
   * @param report receives numbers that grow from `from` to `to`, which is the last one unless an
   * exception ends the scope; called by this thread, must not throw
   */
  explicit LoopProgress(std::function<void(double)> report, double from = 0.0, double to = 1.0);
  ~LoopProgress();
  LoopProgress(const LoopProgress&) = delete;
  LoopProgress& operator=(const LoopProgress&) = delete;

  /// For loops: the part that is done, 0 to 1. If it is smaller than before, another loop began.
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

  /// While it exists, the loops of this thread are parts of an outer one and do not report.
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
  double From, To;       ///< of the current loop and those that follow
  double Last = 0.0;     ///< of the current loop
  double Reported = 0.0; ///< the largest number so far
  LoopProgress* Outer;
};
}
#endif
