// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointTree.h
 * @brief A binary tree of points by medians along the longest side of their box.
 * Internal: not installed.
 */
#ifndef tautline_PointTree_h
#define tautline_PointTree_h

#include "tautline/Core/Types.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace tautline
{
/**
 * @brief The points in an order in which the points of a node are contiguous; nodes are in
 * preorder.
 *
 * Descends without recursion: the first child of node i is i + 1, and `next` is the node to visit
 * after the points of node i have been processed.
 */
class PointTree
{
public:
  struct Node
  {
    std::size_t begin = 0, end = 0; ///< of order()
    std::size_t next = 0;           ///< node after the descendants of this one
    Vec3 center = { 0, 0, 0 };      ///< mean of its points
    double radius = 0;              ///< largest distance of a point from the center
    bool leaf = false;
  };

  PointTree(const std::vector<Vec3>& points, std::size_t leafSize)
    : LeafSize(leafSize)
    , Order(points.size())
  {
    std::iota(this->Order.begin(), this->Order.end(), std::size_t{ 0 });
    if (!points.empty())
    {
      this->build(points, 0, points.size());
    }
  }

  const std::vector<std::size_t>& order() const { return this->Order; }
  const std::vector<Node>& nodes() const { return this->Nodes; }

private:
  void build(const std::vector<Vec3>& points, std::size_t begin, std::size_t end)
  {
    const std::size_t self = this->Nodes.size();
    Node node;
    node.begin = begin;
    node.end = end;
    Vec3 low = points[this->Order[begin]], high = low, sum = { 0, 0, 0 };
    for (std::size_t i = begin; i < end; ++i)
    {
      const Vec3& p = points[this->Order[i]];
      sum += p;
      for (std::size_t k = 0; k < 3; ++k)
      {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
    node.center = (1.0 / static_cast<double>(end - begin)) * sum;
    for (std::size_t i = begin; i < end; ++i)
    {
      node.radius = std::max(node.radius, norm(points[this->Order[i]] - node.center));
    }
    node.leaf = end - begin <= this->LeafSize;
    this->Nodes.push_back(node);
    if (!node.leaf)
    {
      const Vec3 size = high - low;
      const auto axis =
        static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
      const std::size_t middle = begin + (end - begin) / 2;
      const auto at = [&](std::size_t i)
      { return this->Order.begin() + static_cast<std::ptrdiff_t>(i); };
      // Break ties by number, so that the order does not depend on the library implementation.
      std::nth_element(at(begin), at(middle), at(end),
        [&](std::size_t a, std::size_t b) {
          return points[a][axis] < points[b][axis] || (points[a][axis] == points[b][axis] && a < b);
        });
      this->build(points, begin, middle);
      this->build(points, middle, end);
    }
    this->Nodes[self].next = this->Nodes.size();
  }

  std::size_t LeafSize;
  std::vector<std::size_t> Order;
  std::vector<Node> Nodes;
};
}
#endif
