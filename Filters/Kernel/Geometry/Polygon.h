// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Polygon.h
 * @brief Constrained Delaunay triangulation of a simple polygon, without interior points.
 *
 * A polygon of n vertices becomes n - 2 triangles. The triangles and their shared diagonals form a
 * tree, which makes dynamic programming over the triangles possible (dissertation section 5.2.2):
 * leaf by leaf, a vertex with one remaining triangle is eliminated (a perfect elimination order).
 *
 *     const tautline::PolygonMesh mesh = tautline::triangulatePolygon(points);
 *     // mesh.triangles, mesh.elimination
 */
#ifndef tautline_Polygon_h
#define tautline_Polygon_h

#include "tautline/Core/Types.h"

#include <vector>

namespace tautline
{
/// The elimination of a vertex: its last triangle and its parents, the two other vertices of this
/// triangle.
struct EliminationStep
{
  Index triangle = 0;
  Index vertex = 0;
  Index parents[2] = { 0, 0 }; ///< in the triangle's order: vertex, parents[0], parents[1]
};

/// A triangulated polygon.
struct PolygonMesh
{
  std::vector<Vec2> points; ///< the polygon, counterclockwise
  /// Vertices of the n - 2 triangles, counterclockwise.
  std::vector<std::array<Index, 3>> triangles;
  /// The triangle across the edge opposite to each vertex of a triangle; -1 across the boundary.
  std::vector<std::array<Index, 3>> neighbours;
  /// Steps in order; the parents of the last one are the edge that is left.
  std::vector<EliminationStep> elimination;
};

/// Twice the area; positive if the polygon runs counterclockwise.
TAUTLINE_KERNEL_EXPORT double signedArea(const std::vector<Vec2>& polygon);

/// The center of mass of the area of a polygon; the mean of its vertices if the area is 0.
TAUTLINE_KERNEL_EXPORT Vec2 centreOfMass(const std::vector<Vec2>& polygon);

/// Whether no two edges have a point in common, except the shared vertex of adjacent edges; exact.
TAUTLINE_KERNEL_EXPORT bool isSimple(const std::vector<Vec2>& polygon);

/**
 * @brief The constrained Delaunay triangulation of a simple polygon, with its elimination order.
 *
 * Ear clipping, then edge flips; both with exact signs, so that the triangulation is Delaunay up to
 * the polygon's edges and every triangle has a positive area. A clockwise polygon is reversed.
 * O(n^2).
 *
 * Throws Error if the polygon has fewer than 3 vertices, a coordinate that is not finite,
 * intersects itself, or lies on a line.
 */
TAUTLINE_KERNEL_EXPORT PolygonMesh triangulatePolygon(std::vector<Vec2> polygon);
}
#endif
