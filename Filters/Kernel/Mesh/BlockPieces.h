// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BlockPieces.h
 * @brief Finds the blocks, in pieces on several ranks, that share a seam.
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
  /// points with the same coordinates are identified; globalIds are not read
  RankPiece piece;
  int block = 0;         ///< its number
  bool reversed = false; ///< whether its cells list their points in the opposite order
};

/**
 * @brief Finds the blocks with a seam between them: a boundary facet (edge or face) where exactly
 * two cells of two blocks coincide, on opposite sides. This is equivalent to findCoincidentPoints()
 * in one mesh, except for cells that would have a point twice. Collective.
 * @param pieces with Mesh::setSpace() for all blocks together; a rank may have any number
 * @param blocks the number of blocks, the same on all ranks
 * @return per block: the smallest number of the blocks connected to it by seams, or its own
 */
TAUTLINE_KERNEL_EXPORT std::vector<int> connectedBlocks(
  RankGroup& group, const std::vector<BlockPiece>& pieces, int blocks);
}
#endif
