// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CoincidentPoints.h
 * @brief Points at the same place that separate neighbouring cells: the seams of a mesh in pieces.
 */
#ifndef tautline_CoincidentPoints_h
#define tautline_CoincidentPoints_h

#include "Mesh.h"

namespace tautline
{
/// What findCoincidentPoints() found.
struct CoincidentPoints
{
  /// One per point: the smallest id of the points that are one with it, or its own. Empty if no two
  /// points are one.
  std::vector<Index> representative;
  Index merged = 0; ///< points that have another representative than themselves
  Index facets = 0; ///< pairs of boundary facets that become one interior facet each
  Index seams = 0;  ///< connected sets of these facets
  Index first = -1; ///< the smallest merged point; -1 if there is none
  Index copies = 0; ///< cells that are copies of another one, where these are asked for
  // Pairs of facets, or more, at the same place that stay apart:
  Index crowded = 0;     ///< three or more cells would share a facet
  Index overlapping = 0; ///< two cells on the same side of the facet, or listed in opposite senses
  Index collapsing = 0;  ///< a cell would have a point twice
  Index firstApart = -1; ///< the smallest point of those facets; -1 if there is none

  bool any() const { return this->merged > 0; }
  Index apart() const { return this->crowded + this->overlapping + this->collapsing; }
};

/**
 * @brief Finds points that have the same coordinates and would make two boundary facets (edges of
 * 2D cells, faces of 3D cells) one if each pair of them were one point.
 *
 * Coordinates are compared exactly; 0 and -0 are equal. Only corners of supported cells count.
 * Points that coincide without matching facets, as where two parts touch at a corner, stay apart.
 * So do facets whose merge would make a cell degenerate, a facet of three or more cells, or, in
 * planar and volume meshes, a facet with both cells on one side (copies of a mesh on top of each
 * other). The result does not depend on the order of the cells. Time and memory are linear in the
 * number of points, and in the number of facets on seams up to a logarithm.
 * @param reversed one flag per cell: it lists its points in the opposite order; may be null. On
 * which side of a facet a cell is follows from the order of its points, so that inverted elements
 * are on the side of the valid ones.
 * @param threads the most that are used; 0 means all
 * @param ghosts one flag per cell: it is a copy of a cell of another piece and has no facets; may
 * be null. Its points are one with those of a cell at the same place, or of other copies of it;
 * else with the one point, if there is one, that other cells have at the same place.
 * @param copies if not null, cells at the places of another one, in the same sense, are copies of
 * it, as where pieces overlap: they share the points of the first of them, and have no facets, like
 * ghosts. It gets one flag per cell, nonzero for all but the first, or is empty
 * without copies. Cells with the same points count where other points are at the places of these.
 * The points of 2D cells beside 3D ones are then also one with the one point, if there is one, that
 * 3D cells have at the same place.
 */
TAUTLINE_KERNEL_EXPORT CoincidentPoints findCoincidentPoints(const Mesh& mesh,
  const unsigned char* reversed = nullptr, int threads = 1, const unsigned char* ghosts = nullptr,
  std::vector<unsigned char>* copies = nullptr);

/// The number of cells with a flag that have the places of no cell without one: those of other
/// pieces of the mesh, which is not here as a whole. Only supported cells count.
TAUTLINE_KERNEL_EXPORT Index countForeignCells(const Mesh& mesh, const unsigned char* ghosts);

/**
 * @brief The number of points of the boundary that are near another one but not at its place:
 * within `tolerance` times the shortest edge of the boundary, and of no common cell.
 * @param boundary one flag per point: on the boundary
 * @param first set to the smallest of them, if there are any
 */
TAUTLINE_KERNEL_EXPORT Index countNearPoints(const Mesh& mesh, const std::vector<char>& boundary,
  Index* first = nullptr, double tolerance = 1e-3);
}
#endif
