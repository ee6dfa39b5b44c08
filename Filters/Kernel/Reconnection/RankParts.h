// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankParts.h
 * @brief Tetrahedra that move between ranks, with the points they need. Internal: not installed.
 */
#ifndef tautline_RankParts_h
#define tautline_RankParts_h

#include "tautline/Core/RankGroup.h"
#include "tautline/Core/VectorAlgebra.h"

#include <array>
#include <vector>

namespace tautline
{
/// A point, as it is sent.
struct PartPoint
{
  Index number = 0;
  Vec3 x = { 0, 0, 0 };
  unsigned char fixed = 0;
  unsigned char onAllSeams = 0; ///< was on a seam in every round so far
};

/// A tetrahedron, as it is sent.
struct PartCell
{
  std::array<Index, 4> points = { 0, 0, 0, 0 }; ///< numbers
  Index region = 0;
  Index originRank = 0, originCell = 0; ///< of the input
  double quality = 0, bound = 1;
  signed char obstacle = 0;
};

/// A part of an inserted point.
struct PartShare
{
  Index point = 0, number = 0;
  double weight = 0;
};

/// What a rank works on.
struct MeshPart
{
  std::vector<PartPoint> points; ///< in increasing order of the numbers
  std::vector<PartCell> cells;
  std::vector<PartShare> shares; ///< in increasing order of the points
};

/// Sorts points; of those with the same number one is left, with the flags of all.
void unitePoints(std::vector<PartPoint>& points);

/// The place of a point in a sorted list; it must be there.
Index placeOf(const std::vector<PartPoint>& points, Index number);

/// The centroid of a cell.
Vec3 centroidOf(const MeshPart& part, const PartCell& cell);

/// Sends each cell to a rank, with its points and their shares. The order of what a rank has then
/// does not depend on where it was. Collective.
void redistribute(RankGroup& group, const std::vector<int>& targets, MeshPart& part);

/// The rank that each cell goes to in a round: planes across the longest extents, in directions
/// that change from round to round, such that all ranks get about as many. Collective.
std::vector<int> divideAmongRanks(RankGroup& group, const MeshPart& part, int round);

/// What is around a part.
struct PartSurroundings
{
  std::vector<PartCell> cells;   ///< those of other ranks that share a facet with the part
  std::vector<PartPoint> points; ///< theirs, in increasing order of the numbers
  /// Points that other ranks have, in increasing order.
  std::vector<Index> shared;
  /// The facets of the part that have a cell on both sides, there or on another rank, as sorted
  /// numbers of points: those within it twice. In increasing order.
  std::vector<std::array<Index, 3>> inner;
};

/// Finds them; throws Error on all ranks for facets of three or more cells. Collective.
PartSurroundings surroundingsOf(RankGroup& group, const MeshPart& part);
}
#endif
