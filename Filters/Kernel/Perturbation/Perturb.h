// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Perturb.h
 * @brief Moves vertices at random, with or without inverting elements.
 *
 * Example: test meshes like those of dissertation section 2.7.2, half of the interior vertices
 * moved by less than half the distance to inversion.
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
 * Movable are the vertices inside the mesh: those of the cells of its dimension, except vertices on
 * the boundary, on a cell of another kind (a 2D cell in a volume mesh is an interface; lines,
 * polygons and polyhedra are not guarded), on a cell with NaN coordinates, and those with a nonzero
 * `fixed`.
 *
 * Each goes in a random direction: in space; in the plane of a planar mesh; in the tangent plane of
 * the cells around it on a surface. The distance to inversion is the minimum at which a corner
 * Jacobian of a cell around it changes its sign, with the other vertices at their current places.
 * It is exact: each determinant is linear in one vertex. On a surface, a cell inverts where it
 * turns by 90 degrees from what it was. Where no sign changes (possible around inverted elements
 * only), it is the distance of the farthest vertex of those cells. No cell changes from valid to
 * degenerate or inverted.
 *
 * Then, while fewer elements than tangledFraction are inverted, movable vertices in random order go
 * past the distance to inversion, choosing among the intervals between sign changes within the size
 * of the cells around; never by more elements than are still needed, and without degenerate ones.
 * The fraction is met to the nearest element unless that many cannot be inverted with the other
 * vertices where they are (as a rule, above 0.8).
 *
 * Vertices and directions are drawn per vertex and seed. For one seed, the vertices moved at a
 * lower percentage are among those moved at a higher one.
 *
 * @param fixed one flag per point, nonzero: stays; may be null
 *
 * Throws Error on options out of range and on cells of higher order.
 */
TAUTLINE_KERNEL_EXPORT Perturbation perturb(
  const Mesh& mesh, const unsigned char* fixed, const PerturbOptions& options);
}
#endif
