// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VtkNodes.h
 * @brief The order of the nodes of VTK's Lagrange, Bezier and quadratic cells.
 * Internal: not installed.
 */
#ifndef tautline_VtkNodes_h
#define tautline_VtkNodes_h

#include "ElementShape.h"
#include "tautline/Core/Types.h"

#include <vector>

namespace tautline
{
/// The order p along each axis of a shape.
ElementOrders uniformOrders(ElementShape shape, int p);

/// The number of nodes of a Lagrange cell.
int latticeSize(ElementShape shape, const ElementOrders& orders);

/// The reference coordinates of the nodes of a Lagrange cell (except pyramids): vertices, then the
/// inner nodes of edges, of faces, of the cell.
std::vector<Vec3> latticeNodes(ElementShape shape, const ElementOrders& orders);

/// Sets of corners.
using CornerPatterns = std::vector<std::vector<int>>;

/// The edges of a cell, in the order of the quadratic cells; not for pyramids.
CornerPatterns edgePatterns(ElementShape shape);

/// The corners, then the mean of each set of corners.
std::vector<Vec3> meansOf(const std::vector<Vec3>& corners, const CornerPatterns& patterns);
}
#endif
