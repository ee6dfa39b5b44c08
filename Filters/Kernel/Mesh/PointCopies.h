// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointCopies.h
 * @brief Copies of a point, with the same global id, whose places differ by rounding.
 * Internal: not installed.
 */
#ifndef tautline_PointCopies_h
#define tautline_PointCopies_h

#include "Mesh.h"
#include "tautline/Core/RankGroup.h"

#include <vector>

namespace tautline
{
/// The points of a piece with the copies of a point at one place.
struct JoinedCopies
{
  std::vector<double> points; ///< three per point; empty where none of this rank has moved
  Index joined = 0;           ///< points of the whole mesh whose copies were at several places
  double farthest = 0;        ///< the longest way of a copy
  /// Ids of points that are farther apart. Only of points within an edge of the box of another
  /// rank's points.
  Index apart = 0;
};

/// The length of the shortest edge, but for those of length zero, of the cells at each point;
/// infinite at points without a supported cell.
TAUTLINE_KERNEL_EXPORT std::vector<double> shortestEdges(const MeshView& view);

/**
 * @brief Whether two points with the same id are copies of one, whose places differ by rounding:
 * they are no farther apart than 1e-5 of the shortest edges at both.
 *
 * Points of a valid mesh that have the same id by chance, as where pieces number their points each
 * from 0, are farther apart, but where pieces nearly touch.
 */
TAUTLINE_KERNEL_EXPORT bool areCopies(
  const double* a, double shortestA, const double* b, double shortestB);

/**
 * @brief Finds copies of points, of one rank or of several, and gives them one place: of their
 * places the first in the order of the coordinates. Others with the same id stay where they are.
 * Collective.
 * @param ids per point, need not be those of one mesh: nothing is joined if most ids of several
 * points are at several places, or if they are missing (null) on any rank with points.
 */
TAUTLINE_KERNEL_EXPORT JoinedCopies joinCopies(
  RankGroup& group, const MeshView& view, const Index* ids);
}
#endif
