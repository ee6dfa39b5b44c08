// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlanarDelaunay.h
 * @brief A constrained Delaunay triangulation of points in the plane.
 * Internal: not installed.
 */
#ifndef tautline_PlanarDelaunay_h
#define tautline_PlanarDelaunay_h

#include "tautline/Core/Types.h"

#include <array>
#include <utility>
#include <vector>

namespace tautline
{
/**
 * @brief Triangulates the convex hull of points so that every given segment is an edge.
 *
 * Delaunay except for the segments: by insertion and flips; segments are recovered by the flips of
 * S. W. Sloan (Computers & Structures 47 (1993) 441-450). No two points may coincide, no two
 * segments cross, and no point lie on a segment. Throws Error otherwise.
 *
 * @param points x y each
 * @param segments pairs of point numbers
 * @return triangles, counterclockwise
 */
TAUTLINE_KERNEL_EXPORT std::vector<std::array<Index, 3>> constrainedDelaunay(
  const std::vector<double>& points, const std::vector<std::pair<Index, Index>>& segments);
}
#endif
