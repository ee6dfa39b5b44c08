// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlacePoints.h
 * @brief Moves points that were free in a band back onto their surfaces or curves.
 * Internal: not installed.
 */
#ifndef tautline_PlacePoints_h
#define tautline_PlacePoints_h

#include "BoundaryTerms.h"
#include "SlidingCells.h"

#include <functional>

namespace tautline
{
/// The distances of points from the parts on which they slide.
struct OffSurface
{
  Index points = 0; ///< number of points that are not on their parts
  double distance = 0;
};

/**
 * @brief Moves the displaced points onto their parts, one after the other, each as close as the
 * surrounding cells allow.
 * @param start the initial points; points that have not moved from them stay
 * @param allows whether a cell may have these vertices
 */
void placeOnParts(const SlidingCells& cells, const ConstrainedPoints& constrained,
  BoundaryTerms& boundary, const std::vector<Vec3>& start, std::vector<Vec3>& x,
  const std::function<bool(std::int32_t cell, const Vec3* vertices)>& allows);

/// The distances of points in a band from their parts; a distance below a millionth of the
/// tolerance is treated as 0.
OffSurface offSurface(const ConstrainedPoints& constrained, const std::vector<Vec3>& x);
}
#endif
