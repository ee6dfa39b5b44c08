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
/// The axes. Points with the same coordinate along one axis are ordered by their other coordinates.
struct TAUTLINE_KERNEL_EXPORT AxisFrame
{
  bool before(int direction, const Vec3& a, const Vec3& b) const;
  double extent(
    int direction, std::vector<Vec3>::iterator from, std::vector<Vec3>::iterator to) const;
};

/**
 * @class tautline::PointDivision
 * @brief A tree of planes such that all ranks get about the same number of points: within a few
 * percent, because a sample is used.
 *
 * All ranks have the same tree, and a position belongs to one part, regardless of which ranks have
 * points there. Regular grids are divided equally well.
 */
class TAUTLINE_KERNEL_EXPORT PointDivision
{
public:
  /// Collective. @param points of this rank; points on several ranks are counted once
  PointDivision(RankGroup& group, const std::vector<Vec3>& points);

  /// The rank of a position.
  int find(const Vec3& x) const { return this->Tree.find(x); }

private:
  BisectionTree<AxisFrame> Tree;
};
}
#endif
