// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Predicates.h
 * @brief Signs of the orientation and in-circle determinants, exact for finite doubles.
 * Internal: not installed.
 *
 * A determinant is computed in doubles first; if it is smaller than the bound of its rounding error
 * (Shewchuk, Discrete & Computational Geometry 18, 1997), it is computed again as an unevaluated
 * sum of doubles, which is exact unless it overflows or underflows.
 */
#ifndef tautline_Predicates_h
#define tautline_Predicates_h

#include "tautline/Core/Types.h"

namespace tautline
{
/// 1 if a, b, c run counterclockwise, -1 if clockwise, 0 if they lie on a line.
TAUTLINE_KERNEL_EXPORT int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

/// The sign of ((b - a) x (c - a)) . (d - a): 1 for a tetrahedron in VTK's order, 0 if the points
/// lie in a plane.
TAUTLINE_KERNEL_EXPORT int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// 1 if d lies inside the circle through a, b, c (counterclockwise), 0 on it, -1 outside.
TAUTLINE_KERNEL_EXPORT int inCircle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

/// Whether the closed segments ab and cd have a point in common.
TAUTLINE_KERNEL_EXPORT bool segmentsMeet(
  const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);
}
#endif
