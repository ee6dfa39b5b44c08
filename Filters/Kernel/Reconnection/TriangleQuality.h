// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleQuality.h
 * @brief The quality that reconnection maximizes, of one triangle.
 * Internal: not installed.
 *
 * q is the sine of the smallest angle: with D twice the area and edges of lengths u >= v >= w,
 * q = D / (u v). It is sqrt(3) / 2 for the regular triangle, 0 for a degenerate one, and negative
 * for an inverted one of a planar mesh. The mean ratio 2 sqrt(3) D / (u^2 + v^2 + w^2) is at least
 * 2 q / sqrt(3), so that it needs no place in the quality.
 */
#ifndef tautline_TriangleQuality_h
#define tautline_TriangleQuality_h

#include "tautline/Core/Types.h"
#include "tautline/Geometry/Predicates.h"

#include <algorithm>

namespace tautline
{
/// 2 sqrt(3): makes the mean ratio of the regular triangle 1.
constexpr double TriangleMeanRatioFactor = 3.4641016151377544;

/// Below this quality the sign of the area in a plane is that of the exact predicate.
constexpr double CertainTriangle = 1e-9;

struct TriangleMeasures
{
  double sine = 0;      ///< of the smallest angle
  double meanRatio = 0; ///< 1 for the regular triangle
};

/// @param planar whether the triangle is in the xy plane and has a sign
inline TriangleMeasures measureTriangle(const Vec3& a, const Vec3& b, const Vec3& c, bool planar)
{
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const double u = dot(ab, ab), v = dot(bc, bc), w = dot(ca, ca);
  const Vec3 n = cross(ab, c - a);
  const double area2 = planar ? n[2] : norm(n);
  const double shortest = std::min({ u, v, w });
  TriangleMeasures m;
  const double product = u * v * w;
  if (product > 0.0)
  {
    m.sine = area2 * std::sqrt(shortest / product);
    m.meanRatio = TriangleMeanRatioFactor * area2 / (u + v + w);
  }
  return m;
}

/// The quality; in a plane it is positive exactly if the area is, by the exact predicate.
inline double triangleQuality(const Vec3& a, const Vec3& b, const Vec3& c, bool planar)
{
  const double q = measureTriangle(a, b, c, planar).sine;
  if (!planar || std::abs(q) > CertainTriangle)
  {
    return q;
  }
  constexpr double tiny = 1e-300;
  const auto flat = [](const Vec3& x) { return Vec2{ x[0], x[1] }; };
  return orientation(flat(a), flat(b), flat(c)) > 0 ? std::max(q, tiny) : std::min(q, 0.0);
}

/// The smallest and the largest angle in degrees.
inline std::array<double, 2> triangleAngles(const Vec3& a, const Vec3& b, const Vec3& c)
{
  const auto angle = [](const Vec3& u, const Vec3& v)
  { return std::atan2(norm(cross(u, v)), dot(u, v)) * (180.0 / Pi); };
  const double x = angle(b - a, c - a), y = angle(c - b, a - b), z = angle(a - c, b - c);
  return { std::min({ x, y, z }), std::max({ x, y, z }) };
}
}
#endif
