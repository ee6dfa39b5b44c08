// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FlatParts.h
 * @brief The points of a surface that global methods may move.
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
  std::vector<unsigned char> held; ///< one flag per point: nonzero if it is fixed; empty if none is
};

/**
 * @brief The constraints of the options: points on flat patches, and on straight curves between
 * such patches, of a model or of the surface slide there. The surface then covers the same region
 * as long as the elements are valid, which the caller must ensure. Other points are held, as are
 * all points on another geometry.
 */
TAUTLINE_KERNEL_EXPORT PointSlides slidesOf(const Mesh& mesh, const OptimizeOptions& options);
}
#endif
