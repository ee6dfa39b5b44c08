// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UntangleSliding.h
 * @brief Untangling of meshes whose boundary points slide.
 * Internal: not installed.
 */
#ifndef tautline_UntangleSliding_h
#define tautline_UntangleSliding_h

#include "PlacePoints.h"

namespace tautline
{
/// A state of an untangling.
struct SlidingState
{
  Index invalid;         ///< cells with an invalid corner
  double invertedVolume; ///< the sum of -D over inverted corners, in units of the mean edge
  double progress;       ///< 0 to 1
  const std::vector<Vec3>& points;
};

/**
 * @brief Untangles a planar or volume mesh: first with a weakly constrained boundary, in growing
 * neighborhoods of the invalid cells; if that fails, from the means of the neighbors; then returns
 * the boundary to the surface, and unfolds cells inside. Points that need not move stay bitwise
 * unchanged.
 * @param report called after each step; returns false to stop
 * @return 3 coordinates per point; the result may be no better than the input
 */
TAUTLINE_KERNEL_EXPORT std::vector<double> untangleSliding(const Mesh& mesh,
  const BoundaryConstraints& constraints, int threads,
  const std::function<bool(const SlidingState&)>& report);
}
#endif
