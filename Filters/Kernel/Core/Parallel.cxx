// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel.h"

#include "Interruption.h"
#include "LoopInterruption.h"
#include "LoopProgress.h"
#include "MachineLoad.h"
#include "Stopwatch.h"

#include <pthread.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <limits>
#include <map>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>

#include <ctime>

namespace tautline
{
namespace
{
/// How long the caller spins for the end of the last chunks before it sleeps: about the wake-up
/// time of a thread.
constexpr std::chrono::microseconds SpinTime(20);
constexpr std::chrono::milliseconds PollInterval(50); // of a caller that waits for a long chunk
/// The flag of the loop that this worker thread helps with; null on other threads.
thread_local const std::atomic<bool>* interruptedCaller = nullptr;
constexpr int PausesPerLook = 16;
/// The minimum duration in seconds of a loop that gets workers even on a busy machine.
constexpr double ManySlices = 0.3;

void pauseBriefly()
{
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// All threads of the process, or the number in OMP_NUM_THREADS if it is smaller.
int allThreads()
{
  static const int wanted = []
  {
    const char* text = std::getenv("OMP_NUM_THREADS");
    const int number = text ? std::atoi(text) : 0;
    return number > 0 ? number : std::numeric_limits<int>::max();
  }();
  return std::min(wanted,
    static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
}

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}

/// Whether the machine is so busy that each thread gets at most half a core.
bool isCrowded()
{
  constexpr int threadsPerCore = 2;
  return runnableThreads() > threadsPerCore * allThreads();
}

//------------------------------------------------------------------------------
/**
 * The statistics of a thread about its loops. A worker pays off only in a loop that takes longer
 * than starting the worker. If other processes compete for the cores, a worker often loses its core
 * within a chunk, and the caller waits for a time slice of each competitor: then only loops that
 * are longer than many time slices get workers.
 */
class Experience
{
public:
  /// The expected seconds of a loop without workers.
  double expected(ChunkWork::Function function, Index chunks) const
  {
    constexpr double unknown = 1e-3;
    const auto found = this->ChunkSeconds.find(function);
    return found == this->ChunkSeconds.end() ? unknown
                                             : found->second * static_cast<double>(chunks);
  }

  /// Whether a loop need not be measured: the time of its chunks is known, and workers would not
  /// help. On a crowded machine, measuring costs time: when a thread queries its CPU time, Linux
  /// ends an expired time slice immediately instead of at the next tick.
  bool measuredEnough(ChunkWork::Function function) const
  {
    return this->Crowded && this->ChunkSeconds.count(function) > 0;
  }

  /// Whether a loop is too short for workers to pay off.
  static bool brief(double expected)
  {
    constexpr double start = 20e-6;
    return expected < start;
  }

  /// Whether to invite workers for a loop that is not brief.
  bool inviteWorkers(double expected)
  {
    constexpr double share = 0.4, enough = 1e-3;
    constexpr std::chrono::milliseconds interval(20);
    if (expected > ManySlices)
    {
      return true;
    }
    // A thread that has slept gets a core immediately even on a busy machine, so its measured share
    // is not sufficient.
    if (const Clock::time_point now = Clock::now(); now >= this->NextLook)
    {
      this->Crowded = isCrowded();
      this->NextLook = now + interval;
    }
    return !this->Crowded && (this->Passed <= enough || this->Computed >= share * this->Passed);
  }

  /// Records the CPU seconds of the caller in a loop.
  void addChunks(ChunkWork::Function function, Index chunks, double computed)
  {
    if (chunks > 0)
    {
      const double chunk = computed / static_cast<double>(chunks);
      const auto [place, isNew] = this->ChunkSeconds.emplace(function, chunk);
      constexpr double weight = 0.25; // of the newest loop
      place->second += isNew ? 0.0 : weight * (chunk - place->second);
    }
  }

  /// Records the elapsed seconds, and how many of them the caller had a core.
  void addTime(double computed, double passed)
  {
    constexpr double memory = 0.2; // seconds
    const double fading = std::exp(-passed / memory);
    this->Computed = fading * this->Computed + computed;
    this->Passed = fading * this->Passed + passed;
  }

private:
  std::unordered_map<ChunkWork::Function, double> ChunkSeconds; ///< by chunk function
  double Computed = 0, Passed = 0;                              ///< in loops, with decaying weights
  Clock::time_point NextLook;                                   ///< at the load of the machine
  bool Crowded = false;
};

//------------------------------------------------------------------------------
/**
 * A running loop. A worker that arrives late finds no chunk left. Workers share ownership of the
 * loop but not of the data of the caller, which exist only while a chunk is running.
 */
class Loop
{
public:
  Loop(Index chunks, ChunkWork work)
    : Chunks(chunks)
    , Work(work)
  {
  }

  /// The work of a worker.
  void help() noexcept
  {
    const std::atomic<bool>* before = std::exchange(interruptedCaller, &this->Interrupted);
    while (this->runNext())
    {
    }
    interruptedCaller = before;
  }

  /// The work of the caller; returns the number of chunks it ran. Calls `whenLong`, if given, when
  /// the loop proves longer than many time slices.
  Index lead(const Proceed& proceed, const std::function<void()>& whenLong = nullptr)
  {
    Index run = 0;
    bool waits = static_cast<bool>(whenLong);
    const Clock::time_point start = Clock::now();
    try
    {
      while (this->Next < this->Chunks && this->mayProceed(proceed) && this->runInCaller())
      {
        ++run;
        if (waits && seconds(Clock::now() - start) > ManySlices)
        {
          waits = false;
          whenLong();
        }
      }
    }
    catch (...)
    {
      this->fail(-1, std::current_exception()); // thrown by `proceed`, or an interruption
      this->Interrupted = true;
    }
    this->close();
    return run;
  }

  /// Waits for the chunks of the workers. Returns false if `proceed` ended the loop.
  bool join()
  {
    this->wait();
    if (this->Caught)
    {
      std::rethrow_exception(this->Caught);
    }
    return !this->Stopped;
  }

private:
  bool mayProceed(const Proceed& proceed)
  {
    throwIfInterrupted();
    const double done = static_cast<double>(this->Done) / static_cast<double>(this->Chunks);
    LoopProgress::at(done);
    this->Stopped = proceed && !proceed(done);
    return !this->Stopped;
  }

  bool runInCaller() noexcept
  {
    const LoopProgress::Nested nested;
    return this->runNext();
  }

  bool runNext() noexcept
  {
    const Index chunk = this->Next.fetch_add(1);
    if (chunk >= this->Chunks)
    {
      return false;
    }
    try
    {
      this->Work(chunk);
    }
    catch (const tautline::Interrupted&)
    {
      this->Interrupted = true; // ends the chunks of workers
      this->fail(chunk, std::current_exception());
    }
    catch (...)
    {
      this->fail(chunk, std::current_exception());
    }
    this->finish(1);
    return true;
  }

  /// Chunks begin in order: all chunks before the first failing one are run, regardless of the
  /// order of failures.
  void fail(Index chunk, std::exception_ptr error)
  {
    this->close();
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (!this->Caught || chunk < this->Failed)
    {
      this->Failed = chunk;
      this->Caught = std::move(error);
    }
  }

  /// Prevents further chunks from starting.
  void close()
  {
    const Index next = this->Next.exchange(this->Chunks);
    if (next < this->Chunks)
    {
      this->finish(this->Chunks - next);
    }
  }

  void finish(Index chunks)
  {
    if (this->Done.fetch_add(chunks) + chunks == this->Chunks)
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Finished.notify_one();
    }
  }

  void wait()
  {
    const Clock::time_point limit = Clock::now() + SpinTime;
    while (this->Done < this->Chunks && Clock::now() < limit)
    {
      for (int i = 0; i < PausesPerLook; ++i)
      {
        pauseBriefly();
      }
    }
    std::unique_lock<std::mutex> lock(this->Mutex);
    const auto done = [this] { return this->Done == this->Chunks; };
    while (!this->Finished.wait_for(lock, PollInterval, done))
    {
      lock.unlock();
      this->poll();
      lock.lock();
    }
  }

  /// Chunks of workers may take long, so the flag informs them that the caller is interrupted.
  void poll() noexcept
  {
    if (this->Interrupted)
    {
      return;
    }
    try
    {
      throwIfInterrupted();
    }
    catch (...)
    {
      this->fail(-1, std::current_exception());
      this->Interrupted = true;
    }
  }

  const Index Chunks;
  const ChunkWork Work;
  std::atomic<Index> Next{ 0 }, Done{ 0 };
  std::mutex Mutex;
  std::condition_variable Finished;
  std::atomic<bool> Interrupted{ false };
  std::exception_ptr Caught;
  Index Failed = 0;
  bool Stopped = false; ///< by `proceed`
};

//------------------------------------------------------------------------------
/// The threads of oneTBB. One arena per requested number of workers. Arenas are never destroyed:
/// they may outlive all other static objects.
class Workers
{
public:
  static Workers& instance()
  {
    static Workers* const workers = new Workers;
    return *workers;
  }

