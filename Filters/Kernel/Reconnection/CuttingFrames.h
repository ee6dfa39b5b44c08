// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CuttingFrames.h
 * @brief The directions and positions of the planes that cut a mesh into blocks.
 * Internal: not installed.
 */
#ifndef tautline_CuttingFrames_h
#define tautline_CuttingFrames_h

#include "tautline/Core/VectorAlgebra.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tautline
{
/**
 * @class tautline::CuttingFrame
 * @brief Three orthogonal directions; no two directions of different frames are parallel. The
 * planes of the next frame cross the walls of the previous one.
 */
class CuttingFrame
{
public:
  /// The number of frames.
  static constexpr int count = 3;

  /// @param frame 0 to count - 1; 0: the coordinate axes
  explicit CuttingFrame(int frame)
  {
    if (frame == 0)
    {
      return;
    }
    const Vec3 a = unit(frame == 1 ? Vec3{ 1, 1, 1 } : Vec3{ -1, 1, 0.5 });
    const Vec3 b = unit(cross(a, frame == 1 ? Vec3{ 0, 0, 1 } : Vec3{ 0, 1, 1 }));
    this->Directions = { a, b, cross(a, b) };
  }

  /// The position of a point along a direction.
  double along(int direction, const Vec3& x) const { return dot(this->Directions[direction], x); }

  bool before(int direction, const Vec3& a, const Vec3& b) const
  {
    return this->along(direction, a) < this->along(direction, b);
  }

  /// The extent of points along a direction. There must be at least one.
  double extent(
    int direction, std::vector<Vec3>::iterator from, std::vector<Vec3>::iterator to) const
  {
    const auto ends = std::minmax_element(
      from, to, [&](const Vec3& a, const Vec3& b) { return this->before(direction, a, b); });
    return this->along(direction, *ends.second - *ends.first);
  }

private:
  static Vec3 unit(const Vec3& v) { return (1.0 / norm(v)) * v; }

  std::array<Vec3, 3> Directions = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
};
}
#endif
