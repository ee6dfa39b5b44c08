// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Clocks.h
 * @brief What the benchmarks measure with.
 */
#ifndef tautline_Clocks_h
#define tautline_Clocks_h

#include <malloc.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <string>

namespace tautline
{
inline double wallTime()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

inline double cpuTime(clockid_t clock)
{
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The computing time of this thread; on a busy machine less than the time that passed.
inline double threadTime()
{
  return cpuTime(CLOCK_THREAD_CPUTIME_ID);
}

/// The computing time of all threads.
inline double processTime()
{
  return cpuTime(CLOCK_PROCESS_CPUTIME_ID);
}

/// A line of /proc/self/status in bytes.
inline double statusBytes(const std::string& key)
{
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line))
  {
    if (line.compare(0, key.size() + 1, key + ":") == 0)
    {
      return 1024.0 * std::stod(line.substr(key.size() + 1));
    }
  }
  return 0;
}

/// Lets the peak of the resident memory, VmHWM, start again from what is in use.
inline void resetPeakMemory()
{
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5\n";
}
}
#endif
