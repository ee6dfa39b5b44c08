// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CollapsedCells.h
 * @brief Hexahedra, wedges, pyramids and quadrilaterals that list points more than once, taken as
 * the shapes that remain of them.
 * Internal: not installed.
 *
 * Files of solvers with one element type write a wedge as a hexahedron two of whose edges have
 * their ends at one point, and pyramids and tetrahedra likewise. The Jacobian of the hexahedron
 * vanishes there, although the element is as good as others.
 */
#ifndef tautline_CollapsedCells_h
#define tautline_CollapsedCells_h

#include "Mesh.h"

namespace tautline
{
/**
 * @brief The shape of the faces that remain of a cell when nodes that it lists more than once are
 * one: a face with two distinct nodes vanishes, and so do two faces that walk round the same nodes
 * in opposite senses.
 * @param type of the cell
 * @param nodes as many as the type has; gets the nodes of the result in its own numbering, with the
 * orientation of the given cell
 * @return the given type if no node is listed twice; Unsupported, with the nodes unchanged, if no
 * cell type has these faces; triangles and tetrahedra have no other shape
 */
TAUTLINE_KERNEL_EXPORT CellType remainingShape(CellType type, Index* nodes);

/// A cell that lists points more than once.
struct CollapsedCell
{
  Index cell = 0;
  CellType given = CellType::Unsupported;
  CellType remaining = CellType::Unsupported; ///< Unsupported if it stays as it is given
};

/// The cells of a mesh with collapsed ones replaced by what remains of them.
struct CollapsedCells
{
  std::vector<CollapsedCell> found; ///< in increasing order of cells, without simplices
  /// Of all cells, in the layout of a MeshView; empty if none is replaced. Cells of higher order
  /// stay of higher order, their corners first.
  std::vector<unsigned char> types;
  std::vector<Index> offsets, connectivity;
};

/// Finds the cells that list points more than once, other than triangles and tetrahedra.
TAUTLINE_KERNEL_EXPORT CollapsedCells findCollapsedCells(const Mesh& mesh, int threads = 0);
}
#endif
