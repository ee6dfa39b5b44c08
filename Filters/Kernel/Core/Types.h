// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Types.h
 * @brief Small types shared by all parts of the kernel: indices, vectors, errors.
 */
#ifndef tautline_Types_h
#define tautline_Types_h

#include "tautline/KernelExport.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace tautline
{
/// Point, cell and connectivity indices; the type of VTK's 64-bit cell arrays.
using Index = std::int64_t;

constexpr double Pi = 3.14159265358979323846;
constexpr double DegreesPerRadian = 180 / Pi;

/// A point or vector of the plane, x y.
using Vec2 = std::array<double, 2>;

/// A point or vector, x y z.
using Vec3 = std::array<double, 3>;

inline Vec3 operator+(const Vec3& a, const Vec3& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}
inline Vec3 operator-(const Vec3& a, const Vec3& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}
inline Vec3 operator*(double s, const Vec3& a)
{
  return { s * a[0], s * a[1], s * a[2] };
}
inline Vec3& operator+=(Vec3& a, const Vec3& b)
{
  a = a + b;
  return a;
}
inline Vec3& operator-=(Vec3& a, const Vec3& b)
{
  a = a - b;
  return a;
}
inline double dot(const Vec3& a, const Vec3& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 cross(const Vec3& a, const Vec3& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}
inline double norm(const Vec3& a)
{
  return std::sqrt(dot(a, a));
}

inline Vec2 operator+(const Vec2& a, const Vec2& b)
{
  return { a[0] + b[0], a[1] + b[1] };
}
inline Vec2 operator-(const Vec2& a, const Vec2& b)
{
  return { a[0] - b[0], a[1] - b[1] };
}
inline Vec2 operator*(double s, const Vec2& a)
{
  return { s * a[0], s * a[1] };
}
inline double dot(const Vec2& a, const Vec2& b)
{
  return a[0] * b[0] + a[1] * b[1];
}
inline double cross(const Vec2& a, const Vec2& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// Thrown by the kernel for invalid input. The message states the problem and a remedy.
class Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};
}
#endif
