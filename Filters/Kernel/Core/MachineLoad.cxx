// SPDX-License-Identifier: BSD-3-Clause
#include "MachineLoad.h"

#include <fstream>

namespace tautline
{
int runnableThreads()
{
  // "0.08 0.09 0.41 3/512 4711": averages, then the runnable threads of all threads.
  std::ifstream file("/proc/loadavg");
  double average = 0.0;
  int runnable = 0;
  file >> average >> average >> average >> runnable;
  return file ? runnable : 0;
}
}
