// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellOrder.h
 * @brief Finds the cells of a mesh to reverse so that all orders agree.
 *
 * Many programs write cells with either point order. These cells are valid; only their order
 * differs from their neighbors. The shared facet of neighbors shows whether their orders agree,
 * even if the mesh is tangled.
 * Internal: not installed.
 */
#ifndef tautline_CellOrder_h
#define tautline_CellOrder_h

#include "RankPieces.h"

namespace tautline
{
/// A consistent order of the cells of a mesh; found by consistentOrder().
struct CellOrder
{
  /// One per cell: nonzero if it must be reversed. Empty if no cell must be reversed.
  std::vector<unsigned char> reverse;
  Index reversed = 0; ///< cells to reverse
  Index cells = 0;    ///< cells of the mesh dimension
  /// Connected parts without a consistent order, such as a Moebius strip; their cells stay
  /// unchanged.
  Index ambiguous = 0;
  Index firstAmbiguous = -1; ///< a cell of one of them, or -1
};

/**
 * @brief Finds an order in which all neighbors agree and each connected part of a planar or volume
 * mesh has a positive area or volume; in a part of zero size, most valid cells stay valid. A part
 * whose cells agree is reversed only if all of its cells are inverted and there are many: a few may
 * be inverted elements extracted from a mesh. In a part of a surface, most cells keep their order.
 * Cells that meet at an edge or face with more than two cells are not neighbors there.
 * @param validity from Mesh::classifyCells()
 */
TAUTLINE_KERNEL_EXPORT CellOrder consistentOrder(const Mesh& mesh, const signed char* validity);

/// The order of the cells of a mesh in pieces on ranks; found by consistentOrder().
struct RankOrder
{
  Orientation orientation; ///< of the whole mesh
  /// The order of the whole mesh, without ghost cells; firstAmbiguous only on one rank.
  CellOrder order;
  /// Per piece: CellOrder::reverse, also of its ghost cells. Empty unless the orientation is Mixed.
  std::vector<std::vector<unsigned char>> reverse;
};

/**
 * @brief The orientation of a mesh in pieces on ranks, and the order of its cells. Collective.
 *
 * Points of the same or different pieces are identified (see RankPiece) if they join two boundary
 * facets. Two cells that traverse such a facet in the same direction are either neighbors in
 * opposite orders or overlap. Two valid cells, or two inverted ones, overlap, because they are on
 * the same side; but cells in the opposite order may also be inverted elements. Therefore, they are
 * neighbors if the other facets show that the orders are opposite, or if most such facets are
 * between a valid and an inverted cell. Inside a piece, all cells with the same facet are
 * neighbors.
 *
 * The first rank receives data about the connected parts of the pieces and about each pair of
 * adjacent parts, but no points or cells.
 * @param pieces with Mesh::setSpace() for the whole mesh
 * @param validity from Mesh::classifyCells(), of each piece
 */
TAUTLINE_KERNEL_EXPORT RankOrder consistentOrder(RankGroup& group,
  const std::vector<RankPiece>& pieces, const std::vector<const signed char*>& validity);

/// Reorders the corners of a cell as in its mirror image. Throws Error for CellType::Unsupported.
TAUTLINE_KERNEL_EXPORT void reverseCell(CellType type, Index* nodes);
}
#endif
