// SPDX-License-Identifier: BSD-3-Clause
// The loops of Parallel.h: every chunk once, errors of the first chunk, nested loops, loops of
// several callers and of the child of a fork, callbacks on the calling thread, threads that wait
// asleep.
#include "Registry.h"
#include "tautline/Core/LoopProgress.h"
#include "tautline/Core/MachineLoad.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Stopwatch.h"

#include <csignal>
#include <functional>
#include <numeric>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace tautline;

namespace
{
constexpr int MostThreads = 8;

void sleepFor(double seconds)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Keeps a core busy: a thread that sleeps in chunks is taken for one that lost its core.
void computeFor(double seconds)
{
  const Stopwatch time;
  while (!time.reached(seconds))
  {
  }
}

/// A thread that has learned nothing from earlier loops yet, and so gets workers.
void inNewThread(const std::function<void()>& work)
{
  std::thread(work).join();
}

/// CPU seconds of this process.
double cpuSeconds()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
    1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

//------------------------------------------------------------------------------
void testEveryChunkOnce()
{
  for (int threads = 0; threads <= MostThreads; ++threads)
  {
    for (Index n : { 0, 1, 2, 7, 1000 })
    {
      std::vector<std::atomic<int>> counts(n);
      std::atomic<int> now{ 0 }, most{ 0 };
      TAUTLINE_CHECK(runChunks(n, threads,
        [&](Index chunk)
        {
          const int running = ++now;
          int seen = most;
          while (running > seen && !most.compare_exchange_weak(seen, running))
          {
          }
          ++counts[chunk];
          --now;
        }));
      TAUTLINE_CHECK(
        std::all_of(counts.begin(), counts.end(), [](const auto& count) { return count == 1; }));
      TAUTLINE_CHECK(most <= resolveThreads(threads));
    }
    constexpr Index length = 3 * ChunkSize + 1, grain = 64;
    std::vector<int> ends(length), visits(length);
    forEachChunk(length, threads,
      [&](Index chunk, Index begin, Index end)
      {
        TAUTLINE_CHECK_EQUAL(begin, chunk * ChunkSize);
        std::fill(ends.begin() + begin, ends.begin() + end, static_cast<int>(end));
      });
    TAUTLINE_CHECK_EQUAL(ends.front(), static_cast<int>(ChunkSize));
    TAUTLINE_CHECK_EQUAL(ends.back(), static_cast<int>(length));
    parallelFor(length, grain, threads, [&](Index i) { ++visits[i]; });
    TAUTLINE_CHECK(visits == std::vector<int>(length, 1));
  }
}

//------------------------------------------------------------------------------
/// Work spaces are not shared while in use, and no more are made than there are threads.
void testScratch()
{
  struct Scratch
  {
    std::atomic<bool> used{ false };
    std::vector<int> marks;
    Scratch(std::atomic<int>& made, std::size_t size)
      : marks(size)
    {
      ++made;
    }
  };
  constexpr Index n = 500;
  for (int threads : { 1, 2, 3, 0 })
  {
    std::atomic<int> made{ 0 }, shared{ 0 };
    ScratchPool<Scratch> pool([&] { return Scratch(made, 10); });
    const auto use = [&](Scratch& scratch, Index)
    {
      shared += scratch.used.exchange(true);
      std::iota(scratch.marks.begin(), scratch.marks.end(), 0);
      scratch.used = false;
    };
    parallelFor(n, 2, threads, pool, use);
    parallelFor(n, 2, threads, pool, use);
    TAUTLINE_CHECK_EQUAL(shared.load(), 0);
    TAUTLINE_CHECK(made >= 1 && made <= resolveThreads(threads));
  }
}

//------------------------------------------------------------------------------
/// Several chunks fail, the later ones sooner: the message comes from the first. The next
/// loop runs.
void testErrors()
{
  constexpr Index n = 40, first = 5, repetitions = 20;
  for (int threads = 0; threads <= MostThreads; ++threads)
  {
    for (Index turn = 0; turn < repetitions; ++turn)
    {
      std::atomic<Index> begun{ 0 };
      std::string message;
      try
      {
        runChunks(n, threads,
          [&](Index chunk)
          {
            ++begun;
            if (chunk == first)
            {
              computeFor(1e-4);
            }
            if (chunk >= first)
            {
              throw Error("chunk " + std::to_string(chunk));
            }
          });
      }
      catch (const Error& error)
      {
        message = error.what();
      }
      TAUTLINE_CHECK_EQUAL(message, "chunk " + std::to_string(first));
      TAUTLINE_CHECK(begun > first && begun <= first + resolveThreads(threads));
    }
    std::atomic<Index> sum{ 0 };
    runChunks(n, threads, [&](Index chunk) { sum += chunk; });
    TAUTLINE_CHECK_EQUAL(sum.load(), n * (n - 1) / 2);
    // The chunks of the workers wait for the callback; without that they could all be done before.
    std::atomic<bool> called{ false };
    const auto waitForCall = [&](Index)
    {
      while (!called)
      {
        std::this_thread::yield();
      }
    };
    const auto callback = [&](double) -> bool
    {
      called = true;
      throw Error("from the callback");
    };
    TAUTLINE_CHECK_THROWS(
      runChunks(n, threads, waitForCall, callback), wording("from-the-callback"));
  }
}

//------------------------------------------------------------------------------
/// The callback is called on the calling thread only, with fractions that do not decrease; false
/// ends the loop.
void testProceed()
{
  constexpr Index n = 200, many = 100000, last = 50;
  const std::thread::id caller = std::this_thread::get_id();
  for (int threads = 0; threads <= MostThreads; ++threads)
  {
    double before = 0;
    int calls = 0;
    const bool complete = runChunks(
      n, threads, [](Index) { computeFor(1e-6); },
      [&](double fraction)
      {
        TAUTLINE_CHECK(std::this_thread::get_id() == caller);
        TAUTLINE_CHECK(fraction >= before && fraction <= 1);
        before = fraction;
        ++calls;
        return true;
      });
    TAUTLINE_CHECK(complete && calls <= n && (calls == n || threads != 1));
    std::atomic<Index> begun{ 0 };
    TAUTLINE_CHECK(!runChunks(
      many, threads,
      [&](Index)
      {
        ++begun;
        computeFor(1e-5);
      },
      [&](double) { return begun < last; }));
    TAUTLINE_CHECK(begun >= last && begun < many);
  }
}

//------------------------------------------------------------------------------
/// While a thread waits for an inner loop it begins no other chunk of the outer one.
void testNesting()
{
  static thread_local int depth = 0;
  constexpr Index outer = 24, inner = 12;
  std::atomic<int> deepest{ 0 };
  std::atomic<Index> sum{ 0 };
  runChunks(outer, 0,
    [&](Index)
    {
      if (++depth > 1)
      {
        ++deepest;
      }
      runChunks(inner, 0,
        [&](Index chunk)
        {
          computeFor(1e-5);
          sum += chunk;
        });
      --depth;
    });
  TAUTLINE_CHECK_EQUAL(deepest.load(), 0);
  TAUTLINE_CHECK_EQUAL(sum.load(), outer * inner * (inner - 1) / 2);
}

/// More callers than cores, at the same time, with errors among them.
void testSeveralCallers()
{
  constexpr int callers = 6, loops = 200;
  constexpr Index chunks = 9;
  std::atomic<Index> sum{ 0 };
  std::atomic<int> caught{ 0 };
  std::vector<std::thread> threads;
  for (int caller = 0; caller < callers; ++caller)
  {
    threads.emplace_back(
      [&, caller]
      {
        for (int loop = 0; loop < loops; ++loop)
        {
          try
          {
            runChunks(chunks, 1 + caller,
              [&](Index chunk)
              {
                if (caller == 0)
                {
                  throw Error("of one caller");
                }
                sum += chunk;
              });
          }
          catch (const Error&)
          {
            ++caught;
          }
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  TAUTLINE_CHECK_EQUAL(caught.load(), loops);
  TAUTLINE_CHECK_EQUAL(sum.load(), (callers - 1) * loops * chunks * (chunks - 1) / 2);
}

//------------------------------------------------------------------------------
/// A process has no workers after fork(): the caller does all the work.
void testFork()
{
  constexpr Index n = 100;
  runChunks(n, 0, [](Index) {});
  const pid_t child = fork();
  if (child == 0)
  {
    std::atomic<Index> sum{ 0 };
    runChunks(n, 0, [&](Index chunk) { sum += chunk; });
    _exit(sum == n * (n - 1) / 2 ? 0 : 1);
  }
  int status = -1;
  const Stopwatch time;
  constexpr double limit = 20;
  while (waitpid(child, &status, WNOHANG) == 0)
  {
    if (time.reached(limit))
    {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
    }
    sleepFor(1e-3);
  }
  TAUTLINE_CHECK_EQUAL(status, 0);
}

//------------------------------------------------------------------------------
/// A caller that waits for a chunk of another thread, and workers between loops, take no CPU time.
void testWaiting()
{
  constexpr int loops = 20;
  // A thread that spins takes a half of the time or more; twenty new threads also take some.
  constexpr double pause = 10e-3, share = 0.2;
  constexpr int crowded = 2; // runnable threads per core: no worker is asked then
  std::atomic<int> waited{ 0 };
  bool alone = false;
  const Stopwatch time;
  const double before = cpuSeconds();
  for (int loop = 0; loop < loops; ++loop)
  {
    inNewThread(
      [&]
      {
        const std::thread::id caller = std::this_thread::get_id();
        std::atomic<bool> begun{ false };
        runChunks(2, 2,
          [&](Index)
          {
            if (std::this_thread::get_id() == caller)
            {
              // Until the worker has the other chunk, if one comes at all.
              const Stopwatch patience;
              while (!begun && !patience.reached(pause))
              {
                sleepFor(0.1 * pause);
              }
              waited += begun;
              return;
            }
            begun = true;
            sleepFor(pause);
          });
      });
    alone = alone || runnableThreads() > crowded * resolveThreads(0);
    sleepFor(pause);
  }
  const double used = cpuSeconds() - before, wall = time.seconds();
  TAUTLINE_CHECK(wall >= loops * pause);
  TAUTLINE_CHECK(used < share * wall);
  TAUTLINE_CHECK(resolveThreads(0) == 1 || alone || waited > 0);
}

/// Threads that compute are counted.
void testMachineLoad()
{
#ifdef __linux__
  constexpr int number = 6, attempts = 20;
  std::atomic<bool> end{ false };
  std::vector<std::thread> threads;
  for (int i = 0; i < number; ++i)
  {
    threads.emplace_back(
      [&end]
      {
        while (!end)
        {
        }
      });
  }
  // Each attempt sees those that have started by then.
  int most = 0;
  for (int i = 0; i < attempts && most <= number; ++i)
  {
    most = std::max(most, runnableThreads());
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  end = true;
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  TAUTLINE_CHECK(most > number);
#endif
}

/// A loop that nothing is known of gets no worker on a crowded machine, but once it has turned out
/// to be long.
void testLongLoopOnCrowdedMachine()
{
#ifdef __linux__
  constexpr int perCore = 3;
  constexpr Index chunks = 24;
  constexpr double chunkSeconds = 0.05;
  std::atomic<bool> end{ false };
  std::vector<std::thread> crowd;
  for (int i = 0; i < perCore * resolveThreads(0); ++i)
  {
    crowd.emplace_back(
      [&end]
      {
        while (!end)
        {
        }
      });
  }
  sleepFor(chunkSeconds);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<Index> early{ 0 }, helped{ 0 };
  const Stopwatch time;
  runChunks(chunks, 0,
    [&](Index)
    {
      const bool byWorker = std::this_thread::get_id() != caller;
      early += byWorker && !time.reached(4 * chunkSeconds);
      helped += byWorker;
      computeFor(chunkSeconds);
    });
  end = true;
  for (std::thread& thread : crowd)
  {
    thread.join();
  }
  TAUTLINE_CHECK_EQUAL(early.load(), Index(0));
  TAUTLINE_CHECK(resolveThreads(0) == 1 || helped > 0);
#endif
}

/// Loops report growing fractions of the range of a scope; loops within chunks, of other threads
/// and outside of the scope do not.
void testProgress()
{
  constexpr Index chunks = 8;
  const auto nothing = [](Index) {};
  const auto nested = [&](Index) { runChunks(chunks, 1, nothing); };
  std::vector<double> reports;
  {
    const LoopProgress progress([&](double done) { reports.push_back(done); }, 0.2, 0.6);
    TAUTLINE_CHECK(runChunks(chunks, 1, nested));
    // The first loop stands for one half: its last chunk began at 7 / 8 of 0.2 to 0.4.
    TAUTLINE_CHECK_EQUAL(reports.size(), std::size_t{ 7 });
    TAUTLINE_CHECK_NEAR(reports.front(), 0.2 + 0.2 / 8, 1e-12);
    TAUTLINE_CHECK_NEAR(reports.back(), 0.375, 1e-12);
    std::thread([&] { runChunks(chunks, 1, nothing); }).join();
    TAUTLINE_CHECK_EQUAL(reports.size(), std::size_t{ 7 });
    TAUTLINE_CHECK(runChunks(chunks, 1, nothing)); // one half of 0.375 to 0.6
    TAUTLINE_CHECK_NEAR(reports.back(), 0.375 + 0.5 * 0.225 * 7 / 8, 1e-12);
  }
  TAUTLINE_CHECK_EQUAL(reports.back(), 0.6);
  TAUTLINE_CHECK(std::is_sorted(reports.begin(), reports.end()));
  const std::size_t number = reports.size();
  runChunks(chunks, 1, nothing);
  try
  {
    const LoopProgress progress([&](double done) { reports.push_back(done); });
    throw Error("ends the scope");
  }
  catch (const Error&)
  {
    TAUTLINE_CHECK_EQUAL(reports.size(), number);
  }
}
}

TAUTLINE_TEST(TestParallel)
{
  TAUTLINE_CHECK(resolveThreads(0) >= 1);
  TAUTLINE_CHECK_EQUAL(resolveThreads(3), 3);
  for (const auto& test :
    { testEveryChunkOnce, testScratch, testErrors, testProceed, testNesting, testSeveralCallers,
      testFork, testWaiting, testMachineLoad, testLongLoopOnCrowdedMachine, testProgress })
  {
    inNewThread(test);
  }
}
