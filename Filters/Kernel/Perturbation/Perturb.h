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

#include "tautline/Mesh/Mesh.h"

#include <functional>
#include <vector>

namespace tautline
{
/// How many vertices move, how far, and how many elements are to be inverted.
struct PerturbOptions
{
  double percentage = 50.0; ///< of the movable vertices to move, 0 to 100
  /// A vertex moves by a random fraction, evenly from 0 to this (0 to 1), of its distance to
  /// inversion.
  double fraction = 0.5;
  double tangledFraction = 0.0; ///< of the elements to be inverted in the end, 0 to 1
  std::uint64_t seed = 0;
  bool singlePrecision = false; ///< new coordinates are rounded to float, and still do not invert
  int threads = 0;              ///< 0: all cores. The result does not depend on it.
  /// One number per point, at least 0, by which its random numbers and its turn are chosen, so that
  /// they do not depend on the order of the points; null: its index.
  const Index* ids = nullptr;
  /// Called now and then with the fraction done, 0 to 1; returns whether to continue. May be empty.
  std::function<bool(double)> progress;
};

/// The perturbed points, and a report.
struct Perturbation
{
  std::vector<double> points; ///< 3 per point of the mesh
  Index movable = 0;          ///< vertices that could move
  Index moved = 0;            ///< vertices whose coordinates changed
  Index elements = 0;         ///< elements with finite vertices, of which a fraction is tangled
  Index invertedBefore = 0;
  Index invertedAfter = 0;
  double largestDisplacement = 0;
  bool stopped = false; ///< progress() returned false; the points are those reached
};

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
