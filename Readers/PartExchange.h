// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartExchange.h
 * @brief From equal shares of the records of a file, one on each rank, to the parts of partOf().
 *
 * A rank has the points and the cells of its share, and answers the others' questions about them.
 * Coordinates of a cell's nodes are fetched from the ranks that have the points; the cells are
 * divided by recursive bisection (PartDivision.h); then cells, ghost cells and points go to the
 * parts, a few megabytes at a time. A rank needs memory for its share and its part, and two bits
 * per point of the whole mesh. The first rank has all points without a cell, as part 0 has them.
 *
 * What takes memory in proportion to the mesh is done in FileRanges::together(), so that no rank
 * waits for another that has none.
 */
#ifndef tautline_PartExchange_h
#define tautline_PartExchange_h

#include "FileRanges.h"
#include "MeshFile.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>

namespace tautline
{
/**
 * @brief What a rank has read. Ranks in their order have the points of the file in theirs.
 *
 * Cells belong to sections. All cells of a section have smaller numbers than those of the next one;
 * in a section, ranks in their order have the cells in theirs. Arrays are the same on all ranks,
 * with values for own points and cells; all else of the mesh is equal on all ranks.
 */
struct MeshShare
{
  MeshFile mesh;                   ///< the connectivity has numbers of points in the whole file
  std::vector<Index> sectionCells; ///< own cells per section
};

/// Removes the cells below the largest dimension of any rank. Collective.
void keepHighestDimension(const FileRanges& ranges, MeshShare& share);

/// Part `rank` of as many as there are ranks, as partOf() gives it. Collective; throws Error on all
/// ranks where one has too little memory or is interrupted.
TAUTLINEREADERS_EXPORT MeshFile exchangeParts(
  const FileRanges& ranges, MeshShare share, int ghostLayers);

/// Where the items of each rank begin in the order of ranks; one more number, of all. Collective.
std::vector<Index> rankBegins(RankGroup& group, Index own);
/// The rank that has an item.
int rankOf(const std::vector<Index>& begins, Index item);

/// Rows of this rank that go to each rank.
using RankRows = std::vector<std::vector<Index>>;
/// The rows this rank sends where items are divided as in `from` and are to be as in `to`.
RankRows realignedRows(
  const RankGroup& group, const std::vector<Index>& from, const std::vector<Index>& to);

/**
 * @brief Sends items to all ranks in rounds, of limits().sendAtOnce bytes of each sender and at
 * least an item for each rank that it has some for. Collective. No other memory in proportion to
 * the items is taken, so that it runs out where all ranks notice.
 * @param fill fill(rank, most, items) appends the next items for a rank until there are `most` or
 * none is left, and returns whether any is left. It is called for each rank at first.
 * @param take take(sender, items, count) gets them in the order in which they were filled in
 */
template <class Item, class Fill, class Take>
void sendInRounds(const FileRanges& ranges, const Fill& fill, const Take& take)
{
  RankGroup& group = ranges.group();
  const auto budget = static_cast<std::size_t>(ranges.limits().sendAtOnce) / sizeof(Item);
  std::vector<char> left(static_cast<std::size_t>(group.size()), 1);
  std::vector<Bytes> sent(left.size()), arrived(left.size());
  const auto takeArrived = [&]
  {
    for (std::size_t rank = 0; rank < arrived.size(); ++rank)
    {
      const std::vector<Item> some = itemsOf<Item>(arrived[rank]);
      arrived[rank] = Bytes();
      take(rank, some.data(), some.size());
    }
  };
  for (bool more = true; more;)
  {
    ranges.together(
      [&]
      {
        throwIfInterrupted();
        takeArrived();
        const auto receivers = static_cast<std::size_t>(std::count(left.begin(), left.end(), 1));
        const std::size_t most =
          std::max(budget / std::max<std::size_t>(receivers, 1), std::size_t(1));
        for (std::size_t rank = 0; rank < left.size(); ++rank)
        {
          std::vector<Item> some;
          left[rank] = left[rank] && fill(rank, most, some);
          sent[rank] = bytesOf(some);
        }
      });
    arrived = group.exchange(sent);
    std::fill(sent.begin(), sent.end(), Bytes());
    more = group.any(std::count(left.begin(), left.end(), 1) > 0);
  }
  ranges.together(takeArrived);
}

/// Sends each rank a list, and returns the lists of each. Collective.
template <class Item>
std::vector<std::vector<Item>> sendLists(
  const FileRanges& ranges, const std::vector<std::vector<Item>>& lists)
{
  std::vector<Index> counts;
  for (const std::vector<Item>& list : lists)
  {
    counts.push_back(static_cast<Index>(list.size()));
  }
  counts = ranges.group().transpose(std::move(counts));
  std::vector<std::vector<Item>> received(lists.size());
  ranges.together(
    [&]
    {
      for (std::size_t rank = 0; rank < received.size(); ++rank)
      {
        received[rank].reserve(static_cast<std::size_t>(counts[rank]));
      }
    });
  std::vector<std::size_t> next(lists.size(), 0);
  sendInRounds<Item>(
    ranges,
    [&](std::size_t rank, std::size_t most, std::vector<Item>& some)
    {
      const std::vector<Item>& list = lists[rank];
      const auto begin = list.begin() + static_cast<std::ptrdiff_t>(next[rank]);
      next[rank] += std::min(most, list.size() - next[rank]);
      some.assign(begin, list.begin() + static_cast<std::ptrdiff_t>(next[rank]));
      return next[rank] < list.size();
    },
    [&](std::size_t sender, const Item* some, std::size_t count)
    { received[sender].insert(received[sender].end(), some, some + count); });
  return received;
}

/**
 * @brief Sends rows of a list to the ranks that `rows` names. Collective.
 * @param width items in a row @param offsets if not null, where each row begins, and the end
 * @param take is called as take(sender, items, count) with whole rows, from each sender in the
 * order in which it sends them
 */
template <class Item, class Take>
void sendRowsTo(const FileRanges& ranges, const std::vector<Item>& items, const RankRows& rows,
  Index width, const std::vector<Index>* offsets, const Take& take)
{
  std::vector<std::size_t> next(rows.size(), 0);
  sendInRounds<Item>(
    ranges,
    [&](std::size_t rank, std::size_t most, std::vector<Item>& some)
    {
      for (; next[rank] < rows[rank].size() && some.size() < most; ++next[rank])
      {
        const Index row = rows[rank][next[rank]];
        const Index begin = offsets ? (*offsets)[row] : row * width;
        const Index end = offsets ? (*offsets)[row + 1] : begin + width;
        some.insert(some.end(), items.begin() + begin, items.begin() + end);
      }
      return next[rank] < rows[rank].size();
    },
    take);
}

/// The same; returns the rows in order of sender.
template <class Item>
std::vector<Item> sendRows(
  const FileRanges& ranges, const std::vector<Item>& items, const RankRows& rows, Index width)
{
  std::vector<Index> place;
  for (const std::vector<Index>& some : rows)
  {
    place.push_back(static_cast<Index>(some.size()) * width);
  }
  place = ranges.group().transpose(std::move(place));
  Index total = 0;
  for (Index& one : place)
  {
    const Index count = one;
    one = total;
    total += count;
  }
  std::vector<Item> received;
  ranges.together([&] { received.resize(static_cast<std::size_t>(total)); });
  sendRowsTo(ranges, items, rows, width, nullptr,
    [&](std::size_t sender, const Item* some, std::size_t count)
    {
      std::copy_n(some, count, received.begin() + place[sender]);
      place[sender] += static_cast<Index>(count);
    });
  return received;
}

/// The same for the tuples of an array.
MeshArray sendTuples(const FileRanges& ranges, const MeshArray& array, const RankRows& rows);
}
#endif
