// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankPieces.h
 * @brief What is known of a mesh in pieces on several ranks that stay where they are: its plane and
 * its orientation.
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
  /// coordinates (0 and -0 are equal) are one.
  const Index* globalIds = nullptr;
};

/**
 * @brief The space that the whole mesh fills, as Mesh finds it of a mesh in one piece. Collective.
 *
 * A piece of a surface in space may be flat, and one of a volume mesh may have triangles only: with
 * Mesh::setSpace() it is measured as a part of the whole.
 */
TAUTLINE_KERNEL_EXPORT MeshSpace spaceOf(RankGroup& group, const std::vector<RankPiece>& pieces);

/**
 * @brief Mesh::orientation() of the whole mesh. Collective.
 *
 * Only what is on the boundary of the pieces is sent, and only if there are valid and inverted
 * cells; the first rank gets what is known of the connected parts of the pieces, and of each two
 * that meet. Points at the same place are one, without global ids also those of a crack.
 *
 * A facet has at most two cells, as in a manifold mesh. Where three or more meet, none of them are
 * neighbours there in one piece; but two of them in one piece are, if the others are in others. The
 * numbers of parts and of facets that disagree may then depend on how the mesh is cut.
 * @param pieces with Mesh::setSpace() of the whole
 * @param validity as Mesh::classifyCells() gives it, of each piece
 */
TAUTLINE_KERNEL_EXPORT Orientation orientation(RankGroup& group,
  const std::vector<RankPiece>& pieces, const std::vector<const signed char*>& validity);
}
#endif
