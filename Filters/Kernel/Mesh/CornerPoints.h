// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CornerPoints.h
 * @brief The points that are corners of cells of a mesh.
 * Internal: not installed.
 */
#ifndef tautline_CornerPoints_h
#define tautline_CornerPoints_h

#include "Mesh.h"

namespace tautline
{
/**
 * @brief One flag per point: nonzero for a corner of a supported cell.
 * @param dimension of the cells to use, 2 or 3; 0 for all
 * @param threads the most that are used; 0 means all
 */
TAUTLINE_KERNEL_EXPORT std::vector<char> cornerPoints(
  const Mesh& mesh, int dimension, int threads = 1);
}
#endif
