// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryParts.h
 * @brief The connected parts of the boundary of a mesh: the outer boundary and each hole.
 */
#ifndef tautline_BoundaryParts_h
#define tautline_BoundaryParts_h

#include "Ranks.h"

namespace tautline
{
struct BoundaryParts
{
  /// One per point: 0 inside, otherwise the number of its part. Part 1 has the largest bounding
  /// box, then part 2, ...
  std::vector<int> part;
  int parts = 0;
  /// One flag per part (part 1 first): nonzero if it has the largest box in its component of the
  /// mesh.
  std::vector<char> outer;
};

/**
 * @brief Parts are connected by the facets (edges of 2D cells, faces of 3D cells) that one cell
 * uses. Ties in size are ordered by the smallest point number. Cells of lower dimension are
 * ignored. On several ranks, the call is collective, and the result is per local point.
 */
TAUTLINE_KERNEL_EXPORT BoundaryParts boundaryParts(const Mesh& mesh, const Ranks& ranks = {});
}
#endif
