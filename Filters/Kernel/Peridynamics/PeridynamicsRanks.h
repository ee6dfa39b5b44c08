// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PeridynamicsRanks.h
 * @brief The distribution of the rows of a nonlocal matrix over ranks.
 * Internal: not installed.
 */
#ifndef tautline_PeridynamicsRanks_h
#define tautline_PeridynamicsRanks_h

#include "FunctionSpace.h"
#include "tautline/Core/RankGroup.h"

#include <vector>

namespace tautline
{
/// The rank that assembles the rows of each unknown function. Collective.
std::vector<int> ranksOfRows(RankGroup& group, const FunctionSpace& space);

/**
 * @brief Sends the rows of each rank to the first one, which has the whole pattern: one rank after
 * the other, so that few rows are stored twice. The others have no matrix afterwards. Collective.
 * @param ranks from ranksOfRows()
 */
void gatherRows(RankGroup& group, const std::vector<int>& ranks, PeridynamicSystem& system);
}
#endif
