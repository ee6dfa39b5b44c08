// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Perturb.h
 * @brief Moves vertices at random, with or without inverting elements.
 *
 * Example: test meshes as in dissertation section 2.7.2, with half of the interior vertices moved
 * by less than half the distance to inversion.
 *
 *     tautline::PerturbOptions options;
 *     options.percentage = 50;
 *     const tautline::Perturbation result = tautline::perturb(mesh, nullptr, options);
 *     // result.points, result.moved
 */
#ifndef tautline_Perturb_h
#define tautline_Perturb_h

#include "PerturbOptions.h"
#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/**
 * @brief Moves a percentage of the movable vertices, one after the other in the order of
 * PerturbOptions::ids.
 *
 * The movable vertices are the interior vertices of the cells of the mesh dimension, except
 * vertices on the boundary, on a cell of another kind (a 2D cell in a volume mesh is an interface;
 * lines, polygons and polyhedra are not guarded), on a cell with NaN coordinates, and vertices with
 * a nonzero `fixed` flag.
 *
 * Each goes in a random direction: in space; in the plane of a planar mesh; in the tangent plane of
 * the surrounding cells on a surface. The distance to inversion is the smallest distance at which a
 * corner Jacobian of a surrounding cell changes its sign, with the other vertices at their current
 * positions. It is exact: each determinant is linear in one vertex. On a surface, a cell inverts if
 * it rotates by 90 degrees from its original orientation. If no sign changes (only possible around
 * inverted elements), it is the distance of the farthest vertex of these cells. No cell changes
 * from valid to degenerate or inverted.
 *
 * Then, while fewer elements than tangledFraction are inverted, movable vertices in random order
 * are moved past the distance to inversion, choosing among the intervals between sign changes
 * within the size of the surrounding cells. They never invert more elements than needed and never
 * create degenerate ones. The fraction is met to the nearest element unless this many elements
 * cannot be inverted with the other vertices fixed (usually above 0.8).
 *
 * Vertices and directions are drawn per vertex and seed. For one seed, the vertices moved at a
 * lower percentage are among those moved at a higher one.
 *
 * @param fixed one flag per point: nonzero if fixed; may be null
 *
 * Throws Error for options out of range and for cells of higher order.
 */
TAUTLINE_KERNEL_EXPORT Perturbation perturb(
  const Mesh& mesh, const unsigned char* fixed, const PerturbOptions& options);
}
#endif
