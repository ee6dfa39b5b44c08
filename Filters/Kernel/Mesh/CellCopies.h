// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellCopies.h
 * @brief Overlapping parts of a mesh: copies of cells, and cells on the same side of a facet.
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
 * direction: one is a copy of the other, possibly starting from another point.
 * @param type of both; no copies if it is not supported
 * @param a, b the points of each cell, as many as the type has
 * @param reversed whether all facets must be traversed in opposite directions instead
 */
TAUTLINE_KERNEL_EXPORT bool sameFacets(
  CellType type, const Index* a, const Index* b, bool reversed = false);

/**
 * @brief Flags the cells that are copies of another one with a smaller id; empty if there are none.
 * @param placeOf per point: the same for coincident points
 * @param several per point: nonzero if others coincide with it; only cells with such a point are
 * compared
 * @param reversed, ghosts one flag per cell or null, as for findCoincidentPoints(): ghosts are
 * neither copies nor copied
 */
std::vector<unsigned char> findCopies(const Mesh& mesh, const std::vector<Index>& placeOf,
  const std::vector<char>& several, const unsigned char* reversed, const unsigned char* ghosts);

/// Facets with two cells on the same side.
struct Overlap
{
  Index facets = 0;
  Index first = -1; ///< the smallest point of these facets; -1 if there are none
};

/**
 * @brief The facets of exactly two cells, both valid, on the same side, in planar and volume
 * meshes: there, the mesh overlaps itself although its boundary appears closed.
 * @param validity of the cells, from Mesh::classifyCells(); for a mesh without valid cells
 * (mirrored), the inverted ones are used
 * @param counted one flag per point: nonzero to use facets with this smallest point; or null
 */
TAUTLINE_KERNEL_EXPORT Overlap findOverlap(
  const Mesh& mesh, const signed char* validity, const unsigned char* counted = nullptr);
}
#endif
