// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeDescriptors.h
 * @brief Descriptors of the surroundings of points in a silhouette.
 * Internal: not installed.
 */
#ifndef tautline_ShapeDescriptors_h
#define tautline_ShapeDescriptors_h

#include "Silhouette.h"

#include <array>

namespace tautline
{
/// The fraction of the shape in four disks around a point, with radii of 0.12, 0.25, 0.45 and 0.8
/// d_max; then the distance of the point from the center of mass, in units of d_max.
using Descriptor = std::array<float, 5>;

/// One descriptor per point; the points are in pixels.
std::vector<Descriptor> describe(const Silhouette& shape, const std::vector<Vec2>& points);
}
#endif
