// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartExchange.h
 * @brief From equal shares of the records of a file, one on each rank, to the parts of partOf().
 *
 * A rank has the points and the cells of its share, and answers the others' questions about them.
 * Coordinates of a cell's nodes are fetched from the ranks that have the points; the cells are
 * divided by recursive bisection (PartDivision.h); then cells, ghost cells and points go to the
 * parts, a few megabytes at a time. A rank needs memory for its share and its part, and two bits
 * per point of the whole mesh.
 */
#ifndef tautline_PartExchange_h
#define tautline_PartExchange_h

#include "FileRanges.h"
#include "MeshFile.h"

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
void keepHighestDimension(RankGroup& group, MeshShare& share);

/// Part `rank` of as many as there are ranks, as partOf() gives it. Collective.
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
 * @brief Sends rows of a list to the ranks that `rows` names, some megabytes at a time. Collective.
 * @param width items in a row @param offsets if not null, where each row begins, and the end
 * @param take is called as take(sender, items, count) with whole rows, from each sender in the
 * order in which it sends them
 */
template <class Item, class Take>
void sendRowsTo(RankGroup& group, const std::vector<Item>& items, const RankRows& rows, Index width,
  const std::vector<Index>* offsets, const Take& take)
{
  constexpr std::size_t atOnce = std::size_t(1) << 22; // bytes to all ranks
  const std::size_t perRank = std::max(atOnce / rows.size() / sizeof(Item), std::size_t(1));
  std::vector<std::size_t> next(rows.size(), 0);
  for (bool more = true; more;)
  {
    bool left = false;
    std::vector<Bytes> sent(rows.size());
    for (std::size_t rank = 0; rank < rows.size(); ++rank)
    {
      std::vector<Item> some;
      for (; next[rank] < rows[rank].size() && some.size() < perRank; ++next[rank])
      {
        const Index row = rows[rank][next[rank]];
        const Index begin = offsets ? (*offsets)[row] : row * width;
        const Index end = offsets ? (*offsets)[row + 1] : begin + width;
        some.insert(some.end(), items.begin() + begin, items.begin() + end);
      }
      left = left || next[rank] < rows[rank].size();
      sent[rank] = bytesOf(some);
    }
    std::vector<Bytes> arrived = group.exchange(sent);
    for (std::size_t rank = 0; rank < rows.size(); ++rank)
    {
      const std::vector<Item> some = itemsOf<Item>(arrived[rank]);
      take(rank, some.data(), some.size());
    }
    more = group.any(left);
  }
}

/// The same; returns the rows in order of sender.
template <class Item>
std::vector<Item> sendRows(
  RankGroup& group, const std::vector<Item>& items, const RankRows& rows, Index width)
{
  std::vector<Index> place;
  for (const std::vector<Index>& some : rows)
  {
    place.push_back(static_cast<Index>(some.size()) * width);
  }
  place = group.transpose(std::move(place));
  Index total = 0;
  for (Index& one : place)
  {
    const Index count = one;
    one = total;
    total += count;
  }
  std::vector<Item> received(static_cast<std::size_t>(total));
  sendRowsTo(group, items, rows, width, nullptr,
    [&](std::size_t sender, const Item* some, std::size_t count)
    {
      std::copy_n(some, count, received.begin() + place[sender]);
      place[sender] += static_cast<Index>(count);
    });
  return received;
}

/// The same for the tuples of an array.
MeshArray sendTuples(RankGroup& group, const MeshArray& array, const RankRows& rows);
}
#endif
