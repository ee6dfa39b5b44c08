// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PassPlan.h
 * @brief The passes of a reconnection run.
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

/// A pass for tetrahedra left below the target by prematurely ended repairs.
PassOptions withoutCompound(PassOptions pass);

/// The passes for tetrahedra left by blocks: the compound ones, and the most effective one before
/// these.
std::vector<PassOptions> lastPasses(const std::vector<PassOptions>& passes);
}
#endif
