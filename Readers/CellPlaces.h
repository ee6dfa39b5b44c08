// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellPlaces.h
 * @brief The positions of the nodes of VTK's cells, of order 1 and higher, on the lattice of an
 * order. Internal: not installed.
 */
#ifndef tautline_CellPlaces_h
#define tautline_CellPlaces_h

#include "MeshFile.h"

#include <array>

namespace tautline
{
/// A position in an element: its reference coordinates as multiples of 1 / order.
using LatticePoint = std::array<int, 3>;

/**
 * @brief The order of a cell with the same order along all axes.
 * @return 0 for other cells: pyramids, polygons, Lagrange cells with other numbers of nodes
 */
int cellOrder(unsigned char type, Index nodes);

/**
 * @brief The positions of the nodes of a cell, in VTK's order, for a cell with cellOrder() above 0.
 *
 * For linear and quadratic wedges, in the coordinates of a wedge whose first triangle runs
 * counterclockwise as seen from the second one, as in other programs and in VTK's Lagrange wedges:
 * VTK lists these triangles in the opposite order.
 */
std::vector<LatticePoint> cellPlaces(unsigned char type, Index nodes);

/// VTK's linear cell with the corners of a cell; the corners come first in both.
unsigned char linearType(unsigned char type);
}
#endif
