// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SegmentDistance.h
 * @brief Squared distances between segments in the plane.
 * Internal: not installed.
 */
#ifndef tautline_SegmentDistance_h
#define tautline_SegmentDistance_h

#include "tautline/Core/Types.h"

#include <algorithm>

namespace tautline
{
/// The squared distance of the point p from the segment a-b.
inline double squaredDistance(Vec2 p, Vec2 a, Vec2 b)
{
  const Vec2 e = b - a;
  const double length = dot(e, e);
  const double t = length > 0.0 ? std::clamp(dot(p - a, e) / length, 0.0, 1.0) : 0.0;
  const Vec2 d = p - (a + t * e);
  return dot(d, d);
}

/// The squared distance between the segments a-b and c-d, 0 if they cross.
inline double squaredSegmentDistance(Vec2 a, Vec2 b, Vec2 c, Vec2 d)
{
  const double c1 = cross(b - a, c - a), c2 = cross(b - a, d - a);
  const double c3 = cross(d - c, a - c), c4 = cross(d - c, b - c);
  if (c1 * c2 < 0.0 && c3 * c4 < 0.0)
  {
    return 0.0;
  }
  return std::min({ squaredDistance(a, c, d), squaredDistance(b, c, d), squaredDistance(c, a, b),
    squaredDistance(d, a, b) });
}
}
#endif
