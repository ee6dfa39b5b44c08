// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointCopies.h
 * @brief Copies of a point, with the same global id, whose positions differ by rounding.
 * Internal: not installed.
 */
#ifndef tautline_PointCopies_h
#define tautline_PointCopies_h

#include "Mesh.h"
#include "tautline/Core/RankGroup.h"

#include <vector>

namespace tautline
{
/// The points of a piece after joining copies.
struct JoinedCopies
{
  std::vector<double> points; ///< three per point; empty if no point of this rank has moved
  Index joined = 0;           ///< points of the whole mesh whose copies were at several positions
  double farthest = 0;        ///< the longest displacement of a copy
  /// The number of ids of points that are farther apart; only counts points within one edge length
  /// of the box of the points of another rank.
  Index apart = 0;
};

/// The length of the shortest edge, except edges of length zero, of the cells at each point;
/// infinite at points without a supported cell.
TAUTLINE_KERNEL_EXPORT std::vector<double> shortestEdges(const MeshView& view);

/**
 * @brief Whether two points with the same id are copies whose positions differ by rounding: they
 * are no farther apart than 1e-5 of the shortest edges at both.
 *
 * Points of a valid mesh that have the same id by chance, for example if each piece numbers its
 * points from 0, are farther apart, except where pieces nearly touch.
 */
TAUTLINE_KERNEL_EXPORT bool areCopies(
  const double* a, double shortestA, const double* b, double shortestB);

/**
 * @brief Finds copies of points, of one rank or of several, and moves them to one position: the
 * first of their positions in the order of the coordinates. Other points with the same id do not
 * move. Collective.
 * @param ids per point; may be unrelated: nothing is joined if most repeated ids are at several
 * positions, or if ids are missing (null) on any rank with points.
 */
TAUTLINE_KERNEL_EXPORT JoinedCopies joinCopies(
  RankGroup& group, const MeshView& view, const Index* ids);
}
#endif
