// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MachineLoad.h
 * @brief The load of the machine.
 * Internal: not installed.
 */
#ifndef tautline_MachineLoad_h
#define tautline_MachineLoad_h

#include "tautline/KernelExport.h"

namespace tautline
{
/**
 * @brief The number of threads on the machine that run or wait for a core, including this one; 0 if
 * the system does not report it.
 *
 * Loops of Parallel.h that take less than a third of a second are not shared among threads while
 * this exceeds two per core.
 */
TAUTLINE_KERNEL_EXPORT int runnableThreads();
}
#endif
