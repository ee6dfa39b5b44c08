// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlaneDistance.h
 * @brief The distance between two points of an image.
 * Internal: not installed.
 */
#ifndef tautline_PlaneDistance_h
#define tautline_PlaneDistance_h

#include "tautline/Core/Types.h"

#include <cmath>

namespace tautline
{
inline double distance(const Vec2& a, const Vec2& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}
}
#endif
