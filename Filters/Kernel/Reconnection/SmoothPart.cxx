// SPDX-License-Identifier: BSD-3-Clause
#include "SmoothPart.h"

namespace tautline
{
namespace
{
SurfacePart facetsOf(const SurfacePart& part)
{
  SurfacePart facets;
  facets.curve = part.curve;
  facets.pieces = part.pieces;
  return facets;
}
}

SmoothPart::SmoothPart(const SurfacePart& part, double distance)
  : Facets(facetsOf(part), nullptr)
  , Smooth(part, nullptr)
  , Distance(distance)
{
}

bool SmoothPart::accepts(const std::array<Vec3, 3>& corner, const Vec3& normal, double cosine) const
{
  const auto& [a, b, c] = corner;
  // Use the mean normal: slivers of the input may have any orientation.
  Vec3 below = { 0, 0, 0 }, direction;
  std::int32_t piece = -1;
  for (const Vec3& x : { (1.0 / 3.0) * (a + b + c), 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a) })
  {
    // The negated comparison also rejects NaN.
    if (!(norm(this->Facets.closest(x, direction, piece) - x) <= this->Distance))
    {
      return false;
    }
    below += direction;
  }
  return dot(normal, below) >= cosine * norm(normal) * norm(below);
}
}
