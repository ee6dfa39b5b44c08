// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Outline.h
 * @brief The curves and corners of an outline of lines.
 * Internal: not installed.
 */
#ifndef tautline_Outline_h
#define tautline_Outline_h

#include "tautline/Mesh/Features.h"

namespace tautline
{
/**
 * @brief The lines and polylines of a mesh as curves. A point where more or fewer than two lines
 * end, or two of more degrees than the angle meet, is a corner.
 */
Features outlineFeatures(const MeshView& view, double angle);
}
#endif
