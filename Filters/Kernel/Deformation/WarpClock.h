/**
 * @file WarpClock.h
 * @brief The time limit and the observer of a warp, and loops that heed them. Internal: not
 * installed.
 */
#ifndef tautline_WarpClock_h
#define tautline_WarpClock_h

#include "tautline/Core/Parallel.h"
#include "WarpOptions.h"

#include <chrono>

namespace tautline
{
/// The time limit and the observer of options; told from the calling thread.
class WarpClock
{
public:
  explicit WarpClock(const WarpOptions& options)
    : Options(options)
    , Start(std::chrono::steady_clock::now())
  {
  }

  /// False when it is time to stop.
  bool proceed(double fraction) const
  {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - this->Start;
    return (this->Options.maximumSeconds <= 0 || passed.count() < this->Options.maximumSeconds) &&
      (!this->Options.progress || this->Options.progress(fraction));
  }

private:
  const WarpOptions& Options;
  std::chrono::steady_clock::time_point Start;
};

/**
 * Calls work(i) for each i below n; between runs of many the clock is told the fraction, which
 * starts at `from`. False: stopped before the end.
 */
template <class Work>
bool forEachBatch(std::size_t n, int threads, const WarpClock& clock, double from, const Work& work)
{
  constexpr Index Runs = 16, Grain = 64;
  const auto size = static_cast<Index>(n);
  const Index run = std::max<Index>(ChunkSize, (size + Runs - 1) / Runs);
  for (Index begin = 0; begin < size; begin += run)
  {
    if (!clock.proceed(from + (1 - from) * static_cast<double>(begin) / static_cast<double>(size)))
    {
      return false;
    }
    const Index end = std::min(size, begin + run);
#pragma omp parallel for schedule(dynamic, Grain) num_threads(resolveThreads(threads))
    for (Index i = begin; i < end; ++i)
    {
      work(static_cast<std::size_t>(i));
    }
  }
  return true;
}
}
#endif
