// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronPiece.h
 * @brief Tetrahedra that move between ranks, with the points they need.
 * Internal: not installed.
 */
#ifndef tautline_TetrahedronPiece_h
#define tautline_TetrahedronPiece_h

#include "tautline/Core/NumberIntervals.h"
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
  /// Was near a seam in every round so far, or where a rank had no more cells to add.
  unsigned char onAllSeams = 0;
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

/// A place that planes are to be away from by a radius, above 0; the weight is what it costs to
/// have a plane there.
struct Ball
{
  Vec3 center;
  double radius, weight;
};

/// What a rank works on.
struct TetrahedronPiece
{
  std::vector<PartPoint> points; ///< in increasing order of the numbers
  std::vector<PartCell> cells;
  std::vector<PartShare> shares; ///< in increasing order of the points
};

/// Sorts points; of those with the same number one is left, with the flags of all.
void unitePoints(std::vector<PartPoint>& points);

/// The place of a point in a sorted list; it must be there.
Index placeOf(const std::vector<PartPoint>& points, Index number);

/**
 * @class tautline::PointPlaces
 * @brief placeOf() for many numbers: a table of intervals tells where.
 */
class PointPlaces
{
public:
  /// @param points must outlive this, and not change
  explicit PointPlaces(const std::vector<PartPoint>& points)
    : Points(points)
    , Intervals(static_cast<Index>(points.size()), [&](Index p) { return points[p].number; })
  {
  }
  /// It has a table in proportion to the points; algorithms take a function by value.
  PointPlaces(const PointPlaces&) = delete;
  PointPlaces& operator=(const PointPlaces&) = delete;
  /// As placeOf().
  Index operator()(Index number) const
  {
    return this->Intervals.find(number, [this](Index p) { return this->Points[p].number; });
  }

private:
  const std::vector<PartPoint>& Points;
  NumberIntervals Intervals;
};

/// The centroid of a cell. @param places those of the points of the part
Vec3 centroidOf(const TetrahedronPiece& part, const PointPlaces& places, const PartCell& cell);

/// Sends each cell to a rank, with its points and their shares. The order of what a rank has then
/// does not depend on where it was. Collective.
void redistribute(RankGroup& group, const std::vector<int>& targets, TetrahedronPiece& part);

/**
 * @brief The rank that each cell goes to in a round: planes across the longest extents, in
 * directions that change from round to round, such that all ranks get about as many. Collective.
 * @param inside where planes are not to be. They are moved, and turned, to where this costs least.
 * @param frame the CuttingFrame of the last round, -1 before the first one; gets another one
 */
std::vector<int> divideAmongRanks(
  RankGroup& group, const TetrahedronPiece& part, const std::vector<Ball>& inside, int& frame);

/// What is around a part.
struct PartSurroundings
{
  std::vector<PartCell> cells;   ///< those of other ranks that share a facet with the part
  std::vector<PartPoint> points; ///< theirs, in increasing order of the numbers
  /// Points that other ranks have, in increasing order.
  std::vector<Index> shared;
  /// Of the marked facets, the sides that have a cell of the part, if there is a cell on the other
  /// side, too, here or on another rank.
  Index markedSides = 0;
};

/**
 * @brief Finds them; throws Error on all ranks for facets of three or more cells. Collective.
 * @param marked sorted numbers of points, in increasing order
 */
PartSurroundings surroundingsOf(
  RankGroup& group, const TetrahedronPiece& part, const std::vector<std::array<Index, 3>>& marked);
}
#endif
