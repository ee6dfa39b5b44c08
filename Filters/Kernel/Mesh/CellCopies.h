// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellCopies.h
 * @brief Parts of a mesh on top of each other: copies of cells, and cells on one side of a facet.
 * Internal: not installed.
 */
#ifndef tautline_CellCopies_h
#define tautline_CellCopies_h

#include "Mesh.h"

#include <vector>

namespace tautline
{
/**
 * @brief Whether two cells have the same facets (edges in 2D, faces in 3D), traversed in the same
 * sense: one is a copy of the other, which may begin with another point.
 * @param type of both; no copies if it is not supported
 * @param a, b as many points each as the type has
 * @param reversed whether all facets shall be traversed in opposite senses instead
 */
TAUTLINE_KERNEL_EXPORT bool sameFacets(
  CellType type, const Index* a, const Index* b, bool reversed = false);

/**
 * @brief Flags the cells that are copies of another one with a smaller id; empty if there are none.
 * @param placeOf per point: the same for points at the same place
 * @param several per point, nonzero where others are at its place: only cells with such a point
 * are compared
 * @param reversed, ghosts one flag per cell or null, as for findCoincidentPoints(): a ghost is no
 * copy and has none
 */
std::vector<unsigned char> findCopies(const Mesh& mesh, const std::vector<Index>& placeOf,
  const std::vector<char>& several, const unsigned char* reversed, const unsigned char* ghosts);

/// Facets of two cells on the same side.
struct Overlap
{
  Index facets = 0;
  Index first = -1; ///< the smallest point of these; -1 without one
};

/**
 * @brief The facets of exactly two cells, both valid, that are on the same side of it, in planar
 * and volume meshes: there the mesh overlaps itself, though its boundary seems to be closed.
 * @param validity of the cells, as Mesh::classifyCells() gives it; of a mesh without a valid cell
 * (mirrored) the inverted ones count
 * @param counted one flag per point, nonzero where a facet with this smallest point counts; or null
 */
TAUTLINE_KERNEL_EXPORT Overlap findOverlap(
  const Mesh& mesh, const signed char* validity, const unsigned char* counted = nullptr);
}
#endif
