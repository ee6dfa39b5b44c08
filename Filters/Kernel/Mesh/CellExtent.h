// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellExtent.h
 * @brief The sizes of cells that are computed with as they are, and the unit of others.
 */
#ifndef tautline_CellExtent_h
#define tautline_CellExtent_h

#include <algorithm>
#include <cmath>

namespace tautline
{
/**
 * @brief Cells whose longest extent along an axis is between these, 5e-20 and 2e19, are computed
 * with in the unit of the mesh. Products of twelve lengths of others could overflow or vanish.
 */
constexpr double SmallestExtent = 0x1p-64, LargestExtent = 0x1p64;

/// The power of two to divide coordinates by where cells extend so far: 1 if it is between the
/// limits above, 0 or not finite.
inline double unitOfExtent(double extent)
{
  constexpr int farthest = 1022; // so that its reciprocal is normal, too
  const bool usual = extent > SmallestExtent && extent < LargestExtent;
  return usual || !(extent > 0) || !std::isfinite(extent)
    ? 1.0
    : std::ldexp(1.0, std::max(-farthest, std::min(farthest, std::ilogb(extent))));
}
}
#endif
