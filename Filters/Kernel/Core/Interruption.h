// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Interruption.h
 * @brief How long computations are ended from outside: by Ctrl-C, by request, or by a time limit.
 *
 * Long computations call throwIfInterrupted() at least every tenth of a second where possible. The
 * loops of Parallel.h, the iterations and factorizations of the linear solvers, and everything that
 * waits for a watchdog do so. The call has an effect on a thread with an InterruptScope or a
 * PollScope (a thread that calls the kernel) and, once this thread is interrupted, on the workers
 * of its loops; elsewhere it costs two comparisons.
 *
 * An interruption is not an error: the result is discarded, and handlers that turn an Error into a
 * message, a warning, or a partial result do not catch it.
 *
 * @code
 * const tautline::InterruptScope scope; // from here on, SIGINT sets a flag
 * try
 * {
 *   tautline::optimize(mesh, options);
 * }
 * catch (const tautline::Interrupted&)
 * {
 *   // nothing was changed
 * }
 * @endcode
 */
#ifndef tautline_Interruption_h
#define tautline_Interruption_h

#include "Types.h"

#include <functional>

namespace tautline
{
/**
 * @brief Thrown where a computation is interrupted. Not derived from Error or std::exception, so
 * that their handlers do not treat it as a failure.
 */
struct Interrupted
{
};

/**
 * @class tautline::InterruptScope
 * @brief While this object exists, the computations of its thread can be interrupted. Scopes nest;
 * an interruption lasts until the outermost scope of the thread ends. Not for runs on several
 * processes: if one process ends alone, the others keep waiting.
 */
class TAUTLINE_KERNEL_EXPORT InterruptScope
{
public:
  /**
   * @param handleSignal whether SIGINT interrupts while any such scope exists; the previous handler
   * is restored with the last scope. A signal that the process ignores stays ignored. Without it,
   * only cancel() interrupts.
   */
  explicit InterruptScope(bool handleSignal = true);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// Interrupts the computations of this thread. No effect without a scope.
  static void cancel();
  /// Whether SIGINT has arrived in a scope of this thread that handles it.
  static bool signalled();
  /// Whether the computations of this thread are interrupted, by a signal or by cancel().
  static bool interrupted();

private:
  bool Handles;
};

/**
 * @class tautline::PollScope
 * @brief While this object exists, throwIfInterrupted() on this thread calls a function
 * periodically, for example to end the computation at a deadline. Scopes nest: all functions are
 * called.
 */
class TAUTLINE_KERNEL_EXPORT PollScope
{
public:
  /// Seconds between two calls.
  static constexpr double Interval = 0.1;

  /// @param poll throws to end the computation; may itself compute and is not called recursively
  explicit PollScope(std::function<void()> poll);
  ~PollScope();
  PollScope(const PollScope&) = delete;
  PollScope& operator=(const PollScope&) = delete;

  /// Calls the functions of this scope and of the enclosing scopes, the outermost first.
  void call() const;

private:
  std::function<void()> Poll;
  PollScope* Outer;
};

/**
 * @brief Throws Interrupted if the computations of this thread are interrupted, or, on a worker, if
 * the computations of the caller of its loop are. Propagates exceptions from PollScope functions.
 * Has no effect during stack unwinding.
 */
TAUTLINE_KERNEL_EXPORT void throwIfInterrupted();

/// The same for loops of short passes: only with every 4096th pass, by its number.
inline void pollInterruption(Index pass)
{
  constexpr Index every = 4096;
  if (pass % every == 0)
  {
    throwIfInterrupted();
  }
}

/**
 * @brief For tests that detect loops without polls: starts or ends measuring how long threads with
 * a scope compute without calling throwIfInterrupted(). Discards earlier measurements.
 */
TAUTLINE_KERNEL_EXPORT void measurePolls(bool measure);

/**
 * @brief The longest time that a thread has computed between two polls, or between a poll and the
 * start or end of its outermost scope, since measurePolls(true). In CPU seconds of the thread:
 * excludes waiting, other processes, and the time after an interruption.
 */
TAUTLINE_KERNEL_EXPORT double longestUnpolledSeconds();

/// Whether throwIfInterrupted() can have an effect on this thread, which is not a worker: if so,
/// work that cannot call it needs a watchdog.
TAUTLINE_KERNEL_EXPORT bool interruptible();
}
#endif
