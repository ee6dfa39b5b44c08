// SPDX-License-Identifier: BSD-3-Clause
#include "PointDivision.h"

#include "tautline/Core/Random.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace tautline
{
namespace
{
/// So many points for each rank decide where the planes are, and so many in all.
constexpr Index SamplesOfRank = 10000, MostSamples = 1000000;

/// Orders places along a direction, and equal ones along the two others.
struct Along
{
  int direction;

  bool operator()(const Vec3& a, const Vec3& b) const
  {
    for (int k = 0; k < 3; ++k)
    {
      const int c = (this->direction + k) % 3;
      if (a[c] != b[c])
      {
        return a[c] < b[c];
      }
    }
    return false;
  }
};

std::uint64_t hashOf(const Vec3& x)
{
  std::uint64_t hash = 0;
  for (const double coordinate : x)
  {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &coordinate, sizeof(bits));
    hash = SplitMix::mixed(hash ^ bits);
  }
  return hash;
}

int longestExtent(std::vector<Vec3>::iterator from, std::vector<Vec3>::iterator to)
{
  Vec3 low = *from, high = *from;
  for (auto x = from; x != to; ++x)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], (*x)[c]);
      high[c] = std::max(high[c], (*x)[c]);
    }
  }
  const Vec3 extent = high - low;
  return static_cast<int>(std::max_element(extent.begin(), extent.end()) - extent.begin());
}
}

//------------------------------------------------------------------------------
PointDivision::PointDivision(RankGroup& group, const std::vector<Vec3>& points)
{
  const Index all = group.sum(static_cast<Index>(points.size()));
  const Index wanted = std::min(SamplesOfRank * group.size(), MostSamples);
  const auto step = static_cast<std::uint64_t>(std::max<Index>(1, all / wanted));
  // Chosen by the coordinates: the same points whichever ranks have them.
  std::vector<Vec3> own, sample;
  std::copy_if(points.begin(), points.end(), std::back_inserter(own),
    [step](const Vec3& x) { return hashOf(x) % step == 0; });
  for (const std::vector<Vec3>& list : group.gatherItems(own))
  {
    sample.insert(sample.end(), list.begin(), list.end());
  }
  std::sort(sample.begin(), sample.end());
  sample.erase(std::unique(sample.begin(), sample.end()), sample.end());
  this->split(0, group.size(), sample.begin(), sample.end());
}

//------------------------------------------------------------------------------
/// Divides a part of the sample among ranks. @return the node
std::size_t PointDivision::split(int first, int end, Iterator from, Iterator to)
{
  const std::size_t node = this->Nodes.size();
  this->Nodes.emplace_back();
  this->Nodes[node].rank = first;
  const auto count = to - from;
  const int middle = first + (end - first) / 2;
  const auto share = count * (middle - first) / std::max(end - first, 1);
  if (end - first < 2 || share == 0)
  {
    return node;
  }
  const Iterator at = from + share;
  const int direction = longestExtent(from, to);
  std::nth_element(from, at, to, Along{ direction });
  this->Nodes[node].direction = direction;
  this->Nodes[node].place = *at;
  const std::size_t below = this->split(first, middle, from, at);
  const std::size_t above = this->split(middle, end, at, to);
  this->Nodes[node].below = below;
  this->Nodes[node].above = above;
  return node;
}

//------------------------------------------------------------------------------
int PointDivision::find(const Vec3& x) const
{
  std::size_t node = 0;
  while (this->Nodes[node].below > 0)
  {
    const Node& n = this->Nodes[node];
    node = Along{ n.direction }(x, n.place) ? n.below : n.above;
  }
  return this->Nodes[node].rank;
}
}
