// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankPieces.h
 * @brief The plane and the orientation of a mesh in pieces on several ranks, without
 * redistribution.
 */
#ifndef tautline_RankPieces_h
#define tautline_RankPieces_h

#include "Mesh.h"
#include "tautline/Core/RankGroup.h"

#include <vector>

namespace tautline
{
/// A piece of a mesh. A rank may have none, one or several; all arrays are borrowed.
struct RankPiece
{
  const Mesh* mesh = nullptr;
  /// One flag per cell, nonzero for a copy of a cell of another piece (ghost); or null.
  const unsigned char* ghosts = nullptr;
  /// One id per point, the same for the same point; or null, for all pieces: points with the same
  /// coordinates (0 and -0 are equal) are identified.
  const Index* globalIds = nullptr;
};

/**
 * @brief The space that the whole mesh fills, as determined by Mesh for a mesh in one piece.
 * Collective.
 *
 * A piece of a surface in space may be flat, and a piece of a volume mesh may have only triangles:
 * with Mesh::setSpace(), it is measured as a part of the whole mesh.
 */
TAUTLINE_KERNEL_EXPORT MeshSpace spaceOf(RankGroup& group, const std::vector<RankPiece>& pieces);

/**
 * @brief Mesh::orientation() of the whole mesh. Collective.
 *
 * Only data on the boundary of the pieces is sent, and only if there are both valid and inverted
 * cells; the first rank receives data about the connected parts of the pieces and about each
 * adjacent pair. Coincident points are identified; without global ids, this includes the points of
 * a crack.
 *
 * A facet is assumed to have at most two cells, as in a manifold mesh. If three or more cells of
 * one piece meet at a facet, none of them are neighbors there; but two cells in one piece are
 * neighbors if the others are in other pieces. The numbers of parts and of disagreeing facets may
 * then depend on the decomposition.
 * @param pieces with Mesh::setSpace() for the whole mesh
 * @param validity from Mesh::classifyCells(), for each piece
 */
TAUTLINE_KERNEL_EXPORT Orientation orientation(RankGroup& group,
  const std::vector<RankPiece>& pieces, const std::vector<const signed char*>& validity);
}
#endif
