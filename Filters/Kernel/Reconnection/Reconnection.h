// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Reconnection.h
 * @brief Improves the worst tetrahedra of a mesh by changing its connectivity and moving points.
 *
 * First, boundary facets are improved if the boundary may change: edges are swapped or contracted
 * and points moved to increase the mean ratios of facets, which bound the mean ratios of the
 * adjacent tetrahedra. Then operations are applied, worst tetrahedra first: removal of edges
 * (dynamic programming over the triangulations of a ring of at most 12 points; G. T. Klincsek,
 * "Minimal triangulations of polygonal domains", 1980), removal of several faces at once (J. R.
 * Shewchuk, "Two discrete optimization algorithms for the topological improvement of tetrahedral
 * meshes", 2002), contraction of edges, insertion of points into optimized cavities (B. M. Klingner
 * and J. R. Shewchuk, "Aggressive tetrahedral mesh improvement", IMR 2007), and motion of points.
 *
 * The quality of a tetrahedron is min(smallest sine of its dihedral angles, (mean ratio)^(3/2)), or
 * one of them (ReconnectionObjective). An operation is accepted if the qualities of the tetrahedra
 * it affects, in increasing order, become larger lexicographically. Thus, the worst quality and the
 * smallest dihedral angle of the mesh never decrease, and the largest inverse mean ratio never
 * increases. All tetrahedra stay positive according to an exact predicate.
 *
 * Example: all operations, with a fixed surface.
 *
 *     tautline::Mesh mesh(view);
 *     tautline::ReconnectionOptions options;
 *     tautline::ReconnectionResult result = tautline::improveConnectivity(mesh, options);
 *     // result.points, result.tetrahedra; result.history.back().smallestAngle
 */
#ifndef tautline_Reconnection_h
#define tautline_Reconnection_h

#include "ReconnectionOptions.h"
#include "ReconnectionResult.h"
#include "tautline/Mesh/Mesh.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief Improves the connectivity and the points of a tetrahedral mesh. The result is the same in
 * every run and for any number of threads, unless a limit ends it. Large meshes are processed in
 * blocks, see ReconnectionOptions::blockSize; only these use several threads. Memory: about 250
 * bytes per tetrahedron with the result, 360 with blocks.
 *
 * Throws Error, with a remedy, for cells that are not linear tetrahedra, for coordinates that are
 * not finite, for inverted or degenerate tetrahedra, and for faces used by three or more
 * tetrahedra, or by two on the same side (duplicates). Vertices and edges where the boundary is
 * nonmanifold are kept.
 * @param mesh oriented consistently (see Mesh::setMirrored()); not changed
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT ReconnectionResult improveConnectivity(
  const Mesh& mesh, const ReconnectionOptions& options);
}
#endif
