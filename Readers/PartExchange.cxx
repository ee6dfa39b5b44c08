// SPDX-License-Identifier: BSD-3-Clause
#include "PartExchange.h"

#include "MeshPart.h"
#include "PartDivision.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// A set of numbers from 0 to a limit: a bit each, and the sum of those before per 64 of them.
class NumberSet
{
public:
  explicit NumberSet(Index limit)
    : Words(at(limit) / 64 + 1, 0)
  {
  }
  void add(Index i) { this->Words[at(i) / 64] |= std::uint64_t(1) << (i % 64); }
  /// The numbers in their order; place() is valid from now on.
  std::vector<Index> list()
  {
    std::vector<Index> all;
    this->Before.resize(this->Words.size());
    Index count = 0;
    for (std::size_t word = 0; word < this->Words.size(); ++word)
    {
      this->Before[word] = count;
      count += __builtin_popcountll(this->Words[word]);
    }
    all.reserve(at(count));
    for (std::size_t word = 0; word < this->Words.size(); ++word)
    {
      for (std::uint64_t bits = this->Words[word]; bits != 0; bits &= bits - 1)
      {
        all.push_back(static_cast<Index>(64 * word) + __builtin_ctzll(bits));
      }
    }
    return all;
  }
  /// How many smaller numbers are in the set.
  Index place(Index i) const
  {
    const std::uint64_t below = (std::uint64_t(1) << (i % 64)) - 1;
    return this->Before[at(i) / 64] + __builtin_popcountll(this->Words[at(i) / 64] & below);
  }

private:
  std::vector<std::uint64_t> Words;
  std::vector<Index> Before;
};

/// Points that a rank's cells have, wherever they are.
struct PointLinks
{
  std::vector<Index> points; ///< numbers in the file, in their order
  std::vector<Index> first;  ///< of the points, per rank that has them; one more
  RankRows asked;            ///< per rank: own points that it needs, counted from the first own one

  PointLinks(const FileRanges& ranges, const std::vector<Index>& begins, std::vector<Index> needed)
    : points(std::move(needed))
  {
    const RankGroup& group = ranges.group();
    RankRows questions;
    ranges.together(
      [&]
      {
        for (int rank = 0; rank < group.size(); ++rank)
        {
          const auto from = std::lower_bound(points.begin(), points.end(), begins[at(rank)]);
          const auto to = std::lower_bound(from, points.end(), begins[at(rank) + 1]);
          this->first.push_back(from - points.begin());
          questions.emplace_back(from, to);
        }
        this->first.push_back(static_cast<Index>(points.size()));
      });
    this->asked = sendLists(ranges, questions);
    for (std::vector<Index>& some : this->asked)
    {
      for (Index& point : some)
      {
        point -= begins[at(group.rank())];
      }
    }
  }
};

/// The points of cells; their connectivity becomes places in it.
PointLinks linkPoints(
  const FileRanges& ranges, const std::vector<Index>& begins, std::vector<Index>& connectivity)
{
  return PointLinks(ranges, begins,
    ranges.agreed(
      [&]
      {
        NumberSet used(begins.back());
        for (const Index point : connectivity)
        {
          used.add(point);
        }
        std::vector<Index> points = used.list();
        for (Index& point : connectivity)
        {
          point = used.place(point);
        }
        return points;
      }));
}

/// Numbers of the own cells in the file.
std::vector<Index> cellNumbers(const FileRanges& ranges, const std::vector<Index>& sectionCells)
{
  const std::vector<std::vector<Index>> all = ranges.group().gatherItems(sectionCells);
  return ranges.agreed(
    [&]
    {
      const std::size_t own = at(ranges.group().rank());
      std::vector<Index> numbers;
      Index next = 0;
      for (std::size_t section = 0; section < sectionCells.size(); ++section)
      {
        for (std::size_t rank = 0; rank < all.size(); ++rank)
        {
          for (Index i = 0; rank == own && i < all[rank][section]; ++i)
          {
            numbers.push_back(next + i);
          }
          next += all[rank][section];
        }
      }
      return numbers;
    });
}

//------------------------------------------------------------------------------
/// Two numbers: a point and a part that has a cell with it, or a part and one of its ghost cells.
using Pair = std::array<Index, 2>;

