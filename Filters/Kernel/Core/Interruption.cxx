#include "Interruption.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <utility>

#include <csignal>

namespace tautline
{
namespace
{
using Clock = std::chrono::steady_clock;

/// How many signals have arrived. The handler may run on any thread.
std::atomic<unsigned> Signals{ 0 };
static_assert(std::atomic<unsigned>::is_always_lock_free, "a handler of signals uses it");

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
    own.sa_flags = SA_RESTART; // libraries need not expect that their calls of the system end
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

/// What a thread polls.
struct State
{
  int Scopes = 0, SignalScopes = 0;
  unsigned Seen = 0; ///< signals before the outermost scope that handles them
  bool Cancelled = false, Polling = false;
  PollScope* Innermost = nullptr;
  Clock::time_point Next; ///< when the functions are called again
};

thread_local State state;

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
  ++state.Scopes;
}

InterruptScope::~InterruptScope()
{
  if (--state.Scopes == 0)
  {
    state.Cancelled = false;
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
  , Outer(std::exchange(state.Innermost, this))
{
  state.Next = Clock::time_point(); // the first call is at once
}

PollScope::~PollScope()
{
  state.Innermost = this->Outer;
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
  if (!interruptible() || state.Polling)
  {
    return;
  }
  if (InterruptScope::interrupted())
  {
    if (std::uncaught_exceptions() == 0)
    {
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
      throw Interrupted();
    }
  }
}

bool interruptible()
{
  return state.Scopes > 0 || state.Innermost != nullptr;
}
}
