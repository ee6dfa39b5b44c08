// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BisectionTree.h
 * @brief Planes that divide locations into parts by recursive bisection.
 * Internal: not installed.
 */
#ifndef tautline_BisectionTree_h
#define tautline_BisectionTree_h

#include "VectorAlgebra.h"

#include <algorithm>
#include <vector>

namespace tautline
{
/**
 * @class tautline::BisectionTree
 * @brief Planes that divide locations into parts of about equal counts; each is perpendicular to
 * the direction in which its locations extend farthest.
 * @tparam Frame the directions, 0 to 2. extent(direction, from, to) of places;
 * before(direction, a, b): whether the place a is below b.
 */
template <class Frame>
class BisectionTree
{
public:
  /**
   * @param places their order changes
   * @param parts the number of parts
   * @param moved each plane is moved upwards by this fraction of its locations
   */
  BisectionTree(const Frame& frame, std::vector<Vec3>& places, int parts, double moved = 0.0)
    : Directions(frame)
    , Moved(moved)
  {
    this->split(0, parts, places.begin(), places.end());
  }

  /// The part of a place. Calls visit(direction, place of a plane) on the way to it.
  template <class Visit>
  int find(const Vec3& x, const Visit& visit) const
  {
    std::size_t node = 0;
    while (this->Nodes[node].below > 0)
    {
      const Node& n = this->Nodes[node];
      visit(n.direction, n.place);
      node = this->Directions.before(n.direction, x, n.place) ? n.below : n.above;
    }
    return this->Nodes[node].part;
  }
  int find(const Vec3& x) const
  {
    return this->find(x, [](int, const Vec3&) {});
  }

private:
  struct Node
  {
    int part = 0, direction = 0;      ///< the first part
    Vec3 place = { 0, 0, 0 };         ///< the first one above
    std::size_t below = 0, above = 0; ///< 0: a leaf
  };
  using Iterator = std::vector<Vec3>::iterator;

  /// The direction in which places extend the farthest. There must be some.
  int longest(Iterator from, Iterator to) const
  {
    double farthest = -1.0;
    int direction = 0;
    for (int k = 0; k < 3; ++k)
    {
      const double extent = this->Directions.extent(k, from, to);
      direction = extent > farthest ? k : direction;
      farthest = std::max(extent, farthest);
    }
    return direction;
  }

  /// Divides places among the parts from first to end. @return the node
  std::size_t split(int first, int end, Iterator from, Iterator to)
  {
    const std::size_t node = this->Nodes.size();
    this->Nodes.emplace_back();
    this->Nodes[node].part = first;
    const int middle = first + (end - first) / 2;
    const double fraction =
      static_cast<double>(middle - first) / std::max(end - first, 1) + this->Moved;
    const auto below = std::min(
      static_cast<std::ptrdiff_t>(fraction * static_cast<double>(to - from)), to - from - 1);
    if (end - first < 2 || below <= 0)
    {
      return node;
    }
    const Iterator at = from + below;
    const int direction = this->longest(from, to);
    std::nth_element(from, at, to,
      [&](const Vec3& a, const Vec3& b) { return this->Directions.before(direction, a, b); });
    this->Nodes[node].direction = direction;
    this->Nodes[node].place = *at;
    const std::size_t low = this->split(first, middle, from, at);
    const std::size_t high = this->split(middle, end, at, to);
    this->Nodes[node].below = low;
    this->Nodes[node].above = high;
    return node;
  }

  Frame Directions;
  double Moved;
  std::vector<Node> Nodes;
};
}
#endif
