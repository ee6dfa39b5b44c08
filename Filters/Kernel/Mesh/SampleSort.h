// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampleSort.h
 * @brief Divides sorted items of ranks into one range per rank.
 * Internal: not installed.
 */
#ifndef tautline_SampleSort_h
#define tautline_SampleSort_h

#include "tautline/Core/RankGroup.h"

#include <algorithm>
#include <vector>

namespace tautline
{
/**
 * @brief The items for each rank: rank 0 gets the first range of all items, and so on. Samples
 * determine the ends of the ranges, so that their lengths are about equal; equal items are in one
 * range. Collective.
 * @param sorted the items of this rank in their order
 */
template <class Item>
std::vector<std::vector<Item>> splitIntoRanges(RankGroup& group, const std::vector<Item>& sorted)
{
  constexpr std::size_t samplesPerRank = 64;
  const auto ranks = static_cast<std::size_t>(group.size());
  std::vector<Item> samples;
  for (std::size_t i = 0; i < samplesPerRank && !sorted.empty(); ++i)
  {
    samples.push_back(sorted[i * sorted.size() / samplesPerRank]);
  }
  samples = group.gatherJoined(samples);
  std::sort(samples.begin(), samples.end());
  std::vector<std::vector<Item>> ranges(ranks);
  auto begin = sorted.begin();
  for (std::size_t r = 0; r < ranks; ++r)
  {
    const auto end = r + 1 < ranks && !samples.empty()
      ? std::lower_bound(begin, sorted.end(), samples[(r + 1) * samples.size() / ranks])
      : sorted.end();
    ranges[r].assign(begin, end);
    begin = end;
  }
  return ranges;
}
}
#endif
