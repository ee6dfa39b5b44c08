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
/// A position in a triangle: the weights of its corners, and the squared distance from the point.
struct TrianglePlace
{
  std::array<double, 3> weights = { 1, 0, 0 };
  double distance2 = 0;
};

/// The point of a triangle closest to x (C. Ericson, "Real-time collision detection", 5.1.5).
TrianglePlace closestInTriangle(const std::array<Vec3, 3>& p, const Vec3& x);

/// Keeps marks of visited triangles, so it is not thread-safe.
class TriangleLocator
{
public:
  /// The maximum number of triangles visited in the search for a point.
  static constexpr int MaxVisited = 300;
  /// The number of consecutive triangles that are not closer after which the nearest one is
  /// accepted if the search began near it.
  static constexpr int Patience = 24;

  /// @param mesh the input; both must outlive this object
  TriangleLocator(const TriangleMesh& mesh, const TriangleInput& input)
    : Mesh(mesh)
    , Input(input)
    , Marks(mesh.slots(), 0)
  {
  }

  /**
   * @brief Searches triangles around `start`, of its region and patch, closest first.
   * @param patience ends after this many consecutive triangles that are not closer or already
   *   visited
   */
  TriId nearest(const Vec3& x, TriId start, TrianglePlace& best, int patience = MaxVisited) const;

  /**
   * @brief Walks from `start` to the triangle that contains x, in a plane, even through walls; on a
   * surface, or if a border is in the way, to the nearest one.
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
