// SPDX-License-Identifier: BSD-3-Clause
#include "CoordinateOrder.h"

#include "MeshElements.h"
#include "SampleSort.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tautline
{
namespace
{
struct PlacedPoint
{
  std::array<double, 3> place;
  Index number;
  Index local;

  bool operator<(const PlacedPoint& other) const
  {
    return this->place != other.place ? this->place < other.place : this->number < other.number;
  }
};

/// @param x its coordinates; -0 is converted to 0
PlacedPoint placedAt(const double* x, Index number, Index local)
{
  return { { x[0] + 0.0, x[1] + 0.0, x[2] + 0.0 }, number, local };
}
}

//------------------------------------------------------------------------------
std::vector<Index> coordinateOrder(const DistributedMesh& mesh)
{
  RankGroup& group = mesh.group();
  std::vector<PlacedPoint> own;
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    if (mesh.owned(p))
    {
      own.push_back(placedAt(&mesh.points()[3 * p], mesh.numbers()[p], p));
    }
  }
  std::sort(own.begin(), own.end());
  // Sample sort: each rank receives a contiguous range of the order.
  const std::vector<std::vector<PlacedPoint>> sent = splitIntoRanges(group, own);
  const std::vector<std::vector<PlacedPoint>> received = group.exchangeItems(sent);

  // The points of a range come from all ranks; their positions are sent back in the order of
  // arrival.
  struct Arrival
  {
    PlacedPoint point;
    int rank;
    std::size_t at;
  };
  std::vector<Arrival> range;
  std::vector<std::vector<Index>> places(group.size());
  for (int rank = 0; rank < group.size(); ++rank)
  {
    for (std::size_t i = 0; i < received[rank].size(); ++i)
    {
      range.push_back({ received[rank][i], rank, i });
    }
    places[rank].resize(received[rank].size());
  }
  std::sort(range.begin(), range.end(),
    [](const Arrival& a, const Arrival& b) { return a.point < b.point; });
  Index before = 0;
  // Ranges have the order of the ranks, so the counts of the lower ranks yield the first position.
  const auto lengths = group.gatherItems(std::vector<Index>{ static_cast<Index>(range.size()) });
  for (int rank = 0; rank < group.rank(); ++rank)
  {
    before += lengths[rank].front();
  }
  for (const Arrival& arrival : range)
  {
    places[arrival.rank][arrival.at] = before++;
  }
  const std::vector<std::vector<Index>> answers = group.exchangeItems(places);
  std::vector<double> order(mesh.localPoints(), 0.0); // exact: there are fewer than 2^53 points
  for (int rank = 0; rank < group.size(); ++rank)
  {
    for (std::size_t i = 0; i < sent[rank].size(); ++i)
    {
      order[sent[rank][i].local] = static_cast<double>(answers[rank][i]);
    }
  }
  mesh.exchange(order.data(), 1);
  return std::vector<Index>(order.begin(), order.end());
}

//------------------------------------------------------------------------------
std::vector<Index> coordinateOrder(
  const Mesh& mesh, const double* places, const std::vector<Index>& representative)
{
  const MeshView& view = mesh.view();
  std::vector<char> used(view.numberOfPoints, 0);
  for (const CellBlock& block : mesh.blocks())
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; isElement(mesh, block.type) && i < block.count; ++i)
    {
      const Index* points = view.connectivity + view.offsets[block.cell(i)];
      std::for_each(points, points + nodes, [&used](Index p) { used[p] = 1; });
    }
  }
  const auto isOne = [&](Index p) { return representative.empty() || representative[p] == p; };
  std::vector<PlacedPoint> ordered;
  std::vector<Index> others;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const double* x = places + 3 * p;
    const bool finite = std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
    if (isOne(p) && used[p] && finite)
    {
      ordered.push_back(placedAt(x, p, p));
    }
    else if (isOne(p))
    {
      // Unused points and points that are not finite come last, in their given order.
      others.push_back(p);
    }
  }
  std::sort(ordered.begin(), ordered.end());
  std::vector<Index> order(view.numberOfPoints, 0);
  Index next = 0;
  for (const PlacedPoint& point : ordered)
  {
    order[point.local] = next++;
  }
  for (const Index p : others)
  {
    order[p] = next++;
  }
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    order[p] = isOne(p) ? order[p] : order[representative[p]];
  }
  return order;
}
}
