// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Watchdog.h
 * @brief Work that cannot be interrupted, under a time limit: it runs in a separate thread while
 * the caller waits for it, and the caller may stop waiting.
 *
 * There is one such thread, started at first use; work is done in the order of the calls. Abandoned
 * work continues in the background until it ends by itself; work submitted later waits for it,
 * under its own limits. If the process ends in the meantime, it ends immediately: the remaining
 * handlers and destructors of exit() are skipped because the work may use the objects they destroy.
 *
 * Cost: two thread switches per call of runWatched() and of WatchedWork::inCaller().
 * Internal: not installed.
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
  double seconds = 0.0; ///< wall time since the call; 0: no limit
  /// Whether the user has cancelled. Called every WatchInterval seconds from the waiting thread; an
  /// exception also ends the waiting. Work that has called back gets CancelGrace seconds to end.
  std::function<bool()> cancelled;
  /// Whether the waiting thread calls throwIfInterrupted(), which also ends the waiting.
  bool polls = true;

  bool any() const
  {
    return this->seconds > 0.0 || this->cancelled || (this->polls && interruptible());
  }
};

/// Seconds between two checks whether the user has cancelled.
constexpr double WatchInterval = 0.05;

/// Seconds that work which has called back may take to end after the user has cancelled.
constexpr double CancelGrace = 0.5;

/// The reason why waiting ended.
enum class WatchResult
{
  Finished,
  TimeLimit,
  Cancelled
};

/**
 * @class tautline::WatchedWork
 * @brief The interface between the work and the thread waiting for it.
 */
class TAUTLINE_SOLVERS_EXPORT WatchedWork
{
public:
  virtual ~WatchedWork() = default;
  /// Whether the caller has stopped waiting, so that the work should end soon. Any thread may call
  /// this.
  virtual bool abandoned() const = 0;
  /**
   * @brief Runs a call in the waiting thread and waits for its end; its exceptions are rethrown
   * here. The call may pass further work to runWatched().
   * @return false if the caller has stopped waiting: the call was not made
   */
  virtual bool inCaller(const std::function<void()>& call) = 0;
};

/**
 * @brief Runs work in the watchdog's thread, and returns when it has finished, when the time limit
 * is reached, or when the user has cancelled. Rethrows exceptions of the work.
 * @param work must own all data it uses (including results, through shared pointers that the caller
 * keeps): unless the result is Finished, it may still be running or may never have started
 */
TAUTLINE_SOLVERS_EXPORT WatchResult runWatched(
  std::function<void(WatchedWork&)> work, const WatchLimits& limits);

/// Whether this thread is inside a call of WatchedWork::inCaller(), for which the watchdog's thread
/// is waiting.
TAUTLINE_SOLVERS_EXPORT bool insideWatchedCall();
}
#endif
