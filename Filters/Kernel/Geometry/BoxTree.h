// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoxTree.h
 * @brief A bounding-box tree that finds the boxes that meet a box, and the object nearest to a
 * point.
 * Internal: not installed.
 */
#ifndef tautline_BoxTree_h
#define tautline_BoxTree_h

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Types.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

namespace tautline
{
/// A box with sides along the axes; without a point until one is added.
struct BoundingBox
{
  Vec3 low = { Infinite, Infinite, Infinite }, high = { -Infinite, -Infinite, -Infinite };

  void add(const Vec3& p)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->low[k] = std::min(this->low[k], p[k]);
      this->high[k] = std::max(this->high[k], p[k]);
    }
  }
  void add(const BoundingBox& box)
  {
    this->add(box.low);
    this->add(box.high);
  }
  void widen(double distance)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->low[k] -= distance;
      this->high[k] += distance;
    }
  }
  bool meets(const BoundingBox& box) const
  {
    for (int k = 0; k < 3; ++k)
    {
      if (this->low[k] > box.high[k] || this->high[k] < box.low[k])
      {
        return false;
      }
    }
    return true;
  }
  double squaredDistance(const Vec3& x) const
  {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      const double d = std::max({ this->low[k] - x[k], x[k] - this->high[k], 0.0 });
      sum += d * d;
    }
    return sum;
  }

private:
  static constexpr double Infinite = std::numeric_limits<double>::infinity();
};

/**
 * @class tautline::BoxTree
 * @brief A binary tree by medians along the longest side; nodes are in preorder. Results do not
 * depend on the order of the boxes; ties in distance are resolved by the lowest number.
 */
class BoxTree
{
public:
  explicit BoxTree(std::vector<BoundingBox> boxes)
    : Boxes(std::move(boxes))
    , Order(this->Boxes.size())
  {
    std::iota(this->Order.begin(), this->Order.end(), Index{ 0 });
    if (!this->Boxes.empty())
    {
      this->build(0, static_cast<Index>(this->Order.size()));
    }
  }

  bool empty() const { return this->Nodes.empty(); }
  /// The bounds of all boxes; there must be at least one.
  const BoundingBox& bounds() const { return this->Nodes[0].box; }

  /// Calls visit(number) for each box that meets the given one.
  template <class Visit>
  void forEachMeeting(const BoundingBox& box, const Visit& visit) const
  {
    for (std::size_t i = 0; i < this->Nodes.size();)
    {
      const Node& node = this->Nodes[i];
      const bool meets = node.box.meets(box);
      for (Index k = node.begin; meets && node.leaf && k < node.end; ++k)
      {
        const Index number = this->Order[k];
        if (this->Boxes[number].meets(box))
        {
          visit(number);
        }
      }
      i = meets && !node.leaf ? i + 1 : node.next;
    }
  }

  /**
   * @brief The number of the object nearest to a point, the lowest one in case of ties; -1 if there
   * are none.
   * @param squaredDistance squaredDistance(number) of an object, which must be inside its box
   */
  template <class Distance>
  Index nearest(const Vec3& x, const Distance& squaredDistance) const
  {
    Index best = -1;
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> stack;
    if (!this->Nodes.empty())
    {
      stack.push_back(0);
    }
    Index pass = 0;
    while (!stack.empty())
    {
      pollInterruption(++pass);
      const std::size_t at = stack.back();
      const Node& node = this->Nodes[at];
      stack.pop_back();
      if (node.box.squaredDistance(x) > least)
      {
        continue;
      }
      if (!node.leaf)
      {
        const std::size_t first = at + 1, second = this->Nodes[first].next;
        const bool nearer =
          this->Nodes[first].box.squaredDistance(x) <= this->Nodes[second].box.squaredDistance(x);
        stack.push_back(nearer ? second : first);
        stack.push_back(nearer ? first : second);
        continue;
      }
      for (Index k = node.begin; k < node.end; ++k)
      {
        const Index number = this->Order[k];
        if (this->Boxes[number].squaredDistance(x) > least)
        {
          continue;
        }
        const double distance = squaredDistance(number);
        if (best < 0 || distance < least || (distance == least && number < best))
        {
          least = distance;
          best = number;
        }
      }
    }
    return best;
  }

private:
  static constexpr Index LeafSize = 4;

  struct Node
  {
    BoundingBox box;
    Index begin = 0, end = 0; ///< of Order
    std::size_t next = 0;     ///< the node after the descendants of this one
    bool leaf = false;
  };

  void build(Index begin, Index end)
  {
    const std::size_t self = this->Nodes.size();
    Node node;
    node.begin = begin;
    node.end = end;
    node.leaf = end - begin <= LeafSize;
    for (Index k = begin; k < end; ++k)
    {
      pollInterruption(k);
      node.box.add(this->Boxes[this->Order[k]]);
    }
    this->Nodes.push_back(node);
    if (!node.leaf)
    {
      const Vec3 extent = node.box.high - node.box.low;
      const auto axis = std::max_element(extent.begin(), extent.end()) - extent.begin();
      const Index middle = begin + (end - begin) / 2;
      const auto place = [&](Index i)
      { return this->Boxes[i].low[axis] + this->Boxes[i].high[axis]; };
      const auto first = this->Order.begin();
      // Break ties by number, so that the order does not depend on the library implementation.
      std::nth_element(first + begin, first + middle, first + end,
        [&](Index a, Index b) { return place(a) < place(b) || (place(a) == place(b) && a < b); });
      this->build(begin, middle);
      this->build(middle, end);
    }
    this->Nodes[self].next = this->Nodes.size();
  }

  std::vector<BoundingBox> Boxes;
  std::vector<Index> Order;
  std::vector<Node> Nodes;
};
}
#endif
