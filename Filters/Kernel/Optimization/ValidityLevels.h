// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ValidityLevels.h
 * @brief How much of each element is valid.
 * Internal: not installed.
 */
#ifndef tautline_ValidityLevels_h
#define tautline_ValidityLevels_h

#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/// How much of an element is valid; must not fall.
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
