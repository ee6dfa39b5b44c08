// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronPiece.h
 * @brief Tetrahedra that move between ranks, with their points.
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
/// A point in the form in which it is sent.
struct PartPoint
{
  Index number = 0;
  Vec3 x = { 0, 0, 0 };
  unsigned char fixed = 0;
  /// Whether it was near a seam in every round so far, or on a rank that could not add more cells.
  unsigned char onAllSeams = 0;
};

/// A tetrahedron in the form in which it is sent.
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

/// A region that planes should avoid, with a radius above 0; the weight is the cost of a plane
/// through the center.
struct Ball
{
  Vec3 center;
  double radius, weight;
};

/// The part of a rank.
struct TetrahedronPiece
{
  std::vector<PartPoint> points; ///< in increasing order of the numbers
  std::vector<PartCell> cells;
  std::vector<PartShare> shares; ///< in increasing order of the points
};

/// Sorts points and merges points with the same number, combining their flags.
void unitePoints(std::vector<PartPoint>& points);

/// The position of a point in a sorted list; it must be present.
Index placeOf(const std::vector<PartPoint>& points, Index number);

/**
 * @class tautline::PointPlaces
 * @brief placeOf() for many numbers, with a table of intervals.
 */
class PointPlaces
{
public:
  /// @param points must outlive this object unchanged
  explicit PointPlaces(const std::vector<PartPoint>& points)
    : Points(points)
    , Intervals(static_cast<Index>(points.size()), [&](Index p) { return points[p].number; })
  {
  }
  /// Not copyable, because the table is as large as the points and algorithms take functions by
  /// value.
  PointPlaces(const PointPlaces&) = delete;
  PointPlaces& operator=(const PointPlaces&) = delete;
  /// Like placeOf().
  Index operator()(Index number) const
  {
    return this->Intervals.find(number, [this](Index p) { return this->Points[p].number; });
  }

private:
  const std::vector<PartPoint>& Points;
  NumberIntervals Intervals;
};

/// The centroid of a cell. @param places the positions of the points of the part
Vec3 centroidOf(const TetrahedronPiece& part, const PointPlaces& places, const PartCell& cell);

/// Sends each cell to a rank, with its points and their shares. The resulting order on a rank does
/// not depend on the previous distribution. Collective.
void redistribute(RankGroup& group, const std::vector<int>& targets, TetrahedronPiece& part);

/**
 * @brief The rank of each cell in a round: planes perpendicular to the longest extents, in
 * directions that change between rounds, such that all ranks get about the same number of cells.
 * Collective.
 * @param inside regions that planes should avoid. They are shifted and rotated to minimize the
 *   cost.
 * @param frame the CuttingFrame of the last round, -1 before the first one; set to a different one
 */
std::vector<int> divideAmongRanks(
  RankGroup& group, const TetrahedronPiece& part, const std::vector<Ball>& inside, int& frame);

/// The surroundings of a part.
struct PartSurroundings
{
  std::vector<PartCell> cells;   ///< cells of other ranks that share a facet with the part
  std::vector<PartPoint> points; ///< their points, in increasing order of the numbers
  /// Points that other ranks also have, in increasing order.
  std::vector<Index> shared;
  /// The number of sides of marked facets with a cell of the part, if there is also a cell on the
  /// other side, here or on another rank.
  Index markedSides = 0;
};

/**
 * @brief Finds the surroundings; throws Error on all ranks for facets of three or more cells.
 * Collective.
 * @param marked sorted numbers of points, in increasing order
 */
PartSurroundings surroundingsOf(
  RankGroup& group, const TetrahedronPiece& part, const std::vector<std::array<Index, 3>>& marked);
}
#endif
