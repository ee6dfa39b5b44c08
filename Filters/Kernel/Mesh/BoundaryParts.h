// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryParts.h
 * @brief The connected parts of the boundary of a mesh: its outside, and each hole.
 */
#ifndef tautline_BoundaryParts_h
#define tautline_BoundaryParts_h

#include "Ranks.h"

namespace tautline
{
struct BoundaryParts
{
  /// One per point: 0 inside, else the number of its part. Part 1 has the largest box around it,
  /// then 2, ...
  std::vector<int> part;
  int parts = 0;
  /// One flag per part (part 1 first): it has the largest box of the parts of its component of the
  /// mesh.
  std::vector<char> outer;
};

/**
 * @brief Parts are connected by the facets (edges of 2D cells, faces of 3D cells) that one cell
 * uses. Of two of the same size the one with the smallest point number is first. Cells of lower
 * dimension than others do not count. On several ranks, which is collective, per local point.
 */
TAUTLINE_KERNEL_EXPORT BoundaryParts boundaryParts(const Mesh& mesh, const Ranks& ranks = {});
}
#endif
