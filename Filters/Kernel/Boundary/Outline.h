// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Outline.h
 * @brief The curves and corners of an outline made of lines.
 * Internal: not installed.
 */
#ifndef tautline_Outline_h
#define tautline_Outline_h

#include "tautline/Mesh/Features.h"

namespace tautline
{
/**
 * @brief The lines and polylines of a mesh as curves. A point is a corner if the number of lines
 * that end there is not two, or if two lines meet there at more degrees than the angle.
 */
Features outlineFeatures(const MeshView& view, double angle);
}
#endif
