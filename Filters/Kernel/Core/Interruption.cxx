// SPDX-License-Identifier: BSD-3-Clause
#include "Interruption.h"

#include "LoopInterruption.h"
#include "Stopwatch.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <utility>

#include <csignal>
#include <ctime>

namespace tautline
{
namespace
{
using Clock = std::chrono::steady_clock;

/// How many signals have arrived. The handler may run on any thread.
std::atomic<unsigned> Signals{ 0 };
static_assert(std::atomic<unsigned>::is_always_lock_free, "used by a signal handler");

/// The handler of SIGINT and the scopes that need it.
struct Handler
{
  std::mutex Mutex;
  int Scopes = 0;
  bool Installed = false;
  struct sigaction Before = {};
};

Handler& handler()
{
  static auto* const only = new Handler; // threads may outlive static objects
  return *only;
}

void takeSignal(int)
{
  Signals.fetch_add(1, std::memory_order_relaxed);
}

void addHandler()
{
  Handler& shared = handler();
  const std::lock_guard<std::mutex> lock(shared.Mutex);
  if (shared.Scopes++ > 0)
  {
    return;
  }
  sigaction(SIGINT, nullptr, &shared.Before);
  const bool ignored =
    !(shared.Before.sa_flags & SA_SIGINFO) && shared.Before.sa_handler == SIG_IGN;
  if (!ignored)
  {
    struct sigaction own = {};
    own.sa_handler = takeSignal;
    sigemptyset(&own.sa_mask);
    own.sa_flags = SA_RESTART; // libraries may not handle interrupted system calls
    shared.Installed = sigaction(SIGINT, &own, nullptr) == 0;
  }
}

void removeHandler()
{
  Handler& shared = handler();
  const std::lock_guard<std::mutex> lock(shared.Mutex);
  if (--shared.Scopes == 0 && std::exchange(shared.Installed, false))
  {
    sigaction(SIGINT, &shared.Before, nullptr);
  }
}

/// The polling state of a thread.
struct State
{
  int Scopes = 0, SignalScopes = 0;
  unsigned Seen = 0; ///< signals before the outermost scope that handles them
  bool Cancelled = false, Polling = false;
  PollScope* Innermost = nullptr;
  Clock::time_point Next; ///< when the functions are called again
  double LastPoll = 0;    ///< CPU seconds of the thread; only while polls are measured
};

thread_local State state;

/// The state of measurePolls(), for all threads.
std::atomic<bool> Measuring{ false };
std::atomic<double> LongestUnpolled{ 0.0 };

/// Starts measuring at the start of the outermost scope and after intervals that do not count.
void beginUnpolled()
{
  if (Measuring.load(std::memory_order_relaxed))
  {
    state.LastPoll = threadSeconds();
  }
}

/// Excludes the time until the next poll: unwinding after an interruption frees memory and cannot
/// poll.
void leaveUnpolled()
{
  state.LastPoll = std::numeric_limits<double>::infinity();
}

/// Records the time since the last poll.
void endUnpolled()
{
  if (!Measuring.load(std::memory_order_relaxed))
  {
    return;
  }
  const double now = threadSeconds(), unpolled = now - state.LastPoll;
  state.LastPoll = now;
  double longest = LongestUnpolled.load();
  while (unpolled > longest && !LongestUnpolled.compare_exchange_weak(longest, unpolled))
  {
  }
}

bool signalArrived()
{
  return state.SignalScopes > 0 && Signals.load(std::memory_order_relaxed) != state.Seen;
}

/// The functions of the scopes do not interrupt themselves.
struct Polling
{
  Polling() { state.Polling = true; }
  ~Polling()
  {
    constexpr std::chrono::duration<double> interval(PollScope::Interval);
    state.Polling = false;
    state.Next = Clock::now() + std::chrono::duration_cast<Clock::duration>(interval);
    if (std::uncaught_exceptions() > 0)
    {
      leaveUnpolled();
    }
    else
    {
      beginUnpolled();
    }
  }
};
}

//------------------------------------------------------------------------------
InterruptScope::InterruptScope(bool handleSignal)
  : Handles(handleSignal)
{
  if (this->Handles)
  {
    if (state.SignalScopes++ == 0)
    {
      state.Seen = Signals.load(std::memory_order_relaxed);
    }
    addHandler();
  }
  if (!interruptible())
  {
    beginUnpolled();
  }
  ++state.Scopes;
}

InterruptScope::~InterruptScope()
{
  if (--state.Scopes == 0)
  {
    state.Cancelled = false;
  }
  if (!interruptible())
  {
    endUnpolled();
  }
  if (this->Handles)
  {
    --state.SignalScopes;
    removeHandler();
  }
}

void InterruptScope::cancel()
{
  state.Cancelled = state.Scopes > 0;
}

bool InterruptScope::signalled()
{
  return signalArrived();
}

bool InterruptScope::interrupted()
{
  return state.Cancelled || signalArrived();
}

//------------------------------------------------------------------------------
PollScope::PollScope(std::function<void()> poll)
  : Poll(std::move(poll))
  , Outer(state.Innermost)
{
  if (!interruptible())
  {
    beginUnpolled();
  }
  state.Innermost = this;
  state.Next = Clock::time_point(); // the first call is at once
}

PollScope::~PollScope()
{
  state.Innermost = this->Outer;
  if (!interruptible())
  {
    endUnpolled();
  }
}

void PollScope::call() const
{
  if (this->Outer)
  {
    this->Outer->call();
  }
  this->Poll();
}

//------------------------------------------------------------------------------
void throwIfInterrupted()
{
  if (callerIsInterrupted() && std::uncaught_exceptions() == 0)
  {
    throw Interrupted(); // ends this worker's chunk; the loop rethrows the exception of its caller
  }
  if (!interruptible() || state.Polling)
  {
    return;
  }
  endUnpolled();
  if (InterruptScope::interrupted())
  {
    if (std::uncaught_exceptions() == 0)
    {
      leaveUnpolled();
      throw Interrupted();
    }
    return;
  }
  if (state.Innermost && std::uncaught_exceptions() == 0 && Clock::now() >= state.Next)
  {
    {
      const Polling polling;
      state.Innermost->call();
    }
    if (InterruptScope::interrupted())
    {
      leaveUnpolled();
      throw Interrupted();
    }
  }
}

void measurePolls(bool measure)
{
  LongestUnpolled = 0.0;
  Measuring = measure;
  state.LastPoll = threadSeconds(); // of scopes that exist already
}

double longestUnpolledSeconds()
{
  return LongestUnpolled;
}

bool interruptible()
{
  return state.Scopes > 0 || state.Innermost != nullptr;
}
}
