// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FlatParts.h
 * @brief Which points of a surface a method that moves all points at once may move.
 * Internal: not installed.
 */
#ifndef tautline_FlatParts_h
#define tautline_FlatParts_h

#include "OptimizeOptions.h"
#include "tautline/Boundary/SurfaceModel.h"

#include <vector>

namespace tautline
{
/// Linear constraints of points.
struct PointSlides
{
  /// 3 per point: normals and directions of any length, 0 for none; empty if there are none.
  std::vector<double> planes, lines;
  std::vector<unsigned char> held; ///< one flag per point: it stays; empty if none does
};

/**
 * @brief The constraints of the options: of points that slide on a model or on the surface, those
 * on flat patches and on straight curves between such patches slide there. While the elements are
 * valid, which the caller has to see to, the surface then covers the same places. The other ones
 * are held, and so are all those on another geometry.
 */
TAUTLINE_KERNEL_EXPORT PointSlides slidesOf(const Mesh& mesh, const OptimizeOptions& options);
}
#endif
