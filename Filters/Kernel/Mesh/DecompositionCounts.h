// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DecompositionCounts.h
 * @brief What a division of a mesh into parts costs the ranks that would have them: halos, messages
 * and bytes of a sweep, balance. Nothing is sent.
 */
#ifndef tautline_DecompositionCounts_h
#define tautline_DecompositionCounts_h

#include "Mesh.h"

#include <vector>

namespace tautline
{
/// Counts of a part, as the rank that has it would find them.
struct PartCounts
{
  Index cells = 0;
  Index points = 0;     ///< that the rank owns
  Index freePoints = 0; ///< of these, those that move in a sweep
  Index haloPoints = 0; ///< DistributedMesh::haloPoints()
  Index neighbours = 0; ///< DistributedMesh::neighbours()
  Index messages = 0; ///< sent in a sweep: after each independent set one to each rank with a copy
  Index sentPoints = 0; ///< in these messages: a free point counts once for each rank with a copy
};

/// Counts of all parts.
struct DecompositionCounts
{
  std::vector<PartCounts> parts;
  Index sets = 0; ///< independent sets of the free points, each followed by an exchange
  /// Points that move one after the other in a sweep where ranks wait for each other after each
  /// set: the sum over the sets of the largest number that a rank has.
  Index slowestPoints = 0;
  Index points = 0, freePoints = 0; ///< of the whole mesh, those in cells
};

/**
 * @brief Counts what LocalSweeper would send with these parts on as many ranks, without ghost
 * cells.
 * @param partOfCell one number per cell, 0 to parts - 1; a part may have no cell
 * @param parts at least 1
 * @param free one flag per point: it moves
 *
 * Owners, halos and independent sets are those of DistributedMesh. Memory and time grow with the
 * mesh and the borders between the parts. Throws Error for numbers out of range.
 */
TAUTLINE_KERNEL_EXPORT DecompositionCounts countDecomposition(const MeshView& view,
  const std::vector<int>& partOfCell, int parts, const std::vector<unsigned char>& free);
}
#endif
