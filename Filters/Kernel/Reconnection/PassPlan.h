// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PassPlan.h
 * @brief Which passes a run of reconnection consists of.
 * Internal: not installed.
 */
#ifndef tautline_PassPlan_h
#define tautline_PassPlan_h

#include "ReconnectionOptions.h"
#include "TetrahedronPasses.h"

#include <vector>

namespace tautline
{
/**
 * @brief The passes of each stage, of one angle after the other up to the target. Stages of the
 * same number are the same for all targets.
 */
std::vector<std::vector<PassOptions>> planStages(const ReconnectionOptions& options, Index size);

/// For what repairs that were ended early left below the target.
PassOptions withoutCompound(PassOptions pass);

/// Those that what blocks left needs: the compound ones, and the one before these that does most.
std::vector<PassOptions> lastPasses(const std::vector<PassOptions>& passes);
}
#endif
