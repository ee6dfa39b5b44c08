// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetQuality.h
 * @brief The quality of a tetrahedron by its circumscribed sphere.
 * Internal: not installed.
 */
#ifndef tautline_TetQuality_h
#define tautline_TetQuality_h

#include "tautline/Core/Types.h"

#include <algorithm>

namespace tautline
{
/**
 * @brief The signed volume divided by the volume of the regular tetrahedron with the same
 * circumscribed sphere: 1 for the regular one, positive if (b - a) x (c - a) points to d.
 */
inline double tetQuality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  constexpr double least = 1e-150, largestRadius = 1e15;
  // The regular tetrahedron of circumradius 1 has the volume 8 / (9 sqrt 3).
  const double regular = 8 / (9 * std::sqrt(3.0));
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double six = dot(u, vw);
  const Vec3 toCenter = dot(u, u) * vw + dot(v, v) * wu + dot(w, w) * uv;
  const double radius = std::abs(2 * six) < least
    ? largestRadius
    : std::min(largestRadius, norm(toCenter) / std::abs(2 * six));
  return six / 6 / (regular * radius * radius * radius + least);
}
}
#endif
