// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DecompositionCounts.h
 * @brief Estimates the costs of a decomposition of a mesh into parts: halos, messages and bytes of
 * a sweep, and balance. No messages are sent.
 */
#ifndef tautline_DecompositionCounts_h
#define tautline_DecompositionCounts_h

#include "Mesh.h"

#include <vector>

namespace tautline
{
/// Counts of a part, as on the rank that would own it.
struct PartCounts
{
  Index cells = 0;
  Index points = 0;     ///< that the rank owns
  Index freePoints = 0; ///< of these, the points that move in a sweep
  Index haloPoints = 0; ///< DistributedMesh::haloPoints()
  Index neighbours = 0; ///< DistributedMesh::neighbours()
  Index messages = 0; ///< sent in a sweep: after each independent set, one to each rank with a copy
  /// in these messages: a free point is counted once for each rank with a copy
  Index sentPoints = 0;
};

/// Counts of all parts.
struct DecompositionCounts
{
  std::vector<PartCounts> parts;
  Index sets = 0; ///< independent sets of the free points, each followed by an exchange
  /// The number of points that move sequentially in a sweep if ranks wait for each other after each
  /// set: the sum over the sets of the largest number on a rank.
  Index slowestPoints = 0;
  Index points = 0, freePoints = 0; ///< of the whole mesh; only points in cells
};

/**
 * @brief Counts the messages of LocalSweeper for one part per rank, without ghost cells.
 * @param partOfCell one number per cell, 0 to parts - 1; a part may have no cell
 * @param parts at least 1
 * @param free one flag per point: nonzero if it moves
 *
 * Owners, halos and independent sets are computed as in DistributedMesh. Memory and time grow with
 * the mesh and the borders between the parts. Throws Error for numbers out of range.
 */
TAUTLINE_KERNEL_EXPORT DecompositionCounts countDecomposition(const MeshView& view,
  const std::vector<int>& partOfCell, int parts, const std::vector<unsigned char>& free);
}
#endif
