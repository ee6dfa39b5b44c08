// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Stopwatch.h
 * @brief Wall time since a start, for time limits and records. Internal: not installed.
 */
#ifndef tautline_Stopwatch_h
#define tautline_Stopwatch_h

#include <chrono>

namespace tautline
{
/// Runs from its construction on; a copy runs from the same start.
class Stopwatch
{
public:
  /// Seconds since the start.
  double seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Start).count();
  }

  /// Whether a limit in seconds is reached; 0 or less: no limit.
  bool reached(double limit) const { return limit > 0 && this->seconds() >= limit; }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point Start = Clock::now();
};
}
#endif