void sortUnique(std::vector<Pair>& pairs)
{
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Adds those that are not there; both are sorted. Returns what is new.
std::vector<Pair> addNew(std::vector<Pair>& all, const std::vector<Pair>& more)
{
  std::vector<Pair> fresh, sum;
  std::set_difference(more.begin(), more.end(), all.begin(), all.end(), std::back_inserter(fresh));
  std::merge(all.begin(), all.end(), fresh.begin(), fresh.end(), std::back_inserter(sum));
  all = std::move(sum);
  return fresh;
}

/// Which own cells are ghosts of which part.
class GhostSearch
{
public:
  GhostSearch(const FileRanges& ranges, const MeshFile& mesh, const PointLinks& links,
    const std::vector<int>& parts)
    : Ranges(ranges)
    , Mesh(mesh)
    , Links(links)
    , Parts(parts)
  {
  }

  /// Pairs of a part and a cell, in their order.
  std::vector<Pair> ghosts(int layers)
  {
    std::vector<Pair> found, reached;
    for (int layer = 0; layer < layers; ++layer)
    {
      std::vector<std::vector<Pair>> told = this->Ranges.agreed(
        [&] { return this->forOwners(layer == 0 ? this->ownPoints() : std::move(reached)); });
      told = sendLists(this->Ranges, told);
      told = this->Ranges.agreed([&] { return this->answers(told, layer == 0); });
      told = sendLists(this->Ranges, told);
      this->Ranges.together(
        [&]
        {
          const std::vector<Pair> more = addNew(found, this->cellsAt(this->places(told)));
          reached.clear();
          for (const auto& [part, cell] : more)
          {
            for (Index i = this->Mesh.offsets[at(cell)]; i < this->Mesh.offsets[at(cell) + 1]; ++i)
            {
              reached.push_back({ this->Mesh.connectivity[at(i)], part });
            }
          }
          sortUnique(reached);
        });
    }
    return found;
  }

private:
  /// The places that a part has cells with: most have one part only.
  std::vector<Pair> ownPoints() const
  {
    std::vector<Index> first(this->Links.points.size(), -1);
    std::vector<Pair> pairs;
    for (std::size_t cell = 0; cell < this->Parts.size(); ++cell)
    {
      for (Index i = this->Mesh.offsets[cell]; i < this->Mesh.offsets[cell + 1]; ++i)
      {
        const Index place = this->Mesh.connectivity[at(i)];
        if (first[at(place)] < 0)
        {
          first[at(place)] = this->Parts[cell];
        }
        else if (first[at(place)] != this->Parts[cell])
        {
          pairs.push_back({ place, this->Parts[cell] });
        }
      }
    }
    for (std::size_t place = 0; place < first.size(); ++place)
    {
      pairs.push_back({ static_cast<Index>(place), first[place] });
    }
    sortUnique(pairs);
    return pairs;
  }

  /// Places and parts, for the ranks with the points.
  std::vector<std::vector<Pair>> forOwners(const std::vector<Pair>& pairs) const
  {
    std::vector<std::vector<Pair>> sent(this->Links.asked.size());
    for (const auto& [place, part] : pairs)
    {
      const int rank = rankOf(this->Links.first, place);
      sent[at(rank)].push_back({ place - this->Links.first[at(rank)], part });
    }
    return sent;
  }

  /// Of what a rank is told about its points, what is new, for all ranks with these points. A point
  /// with one part at first has no cells of others: these pairs are dropped.
  std::vector<std::vector<Pair>> answers(
    const std::vector<std::vector<Pair>>& received, bool atFirst)
  {
    std::vector<Pair> more;
    for (std::size_t rank = 0; rank < received.size(); ++rank)
    {
      for (const auto& [question, part] : received[rank])
      {
        more.push_back({ this->Links.asked[rank][at(question)], part });
      }
    }
    sortUnique(more);
    if (atFirst)
    {
      std::vector<Pair> several;
      for (std::size_t i = 0; i < more.size(); ++i)
      {
        if ((i > 0 && more[i - 1][0] == more[i][0]) ||
          (i + 1 < more.size() && more[i + 1][0] == more[i][0]))
        {
          several.push_back(more[i]);
        }
      }
      more = std::move(several);
    }
    const std::vector<Pair> fresh = addNew(this->Reached, more);
    std::vector<std::vector<Pair>> sent(received.size());
    for (std::size_t rank = 0; rank < sent.size(); ++rank)
    {
      const std::vector<Index>& asked = this->Links.asked[rank];
      auto next = fresh.begin();
      for (std::size_t question = 0; question < asked.size(); ++question)
      {
        for (; next != fresh.end() && (*next)[0] < asked[question]; ++next)
        {
        }
        for (auto pair = next; pair != fresh.end() && (*pair)[0] == asked[question]; ++pair)
        {
          sent[rank].push_back({ static_cast<Index>(question), (*pair)[1] });
        }
      }
    }
    return sent;
  }

  /// The places and parts of answers, sorted, as ranks have the points in their order.
  std::vector<Pair> places(const std::vector<std::vector<Pair>>& answers) const
  {
    std::vector<Pair> result;
    for (std::size_t rank = 0; rank < answers.size(); ++rank)
    {
      for (const auto& [question, part] : answers[rank])
      {
        result.push_back({ this->Links.first[rank] + question, part });
      }
    }
    return result;
  }

  /// Own cells that have one of the places, as ghosts of the parts there.
  std::vector<Pair> cellsAt(const std::vector<Pair>& reached) const
  {
    std::vector<Index> begins(this->Links.points.size() + 1, 0);
    for (const Pair& pair : reached)
    {
      ++begins[at(pair[0]) + 1];
    }
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    std::vector<Pair> result;
    for (std::size_t cell = 0; cell < this->Parts.size(); ++cell)
    {
      for (Index i = this->Mesh.offsets[cell]; i < this->Mesh.offsets[cell + 1]; ++i)
      {
        const std::size_t place = at(this->Mesh.connectivity[at(i)]);
        for (Index r = begins[place]; r < begins[place + 1]; ++r)
        {
          if (reached[at(r)][1] != this->Parts[cell])
          {
            result.push_back({ reached[at(r)][1], static_cast<Index>(cell) });
          }
        }
      }
    }
    sortUnique(result);
    return result;
  }

  const FileRanges& Ranges;
  const MeshFile& Mesh;
  const PointLinks& Links;
  const std::vector<int>& Parts;
  std::vector<Pair> Reached; ///< own points and parts, in their order
};

//------------------------------------------------------------------------------
/// Takes the vector out of an object, so that its memory is free before others are made.
template <class Vector>
Vector taken(Vector& from)
{
  Vector result;
  result.swap(from);
  return result;
}

/// The items of all lists.
std::vector<Index> joined(const std::vector<std::vector<Index>>& lists)
{
  std::vector<Index> all;
  for (const std::vector<Index>& some : lists)
  {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// Own points that no cell of any rank has, as numbers in the file, on the first rank.
std::vector<Index> loosePoints(
  const FileRanges& ranges, const PointLinks& links, const std::vector<Index>& begins)
{
  const std::size_t own = at(ranges.group().rank());
  const RankRows sent = ranges.agreed(
    [&]
    {
      const Index first = begins[own], count = begins[own + 1] - first;
      std::vector<char> used(at(count), 0);
      for (const std::vector<Index>& some : links.asked)
      {
        for (const Index point : some)
        {
          used[at(point)] = 1;
        }
      }
      RankRows rows(links.asked.size());
      for (Index point = 0; point < count; ++point)
      {
        if (!used[at(point)])
        {
          rows[0].push_back(first + point);
        }
      }
      return rows;
    });
  return ranges.agreed([&, all = sendLists(ranges, sent)] { return joined(all); });
}

/// The cells of a part, with numbers of points in the file.
struct PartCells
{
  MeshFile mesh;
  std::vector<Index> numbers;
  Index owned = 0; ///< the first ones; ghosts follow
};

PartCells sendCells(const FileRanges& ranges, MeshFile& mesh, const std::vector<Index>& numbers,
  const std::vector<int>& parts, const std::vector<Pair>& ghosts)
{
  // Ghosts are sent with numbers behind all others, so that they are sorted behind own cells.
  const Index total = ranges.group().sum(mesh.numberOfCells());
  RankRows rows(at(ranges.group().size()));
  std::vector<std::vector<Index>> keys(rows.size());
  ranges.together(
    [&]
    {
      for (std::size_t cell = 0; cell < parts.size(); ++cell)
      {
        rows[at(parts[cell])].push_back(static_cast<Index>(cell));
        keys[at(parts[cell])].push_back(numbers[cell]);
      }
      for (const auto& [part, cell] : ghosts)
      {
        rows[at(part)].push_back(cell);
        keys[at(part)].push_back(total + numbers[at(cell)]);
      }
    });
  keys = sendLists(ranges, taken(keys));
  PartCells result;
  std::vector<Index> senders; // where the cells of each begin
  std::vector<Index> place;   // in the part, of the cells as they arrive
  ranges.together(
    [&]
    {
      Index begin = 0;
      for (const std::vector<Index>& some : keys)
      {
        senders.push_back(begin);
        begin += static_cast<Index>(some.size());
      }
      result.numbers = joined(taken(keys));
      place.resize(result.numbers.size());
      std::vector<Index> order(place.size());
      std::iota(order.begin(), order.end(), Index(0));
      std::sort(order.begin(), order.end(),
        [&](Index a, Index b) { return result.numbers[at(a)] < result.numbers[at(b)]; });
      for (std::size_t i = 0; i < order.size(); ++i)
      {
        place[at(order[i])] = static_cast<Index>(i);
      }
    });

  MeshFile& part = result.mesh;
  const std::vector<unsigned char> types = sendRows(ranges, mesh.cellTypes, rows, 1);
  ranges.together(
    [&]
    {
      part.cellTypes.resize(place.size());
      for (std::size_t i = 0; i < place.size(); ++i)
      {
        part.cellTypes[at(place[i])] = types[i];
      }
      part.offsets.reserve(place.size() + 1);
      for (const unsigned char type : part.cellTypes)
      {
        part.offsets.push_back(part.offsets.back() + cellNodes(type));
      }
      part.connectivity.resize(at(part.offsets.back()));
    });
  std::vector<Index> next = senders;
  sendRowsTo(ranges, mesh.connectivity, rows, 1, &mesh.offsets,
    [&](std::size_t sender, const Index* nodes, std::size_t count)
    {
      for (std::size_t i = 0; i < count; ++next[sender])
      {
        const Index cell = place[at(next[sender])];
        const Index size = part.offsets[at(cell) + 1] - part.offsets[at(cell)];
        std::copy_n(nodes + i, size, part.connectivity.begin() + part.offsets[at(cell)]);
        i += at(size);
      }
    });
  taken(mesh.connectivity);
  taken(mesh.offsets);
  for (MeshArray& array : mesh.cellArrays)
  {
    MeshArray to = ranges.agreed(
      [&]
      {
        return MeshArray::make(
          array.name, array.components, array.code(), place.size() * at(array.components));
      });
    std::visit(
      [&](auto& values)
      {
        using Values = std::decay_t<decltype(values)>;
        const Index width = array.components;
        next = senders;
        sendRowsTo(ranges, std::get<Values>(array.values), rows, width, nullptr,
          [&](std::size_t sender, const typename Values::value_type* some, std::size_t count)
          {
            for (std::size_t i = 0; i < count; i += at(width), ++next[sender])
            {
              std::copy_n(some + i, width, values.begin() + width * place[at(next[sender])]);
            }
          });
      },
      to.values);
    part.cellArrays.push_back(std::move(to));
    array = MeshArray();
  }
  std::sort(result.numbers.begin(), result.numbers.end());
  for (Index& number : result.numbers)
  {
    result.owned += number < total;
    number -= number < total ? 0 : total;
  }
  return result;
}
}

//------------------------------------------------------------------------------
std::vector<Index> rankBegins(RankGroup& group, Index own)
{
  std::vector<Index> begins = { 0 };
  for (const std::vector<Index>& count : group.gatherItems(std::vector<Index>{ own }))
  {
    begins.push_back(begins.back() + count[0]);
  }
  return begins;
}

//------------------------------------------------------------------------------
int rankOf(const std::vector<Index>& begins, Index item)
{
  return static_cast<int>(
    std::upper_bound(begins.begin(), begins.end(), item) - begins.begin() - 1);
}

//------------------------------------------------------------------------------
RankRows realignedRows(
  const RankGroup& group, const std::vector<Index>& from, const std::vector<Index>& to)
{
  const std::size_t own = at(group.rank());
  RankRows rows(at(group.size()));
  for (std::size_t rank = 0; rank < rows.size(); ++rank)
  {
    const Index end = std::min(from[own + 1], to[rank + 1]);
    for (Index item = std::max(from[own], to[rank]); item < end; ++item)
    {
      rows[rank].push_back(item - from[own]);
    }
  }
  return rows;
}

//------------------------------------------------------------------------------
MeshArray sendTuples(const FileRanges& ranges, const MeshArray& array, const RankRows& rows)
{
  MeshArray result{ array.name, array.components, {} };
  std::visit([&](const auto& values)
    { result.values = sendRows(ranges, values, rows, array.components); },
    array.values);
  return result;
}

//------------------------------------------------------------------------------
void keepHighestDimension(const FileRanges& ranges, MeshShare& share)
{
  const auto kept =
    static_cast<int>(ranges.group().maximum(static_cast<Index>(share.mesh.dimension())));
  std::size_t cell = 0;
  for (Index& cells : share.sectionCells)
  {
    const Index before = cells;
    for (Index i = 0; i < before; ++i, ++cell)
    {
      cells -= cellDimension(share.mesh.cellTypes[cell]) != kept;
    }
  }
  ranges.together([&] { share.mesh.keepDimension(kept); });
}

//------------------------------------------------------------------------------
MeshFile exchangeParts(const FileRanges& ranges, MeshShare share, int ghostLayers)
{
  MeshFile& mesh = share.mesh;
  const std::vector<Index> begins = rankBegins(ranges.group(), mesh.numberOfPoints());
  const std::vector<Index> numbers = cellNumbers(ranges, share.sectionCells);
  PartCells cells;
  std::vector<Index> loose;
  {
    const PointLinks links = linkPoints(ranges, begins, mesh.connectivity);
    ranges.poll();
    const std::vector<int> parts =
      divideCells(ranges, mesh, sendRows(ranges, mesh.points, links.asked, 3), numbers);
    ranges.poll();
    const std::vector<Pair> ghosts = GhostSearch(ranges, mesh, links, parts).ghosts(ghostLayers);
    ranges.poll();
    loose = loosePoints(ranges, links, begins);
    for (Index& node : mesh.connectivity)
    {
      node = links.points[at(node)];
    }
    cells = sendCells(ranges, mesh, numbers, parts, ghosts);
  }
  ranges.poll();

  MeshFile part = std::move(cells.mesh);
  std::optional<MeshArray::Bytes> ghostPoints, ghostCells;
  const PointLinks links(ranges, begins,
    ranges.agreed(
      [&]
      {
        NumberSet used(begins.back());
        const Index ownNodes = part.offsets[at(cells.owned)];
        for (const Index point : loose)
        {
          used.add(point);
        }
        for (const Index point : part.connectivity)
        {
          used.add(point);
        }
        std::vector<Index> points = used.list();
        for (Index& point : part.connectivity)
        {
          point = used.place(point);
        }
        if (ghostLayers > 0)
        {
          ghostPoints.emplace(points.size(), ghostFlag(true));
          ghostCells.emplace(part.cellTypes.size(), ghostFlag(true));
          std::fill_n(ghostCells->begin(), cells.owned, ghostFlag(false));
          std::for_each_n(part.connectivity.begin(), ownNodes,
            [&](Index point) { (*ghostPoints)[at(point)] = ghostFlag(false); });
          for (const Index point : loose)
          {
            (*ghostPoints)[at(used.place(point))] = ghostFlag(false);
          }
        }
        return points;
      }));
  part.points = sendRows(ranges, taken(mesh.points), links.asked, 3);
  for (MeshArray& array : mesh.pointArrays)
  {
    part.pointArrays.push_back(sendTuples(ranges, array, links.asked));
    array = MeshArray();
  }
  ranges.together(
    [&]
    {
      addPartArrays(part.pointArrays, PartPointIds, links.points, std::move(ghostPoints));
      addPartArrays(part.cellArrays, PartCellIds, std::move(cells.numbers), std::move(ghostCells));
    });
  part.fieldArrays = std::move(mesh.fieldArrays);
  part.fieldStrings = std::move(mesh.fieldStrings);
  part.warnings = std::move(mesh.warnings);
  return part;
}
}
