// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Unfold.h
 * @brief Makes hexahedra and wedges valid between their corners.
 * Internal: not installed.
 *
 * The other phases of untangling consider only the corners. Here, the free vertices of an invalid
 * element move along the gradient of its smallest determinant, in steps that make no other element
 * less valid.
 */
#ifndef tautline_Unfold_h
#define tautline_Unfold_h

#include "tautline/Mesh/Mesh.h"

#include <functional>

namespace tautline
{
/**
 * @brief Moves free points until all elements are valid or no step helps.
 * @param free one flag per point
 * @param points 3 per point, moved in place
 * @param validity per cell at these points; kept up to date
 * @param proceed called before each element; false ends the run
 */
void unfold(const Mesh& mesh, const std::vector<char>& free, std::vector<double>& points,
  std::vector<signed char>& validity, const std::function<bool()>& proceed);
}
#endif
