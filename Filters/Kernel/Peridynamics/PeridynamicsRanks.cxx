// SPDX-License-Identifier: BSD-3-Clause
#include "PeridynamicsRanks.h"

#include "tautline/Mesh/PointDivision.h"

#include <algorithm>

namespace tautline
{
std::vector<int> ranksOfRows(RankGroup& group, const FunctionSpace& space)
{
  std::vector<int> ranks(space.unknowns, 0);
  if (group.size() == 1)
  {
    return ranks;
  }
  std::vector<Vec3> places;
  for (const Index f : space.functionOf)
  {
    const Vec2 middle = 0.5 * (space.low[f] + space.high[f]);
    places.push_back({ middle[0], middle[1], 0.0 });
  }
  // The data are the same on all ranks; one rank is enough for the division.
  const PointDivision division(group, group.rank() == 0 ? places : std::vector<Vec3>());
  std::transform(places.begin(), places.end(), ranks.begin(),
    [&division](const Vec3& x) { return division.find(x); });
  return ranks;
}

//------------------------------------------------------------------------------
void gatherRows(RankGroup& group, const std::vector<int>& ranks, PeridynamicSystem& system)
{
  SparseMatrix& matrix = system.matrix;
  const Index c = system.components;
  const bool loaded = !system.constraintLoad.empty();
  for (int rank = 1; rank < group.size(); ++rank)
  {
    const auto forEachRow = [&](const auto& visit)
    {
      for (Index row = 0; row < matrix.size; ++row)
      {
        if (ranks[row / c] == rank)
        {
          visit(row, matrix.offsets[row], matrix.offsets[row + 1]);
        }
      }
    };
    std::vector<std::vector<double>> sent(group.size());
    std::vector<double>& own = sent[0];
    if (group.rank() == rank)
    {
      forEachRow(
        [&](Index row, Index begin, Index end)
        {
          own.insert(own.end(), matrix.values.begin() + begin, matrix.values.begin() + end);
          if (loaded)
          {
            own.push_back(system.constraintLoad[row]);
          }
        });
      matrix = SparseMatrix();
    }
    const std::vector<double> values = std::move(group.exchangeItems(sent)[rank]);
    if (group.rank() == 0)
    {
      auto value = values.begin();
      forEachRow(
        [&](Index row, Index begin, Index end)
        {
          std::copy_n(value, end - begin, matrix.values.begin() + begin);
          value += end - begin;
          if (loaded)
          {
            system.constraintLoad[row] = *value++;
          }
        });
    }
  }
}
}
