// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LinearProgram.h
 * @brief Linear programs in a few variables (R. Seidel, "Small-dimensional linear programming and
 * convex hulls made easy", Discrete Comput. Geom. 6, 1991), and the Chebyshev center of
 * half-spaces.
 * Internal: not installed.
 */
#ifndef tautline_LinearProgram_h
#define tautline_LinearProgram_h

#include "tautline/Core/Types.h"

#include <array>
#include <vector>

namespace tautline
{
/// The half-space a . x <= b in K variables.
template <int K>
struct HalfSpace
{
  std::array<double, K> a;
  double b;
};

/**
 * @brief The Chebyshev center: the center of the largest ball in all half-spaces. For Dim 2 and 3.
 * @param planes a . x <= b with normals a of length 1
 * @param reach no coordinate of the center exceeds it in magnitude
 * @return the radius; negative if no point is in all half-spaces: the center then violates none by
 * more than its magnitude
 */
template <int Dim>
TAUTLINE_KERNEL_EXPORT double chebyshevCenter(
  const std::vector<HalfSpace<Dim>>& planes, double reach, std::array<double, Dim>& center);
}
#endif
