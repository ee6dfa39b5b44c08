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
/// First swaps and smoothing, for ever better tetrahedra; then insertion, then what is costly.
std::vector<PassOptions> planPasses(const ReconnectionOptions& options, Index size);

/// For what repairs that were ended early left below the target.
PassOptions withoutCompound(PassOptions pass);

/// Those that what blocks left needs: the compound ones, and the one before these that does most.
std::vector<PassOptions> lastPasses(const std::vector<PassOptions>& passes);
}
#endif
