// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CoordinateOrder.h
 * @brief The order of the points of a mesh by their coordinates.
 */
#ifndef tautline_CoordinateOrder_h
#define tautline_CoordinateOrder_h

#include "DistributedMesh.h"

#include <vector>

namespace tautline
{
/**
 * @brief The position of each local point among all points of the mesh, 0 to globalPoints() - 1, in
 * the order of x, then y, then z, then its number. It depends on the coordinates alone. Collective.
 *
 * Ranks sort their points; samples of them divide the order into one range per rank.
 */
TAUTLINE_KERNEL_EXPORT std::vector<Index> coordinateOrder(const DistributedMesh& mesh);

/**
 * @brief The same for the points of the elements of a mesh on one process. Other points and
 * nonfinite points follow in the order of their numbers.
 * @param places of the points, three numbers each
 * @param representative the first of the points merged with each point, whose position it shares;
 * empty: no merged points
 */
TAUTLINE_KERNEL_EXPORT std::vector<Index> coordinateOrder(
  const Mesh& mesh, const double* places, const std::vector<Index>& representative);
}
#endif
