// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Interruption.h
 * @brief How long computations are ended from outside: by Ctrl-C, on request, by a time limit.
 *
 * Long computations call throwIfInterrupted() at least every tenth of a second where they can. The
 * loops of Parallel.h, the iterations and factorizations of the linear solvers and everything that
 * waits for a watchdog do. It has an effect on a thread with an InterruptScope or a PollScope,
 * which is a thread that calls the kernel, and on the workers of its loops once it is interrupted;
 * elsewhere it costs two comparisons.
 *
 * An interruption is not an error: the result is of no interest, and what would turn an Error into
 * a message, a warning or a partial result does not see it.
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
 * that no handler of these takes it for a failure.
 */
struct Interrupted
{
};

/**
 * @class tautline::InterruptScope
 * @brief While it exists, this thread's computations can be interrupted. Scopes nest; an
 * interruption lasts until the outermost one of the thread ends. Not for runs on several processes:
 * one that ends alone leaves the others waiting.
 */
class TAUTLINE_KERNEL_EXPORT InterruptScope
{
public:
  /**
   * @param handleSignal whether SIGINT interrupts, as long as any such scope exists; the handler
   * that was there before is restored with the last one. A signal that the process ignores stays
   * ignored. Without it, only cancel() interrupts.
   */
  explicit InterruptScope(bool handleSignal = true);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// Interrupts the computations of this thread. No effect without a scope.
  static void cancel();
  /// Whether SIGINT has arrived in a scope of this thread that handles it.
  static bool signalled();
  /// Whether the computations of this thread are interrupted, by either.
  static bool interrupted();

private:
  bool Handles;
};

/**
 * @class tautline::PollScope
 * @brief While it exists, throwIfInterrupted() on this thread calls a function from time to time,
 * for instance to end the computation at a deadline. Scopes nest: all functions are called.
 */
class TAUTLINE_KERNEL_EXPORT PollScope
{
public:
  /// Seconds between two calls.
  static constexpr double Interval = 0.1;

  /// @param poll ends the computation by what it throws; may itself compute, without being called
  explicit PollScope(std::function<void()> poll);
  ~PollScope();
  PollScope(const PollScope&) = delete;
  PollScope& operator=(const PollScope&) = delete;

  /// Calls the functions of this scope and of those around it, the outermost first.
  void call() const;

private:
  std::function<void()> Poll;
  PollScope* Outer;
};

/**
 * @brief Throws Interrupted if the computations of this thread are interrupted, or on a worker
 * those of its loop's caller, and what a function of a PollScope throws. Has no effect while
 * another exception is on its way.
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
 * @brief For tests, which find loops without a poll by it: begins to measure how long threads with
 * a scope compute without calling throwIfInterrupted(), or ends it. Forgets what was measured.
 */
TAUTLINE_KERNEL_EXPORT void measurePolls(bool measure);

/**
 * @brief The longest time that a thread has computed between two polls, from the begin of its
 * outermost scope or to its end, since measurePolls(true). CPU seconds of that thread: neither
 * waiting nor other processes count, nor what follows an interruption.
 */
TAUTLINE_KERNEL_EXPORT double longestUnpolledSeconds();

/// Whether throwIfInterrupted() can have an effect on this thread, which is no worker: then work
/// that cannot call it is worth a watchdog.
TAUTLINE_KERNEL_EXPORT bool interruptible();
}
#endif
