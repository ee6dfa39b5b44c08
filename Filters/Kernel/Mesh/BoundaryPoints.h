// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryPoints.h
 * @brief The points on the boundary of a mesh, found without sorting its facets.
 * Internal: not installed.
 */
#ifndef tautline_BoundaryPoints_h
#define tautline_BoundaryPoints_h

#include "Mesh.h"

namespace tautline
{
/**
 * @brief One flag per point: on an edge (2D) or face (3D) that not exactly two cells share. Of
 * cells with the same points the first one counts.
 *
 * Each facet has a random 64-bit number, which changes its sign with the sense of walking round it.
 * At each point the numbers of its facets are added up, and combined by exclusive or without the
 * sign; both vanish where each facet occurs twice, in opposite senses: no sorting. Where only one
 * of them vanishes (duplicate cells, cells listed in opposite senses), and for surfaces, on which
 * more than two cells often meet, Mesh::boundary() is used. In planar and volume meshes a boundary
 * point is overlooked with probability 2^-60, or if its facets have two cells on each side.
 */
TAUTLINE_KERNEL_EXPORT std::vector<char> boundaryPoints(const Mesh& mesh, int threads = 1);

/// A cell with the same points as one with a smaller id.
struct DuplicateCell
{
  Index cell;
  Index original; ///< the first cell with these points
};

/// What findSkin() found.
struct MeshSkin
{
  std::vector<char> boundaryPoints; ///< as boundaryPoints() gives them
  /// In increasing order; of supported types and the mesh's dimension, quadratic ones by their
  /// corners.
  std::vector<DuplicateCell> duplicates;
  /// Whether at each point the two uses of a facet are in opposite senses. Else there are duplicate
  /// cells, cells listed in opposite senses, or parts of the mesh overlap, see findOverlap().
  bool consistent = true;
};

/**
 * @brief The boundary points and the duplicate cells. Overlooked are duplicates inside that cancel
 * out at each of their facets: pairs of duplicates of one cell, one in each sense.
 */
TAUTLINE_KERNEL_EXPORT MeshSkin findSkin(const Mesh& mesh, int threads = 1);
}
#endif
