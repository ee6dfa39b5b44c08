// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CoordinateOrder.h
 * @brief The order of the points of a mesh on several ranks by their coordinates.
 */
#ifndef tautline_CoordinateOrder_h
#define tautline_CoordinateOrder_h

#include "DistributedMesh.h"

#include <vector>

namespace tautline
{
/**
 * @brief The place of each local point among all points of the mesh, 0 to globalPoints() - 1, in
 * the order of x, then y, then z, then its number. It depends on the coordinates alone. Collective.
 *
 * Ranks sort their points; samples of them divide the order into one range per rank.
 */
TAUTLINE_KERNEL_EXPORT std::vector<Index> coordinateOrder(const DistributedMesh& mesh);
}
#endif
