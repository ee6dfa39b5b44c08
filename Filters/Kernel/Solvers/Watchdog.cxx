// SPDX-License-Identifier: BSD-3-Clause
#include "Watchdog.h"

#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <iostream>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <csignal>
#include <unistd.h>

namespace tautline
{
namespace
{
class Task;

/// The thread and the data shared with it; guarded by the mutex.
struct Worker
{
  std::mutex Mutex;
  std::condition_variable Wake; // wakes the thread
  std::deque<std::shared_ptr<Task>> Queue;
  std::atomic<bool> Busy{ false };
  pid_t Process = getpid();
};

/// The task whose call is run by this thread.
thread_local Task* callOf = nullptr;

class Task : public WatchedWork
{
public:
  Task(Worker& worker, std::function<void(WatchedWork&)> work)
    : Shared(worker)
    , Work(std::move(work))
  {
  }
  bool abandoned() const override { return this->Abandoned; }
  bool inCaller(const std::function<void()>& call) override;

  /// Runs in the watchdog's thread; `lock` is held before and after.
  void run(std::unique_lock<std::mutex>& lock);
  /// Runs in the calling thread.
  WatchResult wait(std::unique_lock<std::mutex>& lock, const WatchLimits& limits);

  /// Work submitted by the calling thread from within a call, while the watchdog's thread waits.
  std::deque<std::shared_ptr<Task>> Nested;

private:
  void answer(std::unique_lock<std::mutex>& lock);
  WatchResult abandon(WatchResult reason);

