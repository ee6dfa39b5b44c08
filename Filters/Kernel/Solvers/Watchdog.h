// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Watchdog.h
 * @brief Work that cannot be interrupted, under a time limit: it runs in a thread of its own while
 * the caller waits for it, and the caller may stop waiting.
 * Internal: not installed.
 *
 * There is one such thread, started at first use; work is done in the order of the calls. Work that
 * nobody waits for any more goes on in the background until it ends by itself; what is given later
 * waits for it, under its own limits. If the process ends meanwhile, it ends at once: the handlers
 * and destructors that exit() would still call are skipped, because the work may use what they
 * destroy.
 *
 * Cost: two switches between threads per call of runWatched() and of WatchedWork::inCaller().
 */
#ifndef tautline_Watchdog_h
#define tautline_Watchdog_h

#include "tautline/Core/Interruption.h"

#include "tautline/SolversExport.h"

#include <functional>
#include <memory>

namespace tautline
{
/// When to stop waiting.
struct WatchLimits
{
  double seconds = 0.0; ///< wall time from the call on; 0: no limit
  /// Whether the user has cancelled. Asked every WatchInterval seconds, from the waiting thread;
  /// what it throws ends the waiting, too. Work that has called back gets CancelGrace to end.
  std::function<bool()> cancelled;
  /// Whether the waiting thread calls throwIfInterrupted(), which ends the waiting, too.
  bool polls = true;

  bool any() const
  {
    return this->seconds > 0.0 || this->cancelled || (this->polls && interruptible());
  }
};

/// Seconds between two questions whether the user has cancelled.
constexpr double WatchInterval = 0.05;

/// Seconds that work which has called back may take to end by itself after the user has cancelled.
constexpr double CancelGrace = 0.5;

/// How waiting ended.
enum class WatchResult
{
  Finished,
  TimeLimit,
  Cancelled
};

/**
 * @class tautline::WatchedWork
 * @brief What the work knows of the thread that waits for it.
 */
class TAUTLINE_SOLVERS_EXPORT WatchedWork
{
public:
  virtual ~WatchedWork() = default;
  /// Whether nobody waits any more: the work should end soon. Any thread may ask.
  virtual bool abandoned() const = 0;
  /**
   * @brief Runs a call in the waiting thread and waits for its end; what it throws is thrown here.
   * The call may give further work to runWatched().
   * @return false if nobody waits any more: the call was not made
   */
  virtual bool inCaller(const std::function<void()>& call) = 0;
};

/**
 * @brief Runs work in the watchdog's thread, and returns when it has finished, when the time is
 * over, or when the user has cancelled. Throws what the work throws.
 * @param work owns all it uses (results too, by shared pointers that the caller keeps): unless the
 * result is Finished it may still run, or never have started
 */
TAUTLINE_SOLVERS_EXPORT WatchResult runWatched(
  std::function<void(WatchedWork&)> work, const WatchLimits& limits);

/// Whether this thread is inside a call of WatchedWork::inCaller(): the watchdog's thread waits for
/// it.
TAUTLINE_SOLVERS_EXPORT bool insideWatchedCall();
}
#endif
