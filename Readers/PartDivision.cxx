// SPDX-License-Identifier: BSD-3-Clause
#include "PartDivision.h"

#include "MeshPart.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>

namespace tautline
{
namespace
{
__extension__ typedef unsigned __int128 Key; // a place along an axis, then the number of a cell
constexpr int numberBits = 64;

/// A double as a number in the same order; both zeros are one.
std::uint64_t ordered(double value)
{
  constexpr std::uint64_t sign = std::uint64_t(1) << 63;
  const double one = value == 0.0 ? 0.0 : value;
  std::uint64_t bits;
  std::memcpy(&bits, &one, sizeof(bits));
  return bits & sign ? ~bits : bits | sign;
}

/// An own cell and its place along an axis.
struct PlacedCell
{
  std::uint64_t place;
  Index cell;
  bool operator<(const PlacedCell& other) const
  {
    return this->place < other.place || (this->place == other.place && this->cell < other.cell);
  }
};

/// Cells that are divided among some parts.
struct PartGroup
{
  int first, parts;
  Index total;            ///< cells on all ranks
  std::size_t begin, end; ///< of the own ones
};

/// What the ranks find out together about their cells.
class Division
{
public:
  /// @param points coordinates of the places that the connectivity has
  Division(const FileRanges& ranges, const MeshFile& mesh, const std::vector<double>& points,
    const std::vector<Index>& numbers)
    : Ranges(ranges)
    , Group(ranges.group())
    , Mesh(mesh)
    , Points(points)
    , Numbers(numbers)
  {
    ranges.together(
      [&]
      {
        this->Cells.resize(numbers.size());
        for (std::size_t i = 0; i < this->Cells.size(); ++i)
        {
          this->Cells[i].cell = static_cast<Index>(i);
        }
      });
  }

  /// The part of each own cell.
  std::vector<int> parts()
  {
    std::vector<PartGroup> groups = { { 0, this->Group.size(),
      this->Group.sum(static_cast<Index>(this->Cells.size())), 0, this->Cells.size() } };
    const auto whole = [](const PartGroup& g) { return g.parts == 1; };
    while (!std::all_of(groups.begin(), groups.end(), whole))
    {
      groups = this->halve(groups);
    }
    return this->Ranges.agreed(
      [&]
      {
        std::vector<int> result(this->Cells.size());
        for (const PartGroup& g : groups)
        {
          for (std::size_t i = g.begin; i < g.end; ++i)
          {
            result[at(this->Cells[i].cell)] = g.first;
          }
        }
        return result;
      });
  }

private:
  double centre(Index cell, int axis) const
  {
    const Index* nodes = this->Mesh.connectivity.data();
    const std::vector<Index>& offsets = this->Mesh.offsets;
    return cellCentre(this->Points, nodes + offsets[at(cell)], nodes + offsets[at(cell) + 1], axis);
  }

  Key key(const PlacedCell& cell) const
  {
    return Key(cell.place) << numberBits | static_cast<std::uint64_t>(this->Numbers[at(cell.cell)]);
  }

