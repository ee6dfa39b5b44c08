// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleQuality.h
 * @brief The quality of one triangle that reconnection maximizes.
 *
 * q is the sine of the smallest angle: with D twice the area and edges of lengths u >= v >= w, q =
 * D / (u v). It is sqrt(3) / 2 for the regular triangle, 0 for a degenerate one, and negative for
 * an inverted one of a planar mesh. The mean ratio 2 sqrt(3) D / (u^2 + v^2 + w^2) is at least 2 q
 * / sqrt(3), so that it need not be part of the quality.
 *
 * In metrics, it is the mean ratio of the triangle in the mean of the metrics of its corners.
 * Internal: not installed.
 */
#ifndef tautline_TriangleQuality_h
#define tautline_TriangleQuality_h

#include "tautline/Adaptation/MetricTensor.h"
#include "tautline/Core/Types.h"
#include "tautline/Geometry/Predicates.h"

#include <algorithm>

namespace tautline
{
/// 2 sqrt(3): normalizes the mean ratio of the regular triangle to 1.
constexpr double TriangleMeanRatioFactor = 3.4641016151377544;

/// Below this quality, the sign of the area in a plane is determined by the exact predicate.
constexpr double CertainTriangle = 1e-9;
/// The same for the mean ratio in a metric, which may be much larger than the Euclidean one.
constexpr double CertainInMetric = 1e-6;

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

/// The quality; in a plane, it is positive if and only if the area is, by the exact predicate.
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

/// A symmetric tensor in the coordinates of two directions: xx, xy and yy.
using PlaneTensor = std::array<double, 3>;

/// The mean ratio in a metric of a planar triangle, with two edges u and v in their order.
inline double planeMeanRatio(const Vec2& u, const Vec2& v, const PlaneTensor& m)
{
  const auto square = [&m](const Vec2& e)
  { return m[0] * e[0] * e[0] + 2.0 * m[1] * e[0] * e[1] + m[2] * e[1] * e[1]; };
  const double area2 = u[0] * v[1] - u[1] * v[0];
  const double sum = square(u) + square(v) + square({ v[0] - u[0], v[1] - u[1] });
  const double determinant = std::max(m[0] * m[2] - m[1] * m[1], 0.0);
  return sum > 0.0 ? TriangleMeanRatioFactor * area2 * std::sqrt(determinant) / sum : 0.0;
}

/// The mean ratio in the mean of the metrics of the corners; in a plane, it is positive if and only
/// if the area is, by the exact predicate.
inline double metricQuality(const Vec3& a, const Vec3& b, const Vec3& c, const MetricTensor& ma,
  const MetricTensor& mb, const MetricTensor& mc, bool planar)
{
  const auto mean = [&](int k) { return (ma[k] + mb[k] + mc[k]) / 3.0; };
  const Vec3 u = b - a, v = c - a;
  if (planar)
  {
    const double q = planeMeanRatio({ u[0], u[1] }, { v[0], v[1] }, { mean(0), mean(3), mean(1) });
    if (std::abs(q) > CertainInMetric)
    {
      return q;
    }
    constexpr double tiny = 1e-300;
    const auto flat = [](const Vec3& x) { return Vec2{ x[0], x[1] }; };
    return orientation(flat(a), flat(b), flat(c)) > 0 ? std::max(q, tiny) : std::min(q, 0.0);
  }
  const MetricTensor m = { mean(0), mean(1), mean(2), mean(3), mean(4), mean(5) };
  // The matrix of the inner products of two edges.
  const double uu = squaredLength(u, m), vv = squaredLength(v, m), ww = squaredLength(v - u, m);
  const double uv = 0.5 * (uu + vv - ww);
  const double sum = uu + vv + ww;
  return sum > 0.0 ? TriangleMeanRatioFactor * std::sqrt(std::max(uu * vv - uv * uv, 0.0)) / sum
                   : 0.0;
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
