// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MachineLoad.h
 * @brief How busy the machine is.
 * Internal: not installed.
 */
#ifndef tautline_MachineLoad_h
#define tautline_MachineLoad_h

#include "tautline/KernelExport.h"

namespace tautline
{
/**
 * @brief How many threads of all processes of the machine run or wait for a core, this one
 * included; 0 where the system does not tell.
 *
 * Loops of Parallel.h that take less than a third of a second are not shared while these are more
 * than two per core.
 */
TAUTLINE_KERNEL_EXPORT int runnableThreads();
}
#endif
