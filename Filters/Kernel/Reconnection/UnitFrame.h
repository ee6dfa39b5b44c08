// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UnitFrame.h
 * @brief Plane coordinates in which a metric is the identity.
 * Internal: not installed.
 */
#ifndef tautline_UnitFrame_h
#define tautline_UnitFrame_h

#include "TriangleQuality.h"

#include <limits>

namespace tautline
{
/// A tensor in the coordinates of two directions.
inline PlaneTensor planeTensor(const MetricTensor& m, const Vec3& first, const Vec3& second)
{
  const auto applied = [&m](const Vec3& e)
  {
    return Vec3{ m[0] * e[0] + m[3] * e[1] + m[5] * e[2], m[3] * e[0] + m[1] * e[1] + m[4] * e[2],
      m[5] * e[0] + m[4] * e[1] + m[2] * e[2] };
  };
  const Vec3 a = applied(first), b = applied(second);
  return { dot(first, a), dot(second, a), dot(second, b) };
}

/**
 * @brief With the Cholesky factor L of the metric in a plane, M = L L^T, the coordinates of a
 * vector e of the plane are y = L^T e; their Euclidean length is the length in the metric.
 */
class UnitFrame
{
public:
  /// @param first, second orthonormal
  UnitFrame(const MetricTensor& metric, const Vec3& first, const Vec3& second)
    : First(first)
    , Second(second)
  {
    const PlaneTensor m = planeTensor(metric, first, second);
    this->A = std::sqrt(m[0]);
    this->B = m[1] / this->A;
    this->C = std::sqrt(std::max(m[2] - this->B * this->B, std::numeric_limits<double>::min()));
  }

  /// The coordinates of the in-plane part of a vector; z is 0.
  Vec3 leave(const Vec3& e) const
  {
    const double x = dot(e, this->First), y = dot(e, this->Second);
    return { this->A * x + this->B * y, this->C * y, 0.0 };
  }
  /// The vector with these coordinates.
  Vec3 enter(const Vec3& y) const
  {
    const double second = y[1] / this->C;
    return ((y[0] - this->B * second) / this->A) * this->First + second * this->Second;
  }
  /// A tensor in these coordinates: L^-1 M L^-T.
  PlaneTensor turned(const MetricTensor& metric) const
  {
    const PlaneTensor m = planeTensor(metric, this->First, this->Second);
    const double a = 1.0 / this->A, c = 1.0 / this->C, b = -this->B * a * c;
    // L^-1 has the rows (a, 0) and (b, c).
    const double xy = a * (m[0] * b + m[1] * c);
    return { a * a * m[0], xy, b * b * m[0] + 2.0 * b * c * m[1] + c * c * m[2] };
  }

private:
  Vec3 First, Second;
  double A = 1, B = 0, C = 1; ///< L has the rows (A, 0) and (B, C)
};
}
#endif
