/**
 * @file BoundaryPoints.h
 * @brief The points on the boundary of a mesh, found without sorting its facets. Internal: not
 * installed.
 */
#ifndef tautline_BoundaryPoints_h
#define tautline_BoundaryPoints_h

#include "Mesh.h"

namespace tautline
{
/**
 * @brief One flag per point: on an edge (2D) or face (3D) that not exactly two cells share.
 *
 * Each facet has a random 64-bit number, and each point the exclusive or of those of its facets,
 * which vanishes where each occurs twice: no sorting. A boundary point is overlooked with
 * probability 2^-64, or if its facets belong to an even number of cells. Where nothing seems to be
 * boundary (every cell is there twice, or a closed surface), Mesh::boundary() is used.
 */
TAUTLINE_KERNEL_EXPORT std::vector<char> boundaryPoints(const Mesh& mesh);
}
#endif
