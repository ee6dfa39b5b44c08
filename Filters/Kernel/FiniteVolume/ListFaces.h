// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ListFaces.h
 * @brief Lists the faces of cells for findFaces().
 */
#ifndef tautline_ListFaces_h
#define tautline_ListFaces_h

#include "FaceMesh.h"

namespace tautline
{
/// Appends a cell of a linear 3D type as a cell with its faces. @param nodes in VTK's order
TAUTLINE_KERNEL_EXPORT void listLinearCell(ListedFaces& list, CellType type, const Index* nodes);

/// The result of turnFaces().
struct TurnedCells
{
  /// Cells with an edge that does not belong to exactly two of their faces; they stay unchanged.
  Index open = 0;
  Index turned = 0; ///< cells whose faces did not agree
};

/**
 * @brief Reverses faces of cells so that each edge of a cell is traversed in both directions. Cells
 * that are already consistent stay unchanged; the others get a positive volume.
 * @param first the first cell to process
 * @param points 3 coordinates per point
 */
TAUTLINE_KERNEL_EXPORT TurnedCells turnFaces(
  ListedFaces& list, Index first, const double* points, int threads = 0);

/**
 * @brief Reverses the faces of some cells if the sum of their volumes is negative: VTK's CGNS
 * reader lists all faces as seen from inside.
 * @param some one flag per cell
 * @param each whether cells with a negative volume are reversed individually
 * @return the number of reversed cells
 */
TAUTLINE_KERNEL_EXPORT Index turnInsideOut(
  ListedFaces& list, const std::vector<char>& some, const double* points, bool each);

/// Reverses all faces, for a fully reversed mesh.
TAUTLINE_KERNEL_EXPORT void reverseFaces(ListedFaces& list);

/// Reverses all polygons if the sum of their areas is negative. @param points 3 coordinates per
/// point, of which the first two are used
TAUTLINE_KERNEL_EXPORT void turnPolygons(
  std::vector<std::vector<Index>>& cells, const double* points);

/**
 * @brief A plane mesh as one layer of prisms. The points above the mesh have the next numbers, in
 * the same order.
 * @param cells the corners of each cell, counterclockwise
 * @param facets the lower and the upper faces, of patches 0 and 1
 */
TAUTLINE_KERNEL_EXPORT ListedFaces extrude(
  Index points, const std::vector<std::vector<Index>>& cells, ListedFacets& facets);
}
#endif
