// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ListFaces.h
 * @brief The faces of cells as findFaces() needs them.
 */
#ifndef tautline_ListFaces_h
#define tautline_ListFaces_h

#include "FaceMesh.h"

namespace tautline
{
/// Appends a cell of a linear 3D type as a cell with its faces. @param nodes as VTK lists them
TAUTLINE_KERNEL_EXPORT void listLinearCell(ListedFaces& list, CellType type, const Index* nodes);

/// What turnFaces() finds.
struct TurnedCells
{
  /// Cells with an edge that is not one of two of their faces; they stay as they are.
  Index open = 0;
  Index turned = 0; ///< cells whose faces did not agree
};

/**
 * @brief Turns the faces of cells so that each edge of a cell is run in both senses: those of a
 * cell that has such an order already stay, others are turned so that its volume is positive.
 * @param first the cells from this one on
 * @param points 3 coordinates per point
 */
TAUTLINE_KERNEL_EXPORT TurnedCells turnFaces(
  ListedFaces& list, Index first, const double* points, int threads = 0);

/**
 * @brief Lists the faces of some cells in the opposite sense, if the sum of their volumes is
 * negative: VTK's reader of CGNS lists all as they are seen from inside.
 * @param some one flag per cell
 * @param each cells with a negative volume are turned, one by one
 * @return how many cells were turned
 */
TAUTLINE_KERNEL_EXPORT Index turnInsideOut(
  ListedFaces& list, const std::vector<char>& some, const double* points, bool each);

/// Lists all faces in the opposite sense: those of a mesh that is reversed throughout.
TAUTLINE_KERNEL_EXPORT void reverseFaces(ListedFaces& list);

/// Lists all polygons in the opposite sense where the sum of their areas is negative. @param points
/// 3 coordinates per point, of which the first two count
TAUTLINE_KERNEL_EXPORT void turnPolygons(
  std::vector<std::vector<Index>>& cells, const double* points);

/**
 * @brief A plane mesh as one layer of prisms. The points above the mesh have the next numbers, in
 * the same order.
 * @param cells of each cell its corners, counter-clockwise
 * @param facets the lower and the upper faces, of patches 0 and 1
 */
TAUTLINE_KERNEL_EXPORT ListedFaces extrude(
  Index points, const std::vector<std::vector<Index>>& cells, ListedFacets& facets);
}
#endif
