// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoopInterruption.h
 * @brief Whether the thread that waits for a chunk of a parallel loop is interrupted.
 * Internal: not installed.
 */
#ifndef tautline_LoopInterruption_h
#define tautline_LoopInterruption_h

#include "Types.h" // for the export macro

namespace tautline
{
/**
 * @brief Whether the caller of this worker's loop is interrupted.
 *
 * Chunks that take longer than a tenth of a second call throwIfInterrupted() or pollInterruption(),
 * which throw on workers where this is true, or call this function and end soon. False on threads
 * that are not workers.
 */
TAUTLINE_KERNEL_EXPORT bool callerIsInterrupted();
}
#endif
