// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointDivision.h
 * @brief Divides points among ranks by planes.
 * Internal: not installed.
 */
#ifndef tautline_PointDivision_h
#define tautline_PointDivision_h

#include "tautline/Core/BisectionTree.h"
#include "tautline/Core/RankGroup.h"

namespace tautline
{
/// The axes. Places with the same coordinate along one are told apart by their others.
struct TAUTLINE_KERNEL_EXPORT AxisFrame
{
  bool before(int direction, const Vec3& a, const Vec3& b) const;
  double extent(
    int direction, std::vector<Vec3>::iterator from, std::vector<Vec3>::iterator to) const;
};

/**
 * @class tautline::PointDivision
 * @brief A tree of planes such that all ranks get about as many of the points: within a few
 * percent, as a sample decides.
 *
 * All ranks have the same tree, and a place is in one part, whichever ranks have points there.
 * Regular grids are divided as evenly.
 */
class TAUTLINE_KERNEL_EXPORT PointDivision
{
public:
  /// Collective. @param points of this rank; those that several ranks have count once
  PointDivision(RankGroup& group, const std::vector<Vec3>& points);

  /// The rank of a place.
  int find(const Vec3& x) const { return this->Tree.find(x); }

private:
  BisectionTree<AxisFrame> Tree;
};
}
#endif
