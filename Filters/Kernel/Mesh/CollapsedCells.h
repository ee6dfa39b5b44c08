// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CollapsedCells.h
 * @brief Hexahedra, wedges, pyramids and quadrilaterals that list points more than once, converted
 * to the remaining shapes.
 *
 * Files of solvers with one element type write a wedge as a hexahedron with two collapsed edges,
 * and similarly pyramids and tetrahedra. The Jacobian of the hexahedron vanishes there, although
 * the element is valid.
 * Internal: not installed.
 */
#ifndef tautline_CollapsedCells_h
#define tautline_CollapsedCells_h

#include "Mesh.h"

namespace tautline
{
/**
 * @brief The shape formed by the remaining faces of a cell when repeated nodes are identified: a
 * face with two distinct nodes vanishes, as do two faces that traverse the same nodes in opposite
 * directions.
 * @param type of the cell
 * @param nodes as many as the type has; receives the nodes of the result in its local numbering,
 * with the orientation of the given cell
 * @return the given type if no node is listed twice; Unsupported, with the nodes unchanged, if no
 * cell type has these faces; triangles and tetrahedra have no other shape
 */
TAUTLINE_KERNEL_EXPORT CellType remainingShape(CellType type, Index* nodes);

/// A cell that lists points more than once.
struct CollapsedCell
{
  Index cell = 0;
  CellType given = CellType::Unsupported;
  CellType remaining = CellType::Unsupported; ///< Unsupported if it stays unchanged
};

/// The cells of a mesh with collapsed cells replaced by their remaining shapes.
struct CollapsedCells
{
  std::vector<CollapsedCell> found; ///< in increasing order of cells, without simplices
  /// All cells, in the layout of a MeshView; empty if none is replaced. Higher-order cells keep
  /// their order, with their corners first.
  std::vector<unsigned char> types;
  std::vector<Index> offsets, connectivity;
};

/// Finds the cells that list points more than once, other than triangles and tetrahedra.
TAUTLINE_KERNEL_EXPORT CollapsedCells findCollapsedCells(const Mesh& mesh, int threads = 0);
}
#endif
