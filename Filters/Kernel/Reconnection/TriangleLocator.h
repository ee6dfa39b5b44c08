// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleLocator.h
 * @brief Finds the triangle of the input that contains a point, or is closest to it.
 * Internal: not installed.
 */
#ifndef tautline_TriangleLocator_h
#define tautline_TriangleLocator_h

#include "TriangleInput.h"

namespace tautline
{
/// A place in a triangle: the weights of its corners, and the squared distance from the point.
struct TrianglePlace
{
  std::array<double, 3> weights = { 1, 0, 0 };
  double distance2 = 0;
};

/// The point of a triangle closest to x (C. Ericson, "Real-time collision detection", 5.1.5).
TrianglePlace closestInTriangle(const std::array<Vec3, 3>& p, const Vec3& x);

/// Keeps marks of the triangles that it visits: not for several threads.
class TriangleLocator
{
public:
  /// Triangles visited in the search for a point.
  static constexpr int MaxVisited = 300;
  /// Triangles in a row that are not closer, after which the nearest one counts as found if the
  /// search began near it.
  static constexpr int Patience = 24;

  /// @param mesh the input; both have to live as long as this
  TriangleLocator(const TriangleMesh& mesh, const TriangleInput& input)
    : Mesh(mesh)
    , Input(input)
    , Marks(mesh.slots(), 0)
  {
  }

  /**
   * @brief Looks at triangles around `start`, of its region and patch, the closest ones first.
   * @param patience ends after this many triangles in a row that are not closer, or were visited
   */
  TriId nearest(const Vec3& x, TriId start, TrianglePlace& best, int patience = MaxVisited) const;

  /**
   * @brief Walks from `start` to the triangle that contains x, in a plane also through walls; on a
   * surface, and where a border is in the way, to the nearest one.
   */
  TriId walk(const Vec3& x, TriId start, TrianglePlace& place) const;

private:
  TrianglePlace placeIn(TriId t, const Vec3& x) const;

  const TriangleMesh& Mesh;
  const TriangleInput& Input;
  using Candidate = std::pair<double, TriId>;
  mutable std::vector<std::uint32_t> Marks; ///< per triangle: the last search that found it
  mutable std::uint32_t Search = 0;
  mutable std::vector<Candidate> Queue;
};
}
#endif
