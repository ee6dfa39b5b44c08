// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FlatPart.h
 * @brief Detects flat patches and straight curves.
 * Internal: not installed.
 */
#ifndef tautline_FlatPart_h
#define tautline_FlatPart_h

#include "SurfaceModel.h"

namespace tautline
{
/**
 * @brief Whether a patch is flat, or a curve straight, to a millionth of its size and, if that is
 * above 0, to a thousandth of the surface tolerance.
 * @param direction receives the unit normal or direction
 */
bool isFlatPart(const SurfacePart& part, double surfaceTolerance, Vec3& direction);
}
#endif
