// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointDivision.h
 * @brief Divides points among ranks by planes. Internal: not installed.
 */
#ifndef tautline_PointDivision_h
#define tautline_PointDivision_h

#include "tautline/Core/RankGroup.h"
#include "tautline/Core/VectorAlgebra.h"

#include <vector>

namespace tautline
{
/**
 * @class tautline::PointDivision
 * @brief A tree of planes across the longest extents (recursive bisection), such that all ranks get
 * about as many of the points: within a few percent, as a sample decides.
 *
 * All ranks have the same tree, and a place is in one part, whichever ranks have points there.
 * Points with the same
 * coordinate across a plane are told apart by their others, so regular grids are divided as evenly.
 */
class TAUTLINE_KERNEL_EXPORT PointDivision
{
public:
  /// Collective. @param points of this rank; those that several ranks have count once
  PointDivision(RankGroup& group, const std::vector<Vec3>& points);

  /// The rank of a place.
  int find(const Vec3& x) const;

private:
  struct Node
  {
    int rank = 0, direction = 0;
    Vec3 place = { 0, 0, 0 };         ///< the first one above
    std::size_t below = 0, above = 0; ///< 0: a leaf
  };
  using Iterator = std::vector<Vec3>::iterator;
  std::size_t split(int first, int end, Iterator from, Iterator to);

  std::vector<Node> Nodes;
};
}
#endif
