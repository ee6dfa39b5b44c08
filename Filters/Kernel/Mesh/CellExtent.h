// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellExtent.h
 * @brief The cell sizes that need no scaling, and the unit for other sizes.
 */
#ifndef tautline_CellExtent_h
#define tautline_CellExtent_h

#include <algorithm>
#include <cmath>

namespace tautline
{
/**
 * @brief Cells whose longest extent along an axis is between these, 5e-20 and 2e19, are processed
 * in mesh units. For other cells, products of twelve lengths could overflow or underflow.
 */
constexpr double SmallestExtent = 0x1p-64, LargestExtent = 0x1p64;

/// The power of two by which to divide coordinates of cells of this extent: 1 if it is between the
/// limits above, 0, or not finite.
inline double unitOfExtent(double extent)
{
  constexpr int farthest = 1022; // so that its reciprocal is also a normal number
  const bool usual = extent > SmallestExtent && extent < LargestExtent;
  return usual || !(extent > 0) || !std::isfinite(extent)
    ? 1.0
    : std::ldexp(1.0, std::max(-farthest, std::min(farthest, std::ilogb(extent))));
}
}
#endif