  /// The longest axis of each group.
  std::vector<int> axes(const std::vector<PartGroup>& groups)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    using Box = std::array<std::array<double, 3>, 2>;
    std::vector<Box> boxes;
    for (const PartGroup& g : groups)
    {
      Box box{ { { infinity, infinity, infinity }, { -infinity, -infinity, -infinity } } };
      for (std::size_t i = g.begin; i < g.end; ++i)
      {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          const double place = this->centre(this->Cells[i].cell, static_cast<int>(axis));
          box[0][axis] = std::min(box[0][axis], place);
          box[1][axis] = std::max(box[1][axis], place);
        }
      }
      boxes.push_back(box);
    }
    for (const std::vector<Box>& other : this->Group.gatherItems(boxes))
    {
      for (std::size_t g = 0; g < boxes.size(); ++g)
      {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          boxes[g][0][axis] = std::min(boxes[g][0][axis], other[g][0][axis]);
          boxes[g][1][axis] = std::max(boxes[g][1][axis], other[g][1][axis]);
        }
      }
    }
    std::vector<int> result;
    for (const Box& box : boxes)
    {
      result.push_back(longestAxis(box[0], box[1]));
    }
    return result;
  }

  /// Of each group the largest key that has at most so many cells below it, which is that of a
  /// cell. Own cells are sorted. Each round divides the range of a key by `ways`.
  std::vector<Key> keysAt(const std::vector<PartGroup>& groups, const std::vector<Index>& below)
  {
    constexpr Key infinity = Key(0xfff1) << 112; // above the key of any number
    constexpr std::size_t most = 64, together = 256;
    const std::size_t ways = std::clamp(together / groups.size(), std::size_t(2), most);
    std::vector<Key> low(groups.size(), 0), high(groups.size(), infinity);
    while (low != high)
    {
      std::vector<Key> keys;
      std::vector<Index> counts;
      for (std::size_t g = 0; g < groups.size(); ++g)
      {
        const Key step = (high[g] - low[g]) / ways + 1;
        for (std::size_t k = 1; k < ways; ++k)
        {
          keys.push_back(std::min(low[g] + step * k, high[g]));
          counts.push_back(this->cellsBelow(groups[g], keys.back()));
        }
      }
      std::vector<Index> sums(counts.size(), 0);
      for (const std::vector<Index>& other : this->Group.gatherItems(counts))
      {
        std::transform(sums.begin(), sums.end(), other.begin(), sums.begin(), std::plus<Index>());
      }
      for (std::size_t i = 0; i < keys.size(); ++i)
      {
        const std::size_t g = i / (ways - 1);
        if (sums[i] <= below[g])
        {
          low[g] = keys[i];
        }
        else
        {
          high[g] = std::max(low[g], std::min(high[g], keys[i] - 1));
        }
      }
    }
    return low;
  }

  Index cellsBelow(const PartGroup& g, Key key) const
  {
    const auto begin = this->Cells.begin() + static_cast<std::ptrdiff_t>(g.begin);
    const auto end = this->Cells.begin() + static_cast<std::ptrdiff_t>(g.end);
    return std::lower_bound(begin, end, key,
             [this](const PlacedCell& cell, Key other) { return this->key(cell) < other; }) -
      begin;
  }

  std::vector<PartGroup> halve(const std::vector<PartGroup>& groups)
  {
    const std::vector<int> axis = this->axes(groups);
    std::vector<Index> below;
    for (std::size_t g = 0; g < groups.size(); ++g)
    {
      const PartGroup& old = groups[g]; // cells of one part remain sorted
      for (std::size_t i = old.begin; old.parts > 1 && i < old.end; ++i)
      {
        this->Cells[i].place = ordered(this->centre(this->Cells[i].cell, axis[g]));
      }
      const auto begin = this->Cells.begin();
      std::sort(begin + static_cast<std::ptrdiff_t>(old.begin),
        begin + static_cast<std::ptrdiff_t>(old.end));
      below.push_back(PartHalves(old.parts, old.total).lowCells);
    }
    const std::vector<Key> cuts = this->keysAt(groups, below);
    std::vector<PartGroup> result;
    for (std::size_t g = 0; g < groups.size(); ++g)
    {
      const PartGroup& old = groups[g];
      if (old.parts == 1)
      {
        result.push_back(old);
        continue;
      }
      const int lowParts = PartHalves(old.parts, old.total).lowParts;
      const std::size_t middle = old.begin + at(this->cellsBelow(old, cuts[g]));
      result.push_back({ old.first, lowParts, below[g], old.begin, middle });
      result.push_back(
        { old.first + lowParts, old.parts - lowParts, old.total - below[g], middle, old.end });
    }
    return result;
  }

  const FileRanges& Ranges;
  RankGroup& Group;
  const MeshFile& Mesh;
  const std::vector<double>& Points;
  const std::vector<Index>& Numbers;
  std::vector<PlacedCell> Cells; ///< in order of the groups
};
}

//------------------------------------------------------------------------------
std::vector<int> divideCells(const FileRanges& ranges, const MeshFile& mesh,
  const std::vector<double>& points, const std::vector<Index>& numbers)
{
  return Division(ranges, mesh, points, numbers).parts();
}
}
