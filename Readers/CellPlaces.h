// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellPlaces.h
 * @brief Where VTK's cells of order 1 and more have their nodes: on the lattice of an order.
 * Internal: not installed.
 */
#ifndef tautline_CellPlaces_h
#define tautline_CellPlaces_h

#include "MeshFile.h"

#include <array>

namespace tautline
{
/// A place in an element: the multiples of 1 / order of its reference coordinates.
using LatticePoint = std::array<int, 3>;

/**
 * @brief The order of a cell with the same order along all axes.
 * @return 0 for other cells: pyramids, polygons, Lagrange cells with other numbers of nodes
 */
int cellOrder(unsigned char type, Index nodes);

/**
 * @brief The places of the nodes of a cell, in VTK's order, for a cell with cellOrder() above 0.
 *
 * Of linear and quadratic wedges in the coordinates of a wedge whose first triangle runs
 * counter-clockwise as seen from the second one, as those of other programs and VTK's Lagrange
 * wedges do: VTK lists these triangles in the opposite order.
 */
std::vector<LatticePoint> cellPlaces(unsigned char type, Index nodes);

/// VTK's linear cell with the corners of a cell, which come first in both.
unsigned char linearType(unsigned char type);
}
#endif
