// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BlockPieces.h
 * @brief Which blocks in pieces on several ranks have a seam between them.
 * Internal: not installed.
 */
#ifndef tautline_BlockPieces_h
#define tautline_BlockPieces_h

#include "RankPieces.h"

#include <vector>

namespace tautline
{
/// A piece of a block.
struct BlockPiece
{
  RankPiece piece;       ///< points with the same coordinates are one; globalIds are not read
  int block = 0;         ///< its number
  bool reversed = false; ///< its cells list their points in the opposite order
};

/**
 * @brief Finds the blocks with a seam between them: a facet (edge or face) of the boundary that
 * exactly two cells have at the same place, of two blocks, on the two sides of it. That is what
 * findCoincidentPoints() finds in one mesh, but for cells that would have a point twice.
 * Collective.
 * @param pieces with Mesh::setSpace() of all blocks together; a rank may have any number
 * @param blocks how many there are, the same on all ranks
 * @return per block the smallest number of those that seams connect with it, or its own
 */
TAUTLINE_KERNEL_EXPORT std::vector<int> connectedBlocks(
  RankGroup& group, const std::vector<BlockPiece>& pieces, int blocks);
}
#endif
