// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PeridynamicsGeometry.h
 * @brief Triangles with boxes around them, and the search for those near another. Internal to the
 * kernel: not installed.
 */
#ifndef tautline_PeridynamicsGeometry_h
#define tautline_PeridynamicsGeometry_h

#include "Horizon.h"

#include <array>

namespace tautline
{
/// The mesh with all triangles counter-clockwise, with the area and the box of each.
struct PlanarTriangles
{
  std::vector<Vec2> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<double> areas;
  std::vector<Vec2> low, high; ///< corners of the bounding boxes
  double shortestEdge = 0.0;
  bool flipped = false; ///< corners 1 and 2 of every triangle are exchanged

  /// Throws Error for a mesh that cannot be integrated over.
  TAUTLINE_SOLVERS_EXPORT explicit PlanarTriangles(const HorizonMesh& mesh);
  Index size() const { return static_cast<Index>(this->triangles.size()); }
  Vec2 corner(Index t, int k) const { return this->points[this->triangles[t][k]]; }
};

/// Boxes sorted into a grid, to find those near another.
class BoxGrid
{
public:
  BoxGrid(const std::vector<Vec2>& low, const std::vector<Vec2>& high);
  /// All boxes at most `reach` from the given one, in an order that depends on the grid alone.
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
