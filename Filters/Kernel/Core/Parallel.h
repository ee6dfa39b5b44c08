/**
 * @file Parallel.h
 * @brief Threaded loops whose result does not depend on the number of threads.
 *
 * Work is cut into chunks of a fixed size. Which thread takes which chunk varies; what a chunk does
 * and the order in which chunk results are combined do not.
 */
#ifndef tautline_Parallel_h
#define tautline_Parallel_h

#include "Types.h"

#include <omp.h>

#include <algorithm>

namespace tautline
{
/// Elements per chunk: large enough to hide the scheduling, small enough to balance two cores.
constexpr Index ChunkSize = 4096;

inline Index numberOfChunks(Index n)
{
  return (n + ChunkSize - 1) / ChunkSize;
}

/// The number of threads a `threads` option stands for; 0 means all cores.
inline int resolveThreads(int threads)
{
  return threads > 0 ? threads : omp_get_max_threads();
}

/// Calls work(chunk, begin, end) for each chunk of [0, n).
template <class Work>
void forEachChunk(Index n, int threads, const Work& work)
{
  const Index chunks = numberOfChunks(n);
#pragma omp parallel for schedule(dynamic) num_threads(resolveThreads(threads)) if (chunks > 1)
  for (Index chunk = 0; chunk < chunks; ++chunk)
  {
    work(chunk, chunk * ChunkSize, std::min(n, (chunk + 1) * ChunkSize));
  }
}
}
#endif
