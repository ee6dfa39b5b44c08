// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellOrder.h
 * @brief Which cells of a mesh to list in the opposite order so that all agree.
 * Internal: not installed.
 *
 * Many programs write cells whose points run in either sense. The cells then are as good as others;
 * only their order is not that of their neighbours. Neighbours tell by the facet they share,
 * however tangled the mesh is.
 */
#ifndef tautline_CellOrder_h
#define tautline_CellOrder_h

#include "RankPieces.h"

namespace tautline
{
/// What makes the order of the cells of a mesh consistent; found by consistentOrder().
struct CellOrder
{
  /// One per cell: nonzero if it is to be listed in the opposite order. Empty if none is.
  std::vector<unsigned char> reverse;
  Index reversed = 0; ///< cells to list in the opposite order
  Index cells = 0;    ///< cells of the mesh's dimension
  /// Connected parts that have no consistent order, as a Moebius band; the cells of these stay.
  Index ambiguous = 0;
  Index firstAmbiguous = -1; ///< a cell of one of them, or -1
};

/**
 * @brief Finds an order in which all neighbours agree, and each connected part of a planar or
 * volume mesh has a positive area or volume; of a part that has none, most valid cells stay valid.
 * A part whose cells agree is reversed only if all of them are inverted and they are many: a few
 * may be inverted elements that were cut out of a mesh. In a part of a surface most cells keep
 * their order. Cells that meet at an edge or face with more than two cells are not neighbours
 * there.
 * @param validity as Mesh::classifyCells() gives it
 */
TAUTLINE_KERNEL_EXPORT CellOrder consistentOrder(const Mesh& mesh, const signed char* validity);

/// The order of the cells of a mesh in pieces on ranks; found by consistentOrder().
struct RankOrder
{
  Orientation orientation; ///< of the whole mesh
  /// Of the whole mesh, without ghost cells; firstAmbiguous only where there is one rank.
  CellOrder order;
  /// Per piece: CellOrder::reverse, also of its ghost cells. Empty unless the orientation is Mixed.
  std::vector<std::vector<unsigned char>> reverse;
};

/**
 * @brief The orientation of a mesh in pieces on ranks, and the order of its cells. Collective.
 *
 * Points of different pieces, or of one, are one as RankPiece has it where they make two boundary
 * facets one. Two cells that walk round such a facet in one sense are neighbours in opposite orders
 * or overlap. Valid cells, as well as inverted ones, overlap, as they are on one side of it; but
 * cells in the opposite order may be inverted elements, too. Hence these are neighbours where the
 * other facets tell that the orders are opposite, or where most such facets are between a valid and
 * an inverted cell. Inside of a piece all cells with the same facet are neighbours.
 *
 * The first rank gets what is known of the parts of the pieces that are connected, and of each two
 * that meet, but no points and cells.
 * @param pieces with Mesh::setSpace() of the whole
 * @param validity as Mesh::classifyCells() gives it, of each piece
 */
TAUTLINE_KERNEL_EXPORT RankOrder consistentOrder(RankGroup& group,
  const std::vector<RankPiece>& pieces, const std::vector<const signed char*>& validity);

/// Lists the corners of a cell in the order of its mirror image. Throws Error for
/// CellType::Unsupported.
TAUTLINE_KERNEL_EXPORT void reverseCell(CellType type, Index* nodes);
}
#endif
