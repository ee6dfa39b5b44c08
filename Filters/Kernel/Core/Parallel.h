// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Parallel.h
 * @brief Threaded loops whose result does not depend on the number of threads.
 * Internal: not installed.
 *
 * Work is divided into chunks of a fixed size. The assignment of chunks to threads varies; the work
 * of a chunk and the order in which chunk results are combined do not.
 *
 * The calling thread runs chunks itself. Free oneTBB workers help. The caller then waits only for
 * chunks that have begun, first spinning for some microseconds, then sleeping, and runs nothing
 * else meanwhile. Loops may therefore be nested and be called from several threads. If threads
 * cannot be started, in the child of a fork, and in loops that are too short for workers to pay off
 * (estimated from earlier loops), the caller does all the work. Loops report to a LoopProgress of
 * the calling thread; loops within a chunk do not.
 *
 * `threads` is the largest number of threads of a loop, the caller included; 0 means all cores the
 * process may use, or OMP_NUM_THREADS if that is set and smaller.
 *
 * An exception thrown in a chunk ends the loop and is thrown to the caller. If several chunks
 * throw, it is the exception of the first chunk, so that the message does not depend on the number
 * of threads.
 */
#ifndef tautline_Parallel_h
#define tautline_Parallel_h

#include "Types.h"

#include "tautline/KernelExport.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace tautline
{
/// Elements per chunk: large enough to hide the scheduling, small enough to balance two cores.
constexpr Index ChunkSize = 4096;

inline Index numberOfChunks(Index n)
{
  return (n + ChunkSize - 1) / ChunkSize;
}

/// The number of threads for the value of a `threads` option.
TAUTLINE_KERNEL_EXPORT int resolveThreads(int threads);

/// A reference to the chunk function; the callable must outlive the loop.
class ChunkWork
{
public:
  using Function = void (*)(const void*, Index);

  template <class Work>
  ChunkWork(const Work& work)
    : Object(&work)
    , Call([](const void* object, Index chunk) { (*static_cast<const Work*>(object))(chunk); })
  {
  }
  void operator()(Index chunk) const { this->Call(this->Object, chunk); }
  /// A distinct function for each type of callable.
  Function function() const { return this->Call; }

private:
  const void* Object;
  Function Call;
};

/// Called by the calling thread between its chunks, with the fraction done; false ends the loop.
using Proceed = std::function<bool(double)>;

/**
 * @brief Calls work(chunk) for each chunk from 0 to chunks - 1; they begin in this order.
 * @return false if `proceed` ended the loop before all chunks were begun
 */
TAUTLINE_KERNEL_EXPORT bool runChunks(
  Index chunks, int threads, ChunkWork work, const Proceed& proceed = nullptr);

/// Calls work(chunk, begin, end) for each chunk of [0, n).
template <class Work>
void forEachChunk(Index n, int threads, const Work& work)
{
  runChunks(numberOfChunks(n), threads,
    [&](Index chunk) { work(chunk, chunk * ChunkSize, std::min(n, (chunk + 1) * ChunkSize)); });
}

/// Calls work(i) for each i in [0, n), `grain` of them in a chunk.
template <class Work>
bool parallelFor(
  Index n, Index grain, int threads, const Work& work, const Proceed& proceed = nullptr)
{
  return runChunks((n + grain - 1) / grain, threads,
    [&](Index chunk)
    {
      const Index end = std::min(n, (chunk + 1) * grain);
      for (Index i = chunk * grain; i < end; ++i)
      {
        work(i);
      }
    },
    proceed);
}

/**
 * @class tautline::ScratchPool
 * @brief Work spaces for chunks: each chunk borrows a free one and returns it.
 *
 * They are created on demand, at most one per thread. The contents left by an earlier chunk are
 * kept.
 */
template <class Scratch>
class ScratchPool
{
public:
  /// `make` returns a new work space; it may be called by several threads at once.
  explicit ScratchPool(std::function<Scratch()> make = [] { return Scratch(); })
    : Make(std::move(make))
  {
  }

  /// Calls use(scratch).
  template <class Use>
  void with(const Use& use)
  {
    const Loan loan(*this);
    use(*loan.Item);
  }

private:
  struct Loan
  {
    explicit Loan(ScratchPool& pool)
      : Pool(pool)
      , Item(pool.take())
    {
    }
    ~Loan()
    {
      const std::lock_guard<std::mutex> lock(this->Pool.Mutex);
      this->Pool.Free.push_back(std::move(this->Item)); // has the capacity
    }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;

    ScratchPool& Pool;
    std::unique_ptr<Scratch> Item;
  };

  std::unique_ptr<Scratch> take()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      if (!this->Free.empty())
      {
        std::unique_ptr<Scratch> item = std::move(this->Free.back());
        this->Free.pop_back();
        return item;
      }
      this->Free.reserve(++this->Made);
    }
    return std::unique_ptr<Scratch>(new Scratch(this->Make()));
  }

  std::function<Scratch()> Make;
  std::mutex Mutex;
  std::vector<std::unique_ptr<Scratch>> Free;
  std::size_t Made = 0;
};

/// Calls work(scratch, i) for each i in [0, n), `grain` of them in a chunk.
template <class Scratch, class Work>
bool parallelFor(Index n, Index grain, int threads, ScratchPool<Scratch>& pool, const Work& work,
  const Proceed& proceed = nullptr)
{
  return runChunks((n + grain - 1) / grain, threads,
    [&](Index chunk)
    {
      pool.with(
        [&](Scratch& scratch)
        {
          const Index end = std::min(n, (chunk + 1) * grain);
          for (Index i = chunk * grain; i < end; ++i)
          {
            work(scratch, i);
          }
        });
    },
    proceed);
}
}
#endif