  Worker& Shared;
  std::function<void(WatchedWork&)> Work;
  std::condition_variable Changed; // the calling thread waits for it
  const std::function<void()>* Call = nullptr;
  std::exception_ptr Thrown, CallThrown;
  std::atomic<bool> Abandoned{ false };
  bool Done = false;
  bool Answered = false; // whether the work has called back
};

//------------------------------------------------------------------------------
void Task::run(std::unique_lock<std::mutex>& lock)
{
  lock.unlock();
  std::exception_ptr thrown;
  try
  {
    this->Work(*this);
  }
  catch (...)
  {
    thrown = std::current_exception();
  }
  this->Work = nullptr; // destroys its data
  lock.lock();
  this->Thrown = thrown;
  this->Done = true;
  this->Changed.notify_all();
}

bool Task::inCaller(const std::function<void()>& call)
{
  std::unique_lock<std::mutex> lock(this->Shared.Mutex);
  if (this->Abandoned)
  {
    return false;
  }
  this->Call = &call;
  this->Changed.notify_all();
  // The call may submit work to this thread, which can only be done now.
  while (this->Call && !this->Abandoned)
  {
    if (!this->Nested.empty())
    {
      const std::shared_ptr<Task> nested = this->Nested.front();
      this->Nested.pop_front();
      nested->run(lock);
      continue;
    }
    this->Shared.Wake.wait(lock);
  }
  const bool made = !this->Call;
  this->Call = nullptr;
  if (const std::exception_ptr thrown = std::exchange(this->CallThrown, nullptr))
  {
    std::rethrow_exception(thrown);
  }
  return made;
}

//------------------------------------------------------------------------------
void Task::answer(std::unique_lock<std::mutex>& lock)
{
  const std::function<void()>* call = this->Call;
  Task* outer = std::exchange(callOf, this);
  lock.unlock();
  try
  {
    (*call)();
  }
  catch (...)
  {
    this->CallThrown = std::current_exception();
  }
  lock.lock();
  callOf = outer;
  this->Call = nullptr;
  this->Answered = true;
  this->Shared.Wake.notify_all();
}

WatchResult Task::abandon(WatchResult reason)
{
  this->Abandoned = true;
  for (auto* queue : { &this->Shared.Queue, callOf ? &callOf->Nested : nullptr })
  {
    if (queue)
    {
      queue->erase(std::remove_if(queue->begin(), queue->end(),
                     [this](const auto& task) { return task.get() == this; }),
        queue->end());
    }
  }
  this->Shared.Wake.notify_all();
  return reason;
}

WatchResult Task::wait(std::unique_lock<std::mutex>& lock, const WatchLimits& limits)
{
  using Seconds = std::chrono::duration<double>;
  constexpr double longest = 3600.0; // arbitrary: the loop continues
  const Stopwatch time;
  Stopwatch sinceAsked;
  const bool polls = limits.polls && interruptible();
  const bool asks = polls || limits.cancelled;
  std::optional<Stopwatch> sinceCancelled;
  while (!this->Done)
  {
    if (this->Call)
    {
      this->answer(lock);
      continue;
    }
    if (time.reached(limits.seconds))
    {
      return this->abandon(WatchResult::TimeLimit);
    }
    if (asks && sinceAsked.reached(WatchInterval))
    {
      bool stop = false;
      lock.unlock();
      try
      {
        if (polls)
        {
          throwIfInterrupted();
        }
        stop = limits.cancelled && limits.cancelled();
      }
      catch (...)
      {
        lock.lock();
        this->abandon(WatchResult::Cancelled);
        throw;
      }
      lock.lock();
      sinceAsked = Stopwatch();
      if (stop && !this->Done)
      {
        // Work that calls back is notified at its next call and ends with its best result.
        if (!sinceCancelled)
        {
          sinceCancelled.emplace();
        }
        if (!this->Answered || sinceCancelled->reached(CancelGrace))
        {
          return this->abandon(WatchResult::Cancelled);
        }
      }
      continue;
    }
    const double left = limits.seconds > 0.0 ? limits.seconds - time.seconds() : longest;
    const double next = asks ? WatchInterval - sinceAsked.seconds() : longest;
    this->Changed.wait_for(lock, Seconds(std::max(0.0, std::min({ left, next, longest }))));
  }
  if (this->Thrown)
  {
    std::rethrow_exception(this->Thrown);
  }
  return WatchResult::Finished;
}

//------------------------------------------------------------------------------
Worker*& currentWorker()
{
  // Never destroyed: the thread may outlive static objects.
  static auto* worker = new Worker;
  return worker;
}

void workForever(Worker* worker)
{
  std::unique_lock<std::mutex> lock(worker->Mutex);
  while (true)
  {
    worker->Wake.wait(lock, [&]() { return !worker->Queue.empty(); });
    std::shared_ptr<Task> task = worker->Queue.front();
    worker->Queue.pop_front();
    worker->Busy = true;
    task->run(lock);
    worker->Busy = false;
  }
}

#ifdef __GLIBC__
/// Background work uses libraries that exit() is about to destroy.
void leaveIfBusy(int status, void*)
{
  if (currentWorker()->Busy && currentWorker()->Process == getpid())
  {
    std::cout.flush();
    std::fflush(nullptr);
    _exit(status);
  }
}
#else
void waitWhileBusy()
{
  while (currentWorker()->Busy && currentWorker()->Process == getpid())
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}
#endif

/// Starts the thread; signals are handled by the other threads of the process.
void startThread(Worker* worker)
{
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try
  {
    std::thread(workForever, worker).detach();
  }
  catch (...)
  {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

/// The worker of this process, with its thread. After fork(), the child has no thread yet.
Worker& runningWorker()
{
  static std::mutex starting;
  static bool started = false;
  const std::lock_guard<std::mutex> lock(starting);
  if (started && currentWorker()->Process != getpid())
  {
    currentWorker() = new Worker;
    started = false;
  }
  if (!started)
  {
    startThread(currentWorker());
#ifdef __GLIBC__
    on_exit(leaveIfBusy, nullptr);
#else
    std::atexit(waitWhileBusy);
#endif
    started = true;
  }
  return *currentWorker();
}
}

//------------------------------------------------------------------------------
WatchResult runWatched(std::function<void(WatchedWork&)> work, const WatchLimits& limits)
{
  Worker& worker = runningWorker();
  const auto task = std::make_shared<Task>(worker, std::move(work));
  std::unique_lock<std::mutex> lock(worker.Mutex);
  (callOf ? callOf->Nested : worker.Queue).push_back(task);
  worker.Wake.notify_all();
  return task->wait(lock, limits);
}

bool insideWatchedCall()
{
  return callOf != nullptr;
}
}
