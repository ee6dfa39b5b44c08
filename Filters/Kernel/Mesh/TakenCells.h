// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TakenCells.h
 * @brief The cells that a rank gets of a mesh on several ranks. Internal: not installed.
 */
#ifndef tautline_TakenCells_h
#define tautline_TakenCells_h

#include "tautline/Core/Types.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace tautline
{
/**
 * @class tautline::TakenCells
 * @brief The cells that came from all ranks, in an order that follows from their points. They stay
 * in the lists they came in: type, number of points, local points in the order of their numbers.
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
  TakenCells(std::vector<std::vector<Index>> lists, Index points)
    : Lists(std::move(lists))
  {
    // By the lowest point first, then the few cells that have it in common.
    std::vector<std::size_t> ends(points + 1, 0);
    this->forEach([&ends](const Cell& cell) { ++ends[cell.least + 1]; });
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    this->Cells.resize(ends.back());
    this->forEach([&](const Cell& cell) { this->Cells[ends[cell.least]++] = cell; });
    std::size_t begin = 0;
    Sorted scratch;
    for (Index point = 0; point < points; begin = ends[point++])
    {
      this->sort(this->Cells.data() + begin, this->Cells.data() + ends[point], scratch);
    }
  }

  const std::vector<Cell>& cells() const { return this->Cells; }
  Index type(const Cell& cell) const { return this->list(cell)[0]; }
  const Index* begin(const Cell& cell) const { return this->list(cell) + 2; }
  const Index* end(const Cell& cell) const { return this->begin(cell) + this->list(cell)[1]; }
  /// Whether the types and the points are the same, in any order.
  bool same(const Cell& a, const Cell& b) const
  {
    return this->type(a) == this->type(b) &&
      std::is_permutation(this->begin(a), this->end(a), this->begin(b), this->end(b));
  }

private:
  /// Cells and their points in increasing order.
  struct Sorted
  {
    struct Item
    {
      Cell cell;
      std::size_t begin, end; ///< of its points
    };
    std::vector<Item> items;
    std::vector<Index> points;
  };

  const Index* list(const Cell& cell) const { return this->Lists[cell.rank].data() + cell.at; }

  /// Sorts by the points, then by the type, then by the order of the points in the cell.
  void sort(Cell* first, Cell* last, Sorted& sorted) const
  {
    if (last - first < 2)
    {
      return;
    }
    sorted.items.clear();
    sorted.points.clear();
    for (const Cell* cell = first; cell != last; ++cell)
    {
      const std::size_t begin = sorted.points.size();
      sorted.points.insert(sorted.points.end(), this->begin(*cell), this->end(*cell));
      std::sort(sorted.points.begin() + static_cast<std::ptrdiff_t>(begin), sorted.points.end());
      sorted.items.push_back({ *cell, begin, sorted.points.size() });
    }
    std::sort(sorted.items.begin(), sorted.items.end(),
      [&](const Sorted::Item& a, const Sorted::Item& b)
      {
        const Index* points = sorted.points.data();
        const auto [one, other] =
          std::mismatch(points + a.begin, points + a.end, points + b.begin, points + b.end);
        if (one != points + a.end && other != points + b.end)
        {
          return *one < *other;
        }
        const std::size_t ofOne = a.end - a.begin, ofOther = b.end - b.begin;
        return ofOne != ofOther ? ofOne < ofOther
          : this->type(a.cell) != this->type(b.cell)
          ? this->type(a.cell) < this->type(b.cell)
          : std::lexicographical_compare(
              this->begin(a.cell), this->end(a.cell), this->begin(b.cell), this->end(b.cell));
      });
    for (const Sorted::Item& item : sorted.items)
    {
      *first++ = item.cell;
    }
  }

  template <class Visit>
  void forEach(const Visit& visit) const
  {
    for (std::size_t rank = 0; rank < this->Lists.size(); ++rank)
    {
      const std::vector<Index>& list = this->Lists[rank];
      for (std::size_t i = 0; i < list.size(); i += 2 + static_cast<std::size_t>(list[i + 1]))
      {
        Cell cell = { static_cast<Index>(i), static_cast<std::int32_t>(rank), 0 };
        cell.least =
          static_cast<std::int32_t>(*std::min_element(this->begin(cell), this->end(cell)));
        visit(cell);
      }
    }
  }

  std::vector<std::vector<Index>> Lists; ///< per rank
  std::vector<Cell> Cells;
};
}
#endif
