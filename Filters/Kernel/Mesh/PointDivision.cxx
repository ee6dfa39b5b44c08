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
/// The number of sample points per rank and in total that determine the planes.
constexpr Index SamplesOfRank = 10000, MostSamples = 1000000;

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

/// A sorted sample of the points of all ranks: independent of the distribution, because points are
/// chosen by their coordinates.
std::vector<Vec3> sampleOf(RankGroup& group, const std::vector<Vec3>& points)
{
  const Index all = group.sum(static_cast<Index>(points.size()));
  const Index wanted = std::min(SamplesOfRank * group.size(), MostSamples);
  const auto step = static_cast<std::uint64_t>(std::max<Index>(1, all / wanted));
  std::vector<Vec3> own;
  std::copy_if(points.begin(), points.end(), std::back_inserter(own),
    [step](const Vec3& x) { return hashOf(x) % step == 0; });
  std::vector<Vec3> sample = group.gatherJoined(own);
  std::sort(sample.begin(), sample.end());
  sample.erase(std::unique(sample.begin(), sample.end()), sample.end());
  return sample;
}

BisectionTree<AxisFrame> treeOf(std::vector<Vec3> sample, int parts)
{
  return BisectionTree<AxisFrame>({}, sample, parts);
}
}

//------------------------------------------------------------------------------
bool AxisFrame::before(int direction, const Vec3& a, const Vec3& b) const
{
  for (int k = 0; k < 3; ++k)
  {
    const int c = (direction + k) % 3;
    if (a[c] != b[c])
    {
      return a[c] < b[c];
    }
  }
  return false;
}

//------------------------------------------------------------------------------
double AxisFrame::extent(
  int direction, std::vector<Vec3>::iterator from, std::vector<Vec3>::iterator to) const
{
  const auto ends = std::minmax_element(
    from, to, [&](const Vec3& a, const Vec3& b) { return a[direction] < b[direction]; });
  return (*ends.second)[direction] - (*ends.first)[direction];
}

//------------------------------------------------------------------------------
PointDivision::PointDivision(RankGroup& group, const std::vector<Vec3>& points)
  : Tree(treeOf(sampleOf(group, points), group.size()))
{
}
}
