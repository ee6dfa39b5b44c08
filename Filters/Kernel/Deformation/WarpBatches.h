// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpBatches.h
 * @brief A loop over many points that reports progress and can be stopped.
 * Internal: not installed.
 */
#ifndef tautline_WarpBatches_h
#define tautline_WarpBatches_h

#include "WarpControl.h"
#include "tautline/Core/Parallel.h"

namespace tautline
{
/**
 * @brief Calls work(i) for each i below n in several batches, each on all threads; reports progress
 * between the batches.
 * @param from fraction of the deformation done before the first batch; the last one ends at 1
 * @return false if the deformation had to stop before the end
 */
template <class Work>
bool forEachBatch(std::size_t n, double from, WarpControl& control, const Work& work)
{
  constexpr Index Runs = 16, Grain = 64;
  const auto size = static_cast<Index>(n);
  const Index run = std::max<Index>(ChunkSize, (size + Runs - 1) / Runs);
  for (Index begin = 0; begin < size; begin += run)
  {
    if (!control.watch(from + (1 - from) * static_cast<double>(begin) / static_cast<double>(size)))
    {
      return false;
    }
    const Index end = std::min(size, begin + run);
    parallelFor(end - begin, Grain, control.options().threads,
      [&](Index i) { work(static_cast<std::size_t>(begin + i)); });
  }
  return true;
}
}
#endif
