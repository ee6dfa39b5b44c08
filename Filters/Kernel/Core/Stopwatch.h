// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Stopwatch.h
 * @brief Wall time since a start, for time limits and records; CPU time of a thread.
 * Internal: not installed.
 */
#ifndef tautline_Stopwatch_h
#define tautline_Stopwatch_h

#include <chrono>
#include <ctime>

namespace tautline
{
/// Starts at its construction; a copy has the same start.
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

/// CPU time of the calling thread.
inline double threadSeconds()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  constexpr double nano = 1e-9;
  return static_cast<double>(time.tv_sec) + nano * static_cast<double>(time.tv_nsec);
}
}
#endif
