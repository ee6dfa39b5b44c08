// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankSets.h
 * @brief Connected sets of the points of a mesh on several ranks. Internal: not installed.
 */
#ifndef tautline_RankSets_h
#define tautline_RankSets_h

#include "DistributedMesh.h"
#include "tautline/Core/UnionFind.h"

#include <vector>

namespace tautline
{
/**
 * @brief Numbers sets of points, each of which may go on on other ranks, in the order of their
 * smallest points. What joins two points must be known to the ranks that own them. Collective, in
 * as many rounds as a set has ranks one after the other.
 * @param sets of local points: the parts of the sets here
 * @param member one flag per local point; the others get -1
 * @param count the number of sets on all ranks
 * @return the number per local point; the owner's counts
 */
TAUTLINE_KERNEL_EXPORT std::vector<Index> numberSetsOnRanks(const DistributedMesh& mesh,
  UnionFind& sets, const std::vector<unsigned char>& member, Index& count);
}
#endif
