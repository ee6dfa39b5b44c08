// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CornerPoints.h
 * @brief The points that cells of a mesh have as corners.
 * Internal: not installed.
 */
#ifndef tautline_CornerPoints_h
#define tautline_CornerPoints_h

#include "Mesh.h"

namespace tautline
{
/**
 * @brief One flag per point: a corner of a supported cell.
 * @param dimension of the cells that count, 2 or 3; 0 for all
 * @param threads the most that are used; 0 means all
 */
TAUTLINE_KERNEL_EXPORT std::vector<char> cornerPoints(
  const Mesh& mesh, int dimension, int threads = 1);
}
#endif
