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
 * @brief One flag per point: nonzero on an edge (2D) or face (3D) that is not shared by exactly two
 * cells. Only the first of several cells with the same points is used.
 *
 * Each facet has a random 64-bit number, whose sign changes with the orientation of the facet. At
 * each point, the numbers of its facets are summed and, without sign, combined by exclusive or;
 * both results vanish if each facet occurs twice, with opposite orientations, so that no sorting is
 * needed. If only one of them vanishes (duplicate cells, inconsistent point orders), and for
 * surfaces, on which more than two cells often meet, Mesh::boundary() is used. In planar and volume
 * meshes, a boundary point is missed with probability 2^-60, or if its facets have two cells on
 * each side.
 */
TAUTLINE_KERNEL_EXPORT std::vector<char> boundaryPoints(const Mesh& mesh, int threads = 1);

/// A cell with the same points as one with a smaller id.
struct DuplicateCell
{
  Index cell;
  Index original; ///< the first cell with these points
};

/// The result of findSkin().
struct MeshSkin
{
  std::vector<char> boundaryPoints; ///< as returned by boundaryPoints()
  /// In increasing order; of supported types and the mesh dimension; quadratic cells by their
  /// corners.
  std::vector<DuplicateCell> duplicates;
  /// Whether, at each point, the two uses of a facet have opposite orientations. If not, there are
  /// duplicate cells, cells with opposite point orders, or overlapping parts of the mesh, see
  /// findOverlap().
  bool consistent = true;
};

/**
 * @brief The boundary points and the duplicate cells. Interior duplicates that cancel out at each
 * of their facets are missed: pairs of duplicates of one cell with opposite orientations.
 */
TAUTLINE_KERNEL_EXPORT MeshSkin findSkin(const Mesh& mesh, int threads = 1);
}
#endif