  /// Invites this many workers. They need not arrive: the caller can do all the work alone.
  void invite(int number, const std::shared_ptr<Loop>& loop) noexcept
  {
    if (this->Forked)
    {
      return;
    }
    try
    {
      if (tbb::task_arena* arena = this->arena(number))
      {
        const int invited = arena->max_concurrency();
        for (int i = 0; i < invited; ++i)
        {
          arena->enqueue([loop] { loop->help(); });
        }
      }
    }
    catch (const std::exception&)
    {
      // no memory for another worker
    }
  }

private:
  Workers()
  {
    pthread_atfork(nullptr, nullptr, [] { Workers::instance().Forked = true; });
  }

  /// Null if no thread can be started.
  tbb::task_arena* arena(int number)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const auto found = this->Arenas.find(number);
    if (found != this->Arenas.end())
    {
      return found->second.get();
    }
    constexpr unsigned reservedForCallers = 0;
    const int workers = startable(number);
    return this->Arenas
      .emplace(number,
        workers > 0 ? std::make_unique<tbb::task_arena>(workers, reservedForCallers) : nullptr)
      .first->second.get();
  }

  /// How many of the requested threads can be started at the same time: oneTBB ends the process if
  /// it cannot start one.
  static int startable(int number)
  {
    std::vector<std::thread> threads;
    std::mutex gate;
    try
    {
      threads.reserve(static_cast<std::size_t>(number));
      const std::lock_guard<std::mutex> closed(gate);
      for (int i = 0; i < number; ++i)
      {
        threads.emplace_back([&gate] { const std::lock_guard<std::mutex> opened(gate); });
      }
    }
    catch (const std::exception&)
    {
      // the thread limit is reached
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    return static_cast<int>(threads.size());
  }

  std::mutex Mutex;
  std::map<int, std::unique_ptr<tbb::task_arena>> Arenas;
  std::atomic<bool> Forked{ false };
};
}

//------------------------------------------------------------------------------
int resolveThreads(int threads)
{
  return threads > 0 ? threads : allThreads();
}

//------------------------------------------------------------------------------
bool runChunks(Index chunks, int threads, ChunkWork work, const Proceed& proceed)
{
  if (chunks <= 0)
  {
    return true;
  }
  // Workers beyond the limit of oneTBB would not arrive.
  const Index most = std::min({ static_cast<Index>(resolveThreads(threads)), chunks,
    static_cast<Index>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)) });
  const auto loop = std::make_shared<Loop>(chunks, work);
  if (most < 2)
  {
    loop->lead(proceed);
    return loop->join();
  }
  static thread_local Experience experience;
  const double expected = experience.expected(work.function(), chunks);
  const Clock::time_point start = Clock::now();
  if (Experience::brief(expected))
  {
    const Index run = loop->lead(proceed);
    experience.addChunks(work.function(), run, seconds(Clock::now() - start));
    return loop->join();
  }
  const auto invite = [&] { Workers::instance().invite(static_cast<int>(most - 1), loop); };
  const bool invited = experience.inviteWorkers(expected);
  if (invited)
  {
    invite();
  }
  else if (experience.measuredEnough(work.function()))
  {
    loop->lead(proceed, invite);
    return loop->join();
  }
  const double before = threadSeconds();
  const Index run = loop->lead(proceed, invited ? std::function<void()>() : invite);
  const double computed = threadSeconds() - before;
  experience.addChunks(work.function(), run, computed);
  experience.addTime(computed, seconds(Clock::now() - start));
  return loop->join();
}

//------------------------------------------------------------------------------
bool callerIsInterrupted()
{
  return interruptedCaller && *interruptedCaller;
}
}
