// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizeField.h
 * @brief Sizes at points as a function of position.
 */
#ifndef tautline_SizeField_h
#define tautline_SizeField_h

#include <functional>
#include <vector>

namespace tautline
{
/**
 * @brief The size at a position x, y: the size of the nearest point plus the distance times
 * `gradation`.
 * @param points x y each; the function keeps a copy
 * @param sizes one per point
 */
std::function<double(double, double)> makeSizeField(
  const std::vector<double>& points, const std::vector<double>& sizes, double gradation);
}
#endif
