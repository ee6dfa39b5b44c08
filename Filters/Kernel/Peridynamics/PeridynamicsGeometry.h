// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PeridynamicsGeometry.h
 * @brief Triangles with bounding boxes, and the search for nearby triangles.
 * Internal: not installed.
 */
#ifndef tautline_PeridynamicsGeometry_h
#define tautline_PeridynamicsGeometry_h

#include "Horizon.h"

#include <array>

namespace tautline
{
/// The mesh with all triangles counterclockwise, with the area and the box of each.
struct PlanarTriangles
{
  std::vector<Vec2> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  /// The positions of the corners of each triangle in HorizonMesh::triangles.
  std::vector<std::array<std::int32_t, 3>> sources;
  std::vector<double> areas;
  std::vector<Vec2> low, high; ///< corners of the bounding boxes
  double shortestEdge = 0.0;
  bool flipped = false; ///< whether corners 1 and 2 of every triangle are exchanged
  /// Set by sortByPlace(): coordinates relative to the minimum of the triangles, in multiples of
  /// `unit`.
  std::vector<std::array<Index, 2>> lattice;
  double unit = 0.0;

  /// Throws Error for a mesh that cannot be integrated over.
  TAUTLINE_SOLVERS_EXPORT explicit PlanarTriangles(const HorizonMesh& mesh);
  /**
   * @brief Lists the triangles, and the corners of each, in the order of their coordinates, x
   * before y, so that sums over them do not depend on the order of the mesh.
   *
   * Coordinates are compared as multiples of a unit far below every length: rounding has no effect,
   * and triangles that are congruent up to a translation begin with the same corner.
   */
  void sortByPlace();
  Index size() const { return static_cast<Index>(this->triangles.size()); }
  /// The number of a triangle in the mesh.
  Index source(Index t) const { return this->sources[t][0] / 3; }
  Vec2 corner(Index t, int k) const { return this->points[this->triangles[t][k]]; }
};

/// Boxes sorted into a grid, to find nearby boxes.
class BoxGrid
{
public:
  BoxGrid(const std::vector<Vec2>& low, const std::vector<Vec2>& high);
  /// All boxes within `reach` of the given one, in an order that only depends on the grid.
  void near(Vec2 low, Vec2 high, double reach, std::vector<std::int32_t>& found) const;

private:
  Index column(double x) const;
  Index row(double y) const;

  const std::vector<Vec2>&Low, &High;
  Vec2 Origin = {}, Cell = {}, LargestHalf = {};
  Index Columns = 1, Rows = 1;
  std::vector<std::int32_t> Starts, Boxes;
};
}
#endif
