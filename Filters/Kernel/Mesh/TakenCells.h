// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TakenCells.h
 * @brief The cells that a rank receives in a mesh on several ranks.
 * Internal: not installed.
 */
#ifndef tautline_TakenCells_h
#define tautline_TakenCells_h

#include "Mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace tautline
{
/// Whether a cell of a view is used.
inline bool takesPart(const MeshView& view, Index cell)
{
  return cornerType(view.cellTypes[cell]) != CellType::Unsupported;
}

/**
 * @class tautline::TakenCells
 * @brief The cells received from all ranks, in an order determined by their points. They stay in
 * the received lists: type, number of points, local points in the order of their numbers.
 */
class TakenCells
{
public:
  struct Cell
  {
    Index at; ///< in the list
    std::int32_t rank;
    std::int32_t least; ///< the lowest of its points
  };

  /// Sorts the cells of the lists by their points, 0 to `points` - 1; a cell has at least one.
  TakenCells(std::vector<std::vector<std::int32_t>> lists, Index points)
    : Lists(std::move(lists))
  {
    // Sort by the lowest point first, then sort the few cells that share it.
    std::vector<std::size_t> ends(points + 1, 0);
    this->forEach([&ends](const Cell& cell) { ++ends[cell.least + 1]; });
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    this->Cells.resize(ends.back());
    this->forEach([&](const Cell& cell) { this->Cells[ends[cell.least]++] = cell; });
    std::size_t begin = 0;
    std::vector<Item> scratch;
    for (Index point = 0; point < points; begin = ends[point++])
    {
      this->sort(this->Cells.data() + begin, this->Cells.data() + ends[point], scratch);
    }
  }

  const std::vector<Cell>& cells() const { return this->Cells; }
  /// Leaves out the cells with nonzero flags. @param flags one per cell, or empty
  void drop(const std::vector<char>& flags)
  {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < this->Cells.size() && !flags.empty(); ++i)
    {
      if (!flags[i])
      {
        this->Cells[kept++] = this->Cells[i];
      }
    }
    this->Cells.resize(flags.empty() ? this->Cells.size() : kept);
  }
  std::int32_t type(const Cell& cell) const { return this->list(cell)[0]; }
  const std::int32_t* begin(const Cell& cell) const { return this->list(cell) + 2; }
  const std::int32_t* end(const Cell& cell) const
  {
    return this->begin(cell) + this->list(cell)[1];
  }
  /// Whether the types are the same and the points are the same in any order.
  bool same(const Cell& a, const Cell& b) const
  {
    return this->type(a) == this->type(b) &&
      std::is_permutation(this->begin(a), this->end(a), this->begin(b), this->end(b));
  }

private:
  /// A cell and its points in increasing order, without the lowest, which is common to all.
  struct Item
  {
    static constexpr int most = 7;
    /// then -1, so that the shorter of two cells with the same first points comes first
    std::int32_t points[most];
    Cell cell;
  };

  const std::int32_t* list(const Cell& cell) const
  {
    return this->Lists[cell.rank].data() + cell.at;
  }

  /// Sorts cells with the same lowest point by all points in increasing order, then by the type,
  /// then by the order of the points in the cell.
  void sort(Cell* first, Cell* last, std::vector<Item>& items) const
  {
    if (last - first < 2)
    {
      return;
    }
    items.clear();
    for (const Cell* cell = first; cell != last; ++cell)
    {
      Item& item = items.emplace_back();
      item.cell = *cell;
      std::fill_n(item.points, Item::most, -1);
      int count = 0;
      bool skipped = false;
      for (const std::int32_t* node = this->begin(*cell); node != this->end(*cell); ++node)
      {
        if (*node == cell->least && !skipped)
        {
          skipped = true;
          continue;
        }
        if (count == Item::most)
        {
          this->sortLong(first, last);
          return;
        }
        int at = count++;
        for (; at > 0 && item.points[at - 1] > *node; --at)
        {
          item.points[at] = item.points[at - 1];
        }
        item.points[at] = *node;
      }
    }
    const auto before = [this](const Item& a, const Item& b)
    {
      const int different =
        static_cast<int>(std::mismatch(a.points, a.points + Item::most, b.points).first - a.points);
      return different < Item::most ? a.points[different] < b.points[different]
                                    : this->comesFirst(a.cell, b.cell);
    };
    std::sort(items.begin(), items.end(), before);
    for (const Item& item : items)
    {
      *first++ = item.cell;
    }
  }

  /// The order of cells with the same points.
  bool comesFirst(const Cell& a, const Cell& b) const
  {
    return this->type(a) != this->type(b)
      ? this->type(a) < this->type(b)
      : std::lexicographical_compare(this->begin(a), this->end(a), this->begin(b), this->end(b));
  }

  /// The same as sort() for cells with too many points for an Item.
  void sortLong(Cell* first, Cell* last) const
  {
    const auto pointsOf = [this](const Cell& cell)
    {
      std::vector<std::int32_t> points(this->begin(cell), this->end(cell));
      std::sort(points.begin(), points.end());
      return points;
    };
    std::sort(first, last,
      [&](const Cell& a, const Cell& b)
      {
        const auto ofA = pointsOf(a), ofB = pointsOf(b);
        return ofA != ofB ? ofA < ofB : this->comesFirst(a, b);
      });
  }

  template <class Visit>
  void forEach(const Visit& visit) const
  {
    for (std::size_t rank = 0; rank < this->Lists.size(); ++rank)
    {
      const std::vector<std::int32_t>& list = this->Lists[rank];
      for (std::size_t i = 0; i < list.size(); i += 2 + static_cast<std::size_t>(list[i + 1]))
      {
        Cell cell = { static_cast<Index>(i), static_cast<std::int32_t>(rank), 0 };
        cell.least = *std::min_element(this->begin(cell), this->end(cell));
        visit(cell);
      }
    }
  }

  std::vector<std::vector<std::int32_t>> Lists; ///< per rank
  std::vector<Cell> Cells;
};
}
#endif
