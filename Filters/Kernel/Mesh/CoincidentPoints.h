// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CoincidentPoints.h
 * @brief Coincident points that separate neighboring cells: the seams of a mesh in pieces.
 */
#ifndef tautline_CoincidentPoints_h
#define tautline_CoincidentPoints_h

#include "Mesh.h"

namespace tautline
{
/// The result of findCoincidentPoints().
struct CoincidentPoints
{
  /// One per point: the smallest id of the points merged with it, or its own. Empty if no points
  /// are merged.
  std::vector<Index> representative;
  Index merged = 0; ///< points whose representative is another point
  Index facets = 0; ///< pairs of boundary facets that become one interior facet each
  Index seams = 0;  ///< connected sets of these facets
  Index first = -1; ///< the smallest merged point; -1 if there is none
  Index copies = 0; ///< cells that are copies of another cell, if requested
  // Pairs (or more) of coincident facets that stay separate:
  Index crowded = 0;     ///< three or more cells would share a facet
  Index overlapping = 0; ///< two cells on the same side of the facet, or with opposite point orders
  Index collapsing = 0;  ///< a cell would have a point twice
  Index firstApart = -1; ///< the smallest point of those facets; -1 if there is none

  bool any() const { return this->merged > 0; }
  Index apart() const { return this->crowded + this->overlapping + this->collapsing; }
};

/**
 * @brief Finds points with the same coordinates whose merge would join two boundary facets (edges
 * of 2D cells, faces of 3D cells).
 *
 * Coordinates are compared exactly; 0 and -0 are equal. Only corners of supported cells are used.
 * Points that coincide without matching facets, as where two parts touch at a corner, stay
 * separate. So do facets whose merge would make a cell degenerate, a facet of three or more cells,
 * or, in planar and volume meshes, a facet with both cells on one side (overlapping copies of a
 * mesh). The result does not depend on the order of the cells. Time and memory are linear in the
 * number of points, and in the number of facets on seams up to a logarithm.
 * @param reversed one flag per cell: nonzero if its points are in the opposite order; may be null.
 * The side of a facet on which a cell lies follows from the order of its points, so that inverted
 * elements are on the side of the valid ones.
 * @param threads the maximum number of threads; 0: all cores
 * @param ghosts one flag per cell: nonzero if it is a copy of a cell of another piece and has no
 * facets; may be null. Its points are merged with the points of a coincident cell, or of its other
 * copies; otherwise with the single point, if any, that other cells have at the same location.
 * @param copies if not null, coincident cells with the same orientation are copies, as where pieces
 * overlap: they share the points of the first one and have no facets, like ghosts. It receives one
 * flag per cell, nonzero for all except the first, or is empty without copies. Cells with the same
 * points are included if other points coincide with theirs. The points of 2D cells next to 3D cells
 * are then also merged with the single point, if any, that 3D cells have at the same location.
 */
TAUTLINE_KERNEL_EXPORT CoincidentPoints findCoincidentPoints(const Mesh& mesh,
  const unsigned char* reversed = nullptr, int threads = 1, const unsigned char* ghosts = nullptr,
  std::vector<unsigned char>* copies = nullptr);

/// The number of flagged cells that do not coincide with an unflagged cell: cells of other pieces
/// of the mesh, which is incomplete here. Only supported cells are counted.
TAUTLINE_KERNEL_EXPORT Index countForeignCells(const Mesh& mesh, const unsigned char* ghosts);

/**
 * @brief The number of boundary points that are near another one without coinciding: within
 * `tolerance` times the shortest boundary edge, and without a common cell.
 * @param boundary one flag per point: nonzero on the boundary
 * @param first set to the smallest of them, if there are any
 */
TAUTLINE_KERNEL_EXPORT Index countNearPoints(const Mesh& mesh, const std::vector<char>& boundary,
  Index* first = nullptr, double tolerance = 1e-3);
}
#endif
