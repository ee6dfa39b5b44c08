// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessGroup.h
 * @brief The processes of VTK's global controller as the ranks of the kernel.
 */
#ifndef tautline_ProcessGroup_h
#define tautline_ProcessGroup_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Core/RankGroup.h"

#include <memory>

namespace tautline
{
/// The processes of the global controller by MPI; this process alone if there is one only. Throws
/// Error if there are several that do not communicate by MPI. Valid as long as the controller.
TAUTLINECORE_EXPORT std::unique_ptr<RankGroup> makeProcessGroup();
}
#endif
