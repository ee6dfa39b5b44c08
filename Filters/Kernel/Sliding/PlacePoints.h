// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlacePoints.h
 * @brief Puts points that were free in a band back on what they slide on.
 * Internal: not installed.
 */
#ifndef tautline_PlacePoints_h
#define tautline_PlacePoints_h

#include "BoundaryTerms.h"
#include "SlidingCells.h"

#include <functional>

namespace tautline
{
/// How far points are from the parts that they slide on.
struct OffSurface
{
  Index points = 0; ///< that are not on their parts
  double distance = 0;
};

/**
 * @brief Puts the points that have moved on their parts, one after the other, each as near as the
 * cells about it allow.
 * @param start points where these have not moved stay
 * @param allows whether a cell may have these vertices
 */
void placeOnParts(const SlidingCells& cells, const ConstrainedPoints& constrained,
  BoundaryTerms& boundary, const std::vector<Vec3>& start, std::vector<Vec3>& x,
  const std::function<bool(std::int32_t cell, const Vec3* vertices)>& allows);

/// How far points in a band are from their parts; what is below a millionth of the tolerance is on
/// it.
OffSurface offSurface(const ConstrainedPoints& constrained, const std::vector<Vec3>& x);
}
#endif
