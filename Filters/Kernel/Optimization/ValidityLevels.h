// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ValidityLevels.h
 * @brief The degree of validity of each element.
 * Internal: not installed.
 */
#ifndef tautline_ValidityLevels_h
#define tautline_ValidityLevels_h

#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/// The degree of validity of an element; must not decrease.
enum ValidityLevel : signed char
{
  InvalidCorners = 0, ///< or not measured
  ValidCorners = 1,   ///< but invalid in between
  ValidThroughout = 2
};

/// Writes a ValidityLevel per cell.
void findValidityLevels(const Mesh& mesh, int threads, std::vector<signed char>& levels);
}
#endif
