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

/**
 * @brief Turns the faces of cells so that each edge of a cell is run in both senses: those of a
 * cell that has such an order already stay, others are turned so that its volume is positive.
 * @param first the cells from this one on
 * @param points 3 coordinates per point
 * @return how many cells are open: they have an edge that is not one of two of their faces; they
 * stay as they are
 */
TAUTLINE_KERNEL_EXPORT Index turnFaces(
  ListedFaces& list, Index first, const double* points, int threads = 0);

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
