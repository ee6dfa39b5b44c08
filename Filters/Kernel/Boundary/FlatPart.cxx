// SPDX-License-Identifier: BSD-3-Clause
#include "FlatPart.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// The largest distance of a flat part from its plane, or of a straight part from its line, as a
/// fraction of its size and of the surface tolerance.
constexpr double ofSize = 1e-6, ofTolerance = 1e-3;

/// Calls visit(x) with the corners and control points of all pieces of a part.
template <class Visit>
void forEachPoint(const SurfacePart& part, const Visit& visit)
{
  for (const auto& piece : part.pieces)
  {
    std::for_each(piece.begin(), piece.end(), visit);
  }
  constexpr int ofArc = 2;
  for (const CubicControls& controls : part.controls)
  {
    std::for_each(controls.begin(), part.curve ? controls.begin() + ofArc : controls.end(), visit);
  }
}

}

//------------------------------------------------------------------------------
bool isFlatPart(const SurfacePart& part, double surfaceTolerance, Vec3& direction)
{
  const auto directionOf = [&part](const std::array<Vec3, 3>& piece)
  {
    const auto& [a, b, c] = piece;
    return part.curve ? b - a : cross(b - a, c - a);
  };
  Vec3 largest = { 0, 0, 0 };
  for (const auto& piece : part.pieces)
  {
    const Vec3 d = directionOf(piece);
    largest = dot(d, d) > dot(largest, largest) ? d : largest;
  }
  // The sum is less affected by coordinate rounding than one term, for any order of the corners.
  Vec3 origin = { 0, 0, 0 };
  direction = { 0, 0, 0 };
  for (const auto& piece : part.pieces)
  {
    const Vec3 d = directionOf(piece);
    direction += (dot(d, largest) < 0 ? -1.0 : 1.0) * d;
    origin += (1.0 / static_cast<double>(part.pieces.size())) * piece[0];
  }
  const double length = norm(direction);
  if (!(length > 0))
  {
    return false;
  }
  direction = (1.0 / length) * direction;
  double size = 0, off = 0;
  forEachPoint(part,
    [&](const Vec3& x)
    {
      const Vec3 d = x - origin;
      size = std::max(size, norm(d));
      off = std::max(off, part.curve ? norm(cross(d, direction)) : std::abs(dot(d, direction)));
    });
  const double most = ofSize * size;
  return off <= (surfaceTolerance > 0 ? std::min(most, ofTolerance * surfaceTolerance) : most);
}
}
