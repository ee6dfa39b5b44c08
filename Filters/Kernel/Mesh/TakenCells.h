// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TakenCells.h
 * @brief The cells that a rank gets of a mesh on several ranks. Internal: not installed.
 */
#ifndef tautline_TakenCells_h
#define tautline_TakenCells_h

#include "tautline/Core/Types.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tautline
{
/**
 * @class tautline::TakenCells
 * @brief The cells that came from all ranks, in an order that follows from the numbers of their
 * points. They stay in the lists they came in: type, number of points, their numbers.
 */
class TakenCells
{
public:
  struct Cell
  {
    Index least; ///< number of a point; most comparisons end with it
    Index at;    ///< in the list
    std::int32_t rank;
  };

  explicit TakenCells(std::vector<std::vector<Index>> lists)
    : Lists(std::move(lists))
  {
    std::size_t count = 0;
    this->forEach([&count](const Cell&) { ++count; });
    this->Cells.reserve(count);
    this->forEach([this](const Cell& cell) { this->Cells.push_back(cell); });
    std::vector<Index> one, other;
    std::sort(this->Cells.begin(), this->Cells.end(),
      [&](const Cell& a, const Cell& b)
      {
        if (a.least != b.least)
        {
          return a.least < b.least;
        }
        this->sort(a, one);
        this->sort(b, other);
        return one != other                ? one < other
          : this->type(a) != this->type(b) ? this->type(a) < this->type(b)
                                           : std::lexicographical_compare(this->begin(a),
                                               this->end(a), this->begin(b), this->end(b));
      });
  }

  const std::vector<Cell>& cells() const { return this->Cells; }
  Index type(const Cell& cell) const { return this->list(cell)[0]; }
  const Index* begin(const Cell& cell) const { return this->list(cell) + 2; }
  const Index* end(const Cell& cell) const { return this->begin(cell) + this->list(cell)[1]; }
  /// Whether the types and the points are the same, in any order.
  bool same(const Cell& a, const Cell& b) const
  {
    std::vector<Index> one, other;
    this->sort(a, one);
    this->sort(b, other);
    return this->type(a) == this->type(b) && one == other;
  }

private:
  const Index* list(const Cell& cell) const { return this->Lists[cell.rank].data() + cell.at; }
  void sort(const Cell& cell, std::vector<Index>& numbers) const
  {
    numbers.assign(this->begin(cell), this->end(cell));
    std::sort(numbers.begin(), numbers.end());
  }
  template <class Visit>
  void forEach(const Visit& visit) const
  {
    for (std::size_t rank = 0; rank < this->Lists.size(); ++rank)
    {
      const std::vector<Index>& list = this->Lists[rank];
      for (std::size_t i = 0; i < list.size(); i += 2 + static_cast<std::size_t>(list[i + 1]))
      {
        Cell cell = { -1, static_cast<Index>(i), static_cast<std::int32_t>(rank) };
        cell.least = list[i + 1] > 0 ? *std::min_element(this->begin(cell), this->end(cell)) : -1;
        visit(cell);
      }
    }
  }

  std::vector<std::vector<Index>> Lists; ///< per rank
  std::vector<Cell> Cells;
};
}
#endif
