// SPDX-License-Identifier: BSD-3-Clause
#include "Aggregation.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tautline
{
namespace
{
constexpr double weakest = 0.25; // weakest coupling that joins rows, relative to the strongest

/// The rows of each aggregate.
struct Members
{
  std::vector<std::int32_t> starts, rows;

  Members(const std::vector<std::int32_t>& aggregate, std::int32_t count)
    : starts(count + 1, 0)
    , rows(aggregate.size())
  {
    for (const std::int32_t a : aggregate)
    {
      ++this->starts[a + 1];
    }
    for (std::int32_t a = 0; a < count; ++a)
    {
      this->starts[a + 1] += this->starts[a];
    }
    std::vector<std::int32_t> next(this->starts.begin(), this->starts.end() - 1);
    for (std::size_t row = 0; row < aggregate.size(); ++row)
    {
      this->rows[next[aggregate[row]]++] = static_cast<std::int32_t>(row);
    }
  }
};
}

//------------------------------------------------------------------------------
std::int32_t pairUp(const Graph& graph, std::vector<std::int32_t>& aggregate)
{
  const std::int32_t rows = static_cast<std::int32_t>(graph.starts.size()) - 1;
  aggregate.assign(rows, -1);
  std::int32_t count = 0;
  for (std::int32_t row = 0; row < rows; ++row)
  {
    if (aggregate[row] >= 0)
    {
      continue;
    }
    float strongest = 0, best = 0;
    std::int32_t partner = -1;
    for (std::int32_t i = graph.starts[row]; i < graph.starts[row + 1]; ++i)
    {
      const std::int32_t column = graph.columns[i];
      if (column == row)
      {
        continue;
      }
      const float strength = graph.strengths[i];
      // All neighbors count, also those already paired: a weakly coupled free neighbor is then
      // rejected.
      strongest = std::max(strongest, strength);
      if (aggregate[column] < 0 && strength > best)
      {
        best = strength;
        partner = column;
      }
    }
    // A row without a strongly coupled free neighbor stays alone, because a weak partner would make
    // the coarse correction worse.
    aggregate[row] = count;
    if (partner >= 0 && best >= static_cast<float>(weakest) * strongest)
    {
      aggregate[partner] = count;
    }
    ++count;
  }
  return count;
}

//------------------------------------------------------------------------------
Graph joined(const Graph& fine, const std::vector<std::int32_t>& aggregate, std::int32_t count,
  std::vector<std::int32_t>& places)
{
  const Members members(aggregate, count);
  Graph coarse;
  coarse.starts.assign(count + 1, 0);
  coarse.columns.reserve(fine.columns.size() / 2);
  std::vector<std::int32_t> placeOf(count, -1), found;
  places.resize(fine.columns.size());
  for (std::int32_t a = 0; a < count; ++a)
  {
    found.clear();
    const auto forEachPlace = [&](const auto& visit)
    {
      for (std::int32_t m = members.starts[a]; m < members.starts[a + 1]; ++m)
      {
        const std::int32_t row = members.rows[m];
        for (std::int32_t i = fine.starts[row]; i < fine.starts[row + 1]; ++i)
        {
          visit(i, aggregate[fine.columns[i]]);
        }
      }
    };
    // First list the columns of all rows of the aggregate: entries get their places only after the
    // columns are sorted.
    forEachPlace(
      [&](std::int32_t, std::int32_t column)
      {
        if (placeOf[column] < 0)
        {
          placeOf[column] = 0;
          found.push_back(column);
        }
      });
    std::sort(found.begin(), found.end());
    const std::int32_t begin = coarse.starts[a];
    for (std::size_t k = 0; k < found.size(); ++k)
    {
      placeOf[found[k]] = begin + static_cast<std::int32_t>(k);
    }
    coarse.columns.insert(coarse.columns.end(), found.begin(), found.end());
    coarse.strengths.resize(coarse.columns.size(), 0.0F);
    coarse.starts[a + 1] = static_cast<std::int32_t>(coarse.columns.size());
    forEachPlace(
      [&](std::int32_t i, std::int32_t column)
      {
        coarse.strengths[placeOf[column]] += fine.strengths[i];
        places[i] = placeOf[column];
      });
    // Reset only the entries that were used, so that the cost does not grow with the number of
    // columns.
    for (const std::int32_t column : found)
    {
      placeOf[column] = -1;
    }
  }
  return coarse;
}

//------------------------------------------------------------------------------
Aggregates aggregate(Graph fine, int pairings)
{
  Aggregates found;
  found.ofRow.resize(fine.starts.size() - 1);
  std::iota(found.ofRow.begin(), found.ofRow.end(), 0);
  found.places.resize(fine.columns.size());
  std::iota(found.places.begin(), found.places.end(), 0);
  found.graph = std::move(fine);
  std::vector<std::int32_t> pairs, moved;
  std::int32_t count = 0;
  // The maps of successive pairings are composed, so that they lead from the finest rows to the
  // last aggregates of up to 2^pairings rows.
  for (int i = 0; i < pairings; ++i)
  {
    count = pairUp(found.graph, pairs);
    found.graph = joined(found.graph, pairs, count, moved);
    for (std::int32_t& row : found.ofRow)
    {
      row = pairs[row];
    }
    for (std::int32_t& place : found.places)
    {
      place = moved[place];
    }
  }
  // Columns ascend within a row, so bisection finds the diagonal.
  found.diagonals.resize(count);
  for (std::int32_t row = 0; row < count; ++row)
  {
    const auto columns = found.graph.columns.begin();
    const auto begin = columns + found.graph.starts[row],
               end = columns + found.graph.starts[row + 1];
    found.diagonals[row] = static_cast<std::int32_t>(std::lower_bound(begin, end, row) - columns);
  }
  return found;
}
}
