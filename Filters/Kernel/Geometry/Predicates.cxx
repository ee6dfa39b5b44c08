// SPDX-License-Identifier: BSD-3-Clause
#include "Predicates.h"

#include <vector>

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
// Bounds of the rounding of the determinants below (J. R. Shewchuk, "Adaptive precision
// floating-point arithmetic and fast robust geometric predicates", Discrete Comput. Geom. 18,
// 1997).
constexpr double Epsilon = 0.5 * std::numeric_limits<double>::epsilon();
constexpr double OrientationBound = (3.0 + 16.0 * Epsilon) * Epsilon;
constexpr double OrientationBound3D = (7.0 + 56.0 * Epsilon) * Epsilon;
constexpr double CircleBound = (10.0 + 96.0 * Epsilon) * Epsilon;

int sign(double x)
{
  return (x > 0.0) - (x < 0.0);
}

/// A number as a sum of doubles of increasing magnitude that do not overlap.
using Expansion = std::vector<double>;

/// a + b = sum + error, exactly.
void twoSum(double a, double b, double& sum, double& error)
{
  // Knuth's algorithm, which needs no order of the magnitudes of a and b.
  sum = a + b;
  const double bVirtual = sum - a;
  error = (a - (sum - bVirtual)) + (b - bVirtual);
}

/// e + b, exactly.
void add(Expansion& e, double b)
{
  Expansion result;
  result.reserve(e.size() + 1);
  double carry = b;
  for (double component : e)
  {
    double sum, error;
    twoSum(carry, component, sum, error);
    if (error != 0.0)
    {
      result.push_back(error);
    }
    carry = sum;
  }
  if (carry != 0.0)
  {
    result.push_back(carry);
  }
  e = std::move(result);
}

/// a + factor b, exactly.
Expansion plus(Expansion a, const Expansion& b, double factor = 1.0)
{
  for (double component : b)
  {
    add(a, factor * component); // the factor is 1 or -1
  }
  return a;
}

/// a b, exactly: each product with its rounding error.
Expansion times(const Expansion& a, const Expansion& b)
{
  Expansion result;
  for (double x : a)
  {
    for (double y : b)
    {
      // A fused multiply-add yields the rounding error of the product exactly.
      const double product = x * y;
      add(result, std::fma(x, y, -product));
      add(result, product);
    }
  }
  return result;
}

Expansion difference(double a, double b)
{
  Expansion result;
  add(result, a);
  add(result, -b);
  return result;
}

int sign(const Expansion& e)
{
  return e.empty() ? 0 : sign(e.back());
}
}

int orientation(const Vec2& a, const Vec2& b, const Vec2& c)
{
  const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
  const double det = left - right;
  // Fast filter: the error bound is proportional to the sum of the absolute terms.
  if (std::abs(det) > OrientationBound * (std::abs(left) + std::abs(right)))
  {
    return sign(det);
  }
  // Within the rounding error bound: use the sign of the exact determinant.
  return sign(plus(times(difference(a[0], c[0]), difference(b[1], c[1])),
    times(difference(a[1], c[1]), difference(b[0], c[0])), -1.0));
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3* points[3] = { &b, &c, &d };
  double det = 0.0, permanent = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const Vec3 &p = *points[i], &q = *points[(i + 1) % 3], &r = *points[(i + 2) % 3];
    const double height = p[2] - a[2];
    const double left = (q[0] - a[0]) * (r[1] - a[1]), right = (q[1] - a[1]) * (r[0] - a[0]);
    det += height * (left - right);
    permanent += std::abs(height) * (std::abs(left) + std::abs(right));
  }
  if (std::abs(det) > OrientationBound3D * permanent)
  {
    return sign(det);
  }
  // Within the rounding error bound: compute the same sum exactly.
  Expansion exact;
  for (int i = 0; i < 3; ++i)
  {
    const Vec3 &p = *points[i], &q = *points[(i + 1) % 3], &r = *points[(i + 2) % 3];
    const Expansion minor = plus(times(difference(q[0], a[0]), difference(r[1], a[1])),
      times(difference(q[1], a[1]), difference(r[0], a[0])), -1.0);
    exact = plus(std::move(exact), times(difference(p[2], a[2]), minor));
  }
  return sign(exact);
}

int inCircle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
{
  const Vec2* points[3] = { &a, &b, &c };
  // Points are lifted to the paraboloid z = x^2 + y^2 around d: the volume of the lifted
  // tetrahedron has the sign of the test.
  double det = 0.0, permanent = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const Vec2 &p = *points[i], &q = *points[(i + 1) % 3], &r = *points[(i + 2) % 3];
    const double px = p[0] - d[0], py = p[1] - d[1], lift = px * px + py * py;
    const double left = (q[0] - d[0]) * (r[1] - d[1]), right = (q[1] - d[1]) * (r[0] - d[0]);
    det += lift * (left - right);
    permanent += lift * (std::abs(left) + std::abs(right));
  }
  if (std::abs(det) > CircleBound * permanent)
  {
    return sign(det);
  }
  // Within the rounding error bound: compute the same sum exactly.
  Expansion exact;
  for (int i = 0; i < 3; ++i)
  {
    const Vec2 &p = *points[i], &q = *points[(i + 1) % 3], &r = *points[(i + 2) % 3];
    const Expansion px = difference(p[0], d[0]), py = difference(p[1], d[1]);
    const Expansion lift = plus(times(px, px), times(py, py));
    const Expansion minor = plus(times(difference(q[0], d[0]), difference(r[1], d[1])),
      times(difference(q[1], d[1]), difference(r[0], d[0])), -1.0);
    exact = plus(std::move(exact), times(lift, minor));
  }
  return sign(exact);
}

bool segmentsMeet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
{
  // This test of the bounding boxes is also the exact answer for collinear segments.
  for (int x = 0; x < 2; ++x)
  {
    if (std::max(a[x], b[x]) < std::min(c[x], d[x]) || std::max(c[x], d[x]) < std::min(a[x], b[x]))
    {
      return false;
    }
  }
  // If their boxes meet, segments meet if neither lies strictly on one side of the line of the
  // other.
  return orientation(a, b, c) * orientation(a, b, d) <= 0 &&
    orientation(c, d, a) * orientation(c, d, b) <= 0;
}
}
