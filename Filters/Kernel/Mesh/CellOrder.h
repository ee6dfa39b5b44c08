// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellOrder.h
 * @brief Which cells of a mesh to list in the opposite order so that all agree.
 *
 * Many programs write cells whose points run in either sense. The cells then are as good as others;
 * only their order is not that of their neighbours. Neighbours tell by the facet they share,
 * however tangled the mesh is.
 */
#ifndef tautline_CellOrder_h
#define tautline_CellOrder_h

#include "Mesh.h"

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

/// Lists the corners of a cell in the order of its mirror image. Throws Error for
/// CellType::Unsupported.
TAUTLINE_KERNEL_EXPORT void reverseCell(CellType type, Index* nodes);
}
#endif
