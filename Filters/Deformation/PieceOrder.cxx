// SPDX-License-Identifier: BSD-3-Clause
#include "PieceOrder.h"

#include "CellEdges.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

namespace tautline
{
namespace
{
constexpr Index NoPlace = -1;

using Edge = std::array<Index, 2>;

/// An id that a process has, and whether it is chosen there.
struct SentId
{
  Index id;
  Index chosen;
};

/// Where a point is, and whether the piece owns it: it belongs to a cell that is no ghost.
struct SentPlace
{
  Vec3 place;
  Index own;
};

std::size_t mixed(std::size_t hash, std::size_t more)
{
  constexpr std::size_t odd = 0x9E3779B97F4A7C15ULL; // 2^64 over the golden ratio
  hash = (hash ^ more) * odd;
  return hash ^ (hash >> 32);
}

/// One flag per point of a piece: it belongs to a cell that is no ghost, or to none.
PointFlags ownPoints(vtkDataSet* piece)
{
  PointFlags own(piece->GetNumberOfPoints(), 1);
  vtkUnsignedCharArray* ghosts = piece->GetCellGhostArray();
  vtkNew<vtkIdList> points;
  for (const bool ofGhosts : { true, false })
  {
    for (vtkIdType cell = 0; ghosts && cell < piece->GetNumberOfCells(); ++cell)
    {
      const bool ghost = (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) != 0;
      if (ghost == ofGhosts)
      {
        piece->GetCellPoints(cell, points);
        std::for_each(
          points->begin(), points->end(), [&own, ghost](vtkIdType point) { own[point] = !ghost; });
      }
    }
  }
  return own;
}

/// The edges between points with positions, each once, by the process that compares them.
/// @param unknown set if an edge has a point without
std::vector<std::vector<Edge>> edgesByHome(
  int processes, const MeshView& view, const std::vector<Index>& positions, bool& unknown)
{
  std::vector<Edge> all;
  forEachEdge(view,
    [&](Index a, Index b)
    {
      const auto [low, high] = std::minmax(positions[a], positions[b]);
      unknown = unknown || low < 0;
      if (low >= 0)
      {
        all.push_back({ low, high });
      }
    });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<std::vector<Edge>> sent(processes);
  for (const Edge& edge : all)
  {
    const std::size_t hash =
      mixed(static_cast<std::size_t>(edge[0]), static_cast<std::size_t>(edge[1]));
    sent[hash % static_cast<std::size_t>(processes)].push_back(edge);
  }
  return sent;
}

std::vector<Edge> united(const std::vector<std::vector<Edge>>& lists)
{
  std::vector<Edge> all;
  for (const std::vector<Edge>& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}
}

//------------------------------------------------------------------------------
PieceIds idsOfPieces(RankGroup& group, vtkDataSet* piece)
{
  const vtkIdType points = piece ? piece->GetNumberOfPoints() : 0;
  vtkDataArray* given = points > 0 ? piece->GetPointData()->GetGlobalIds() : nullptr;
  PieceIds found;
  group.together(
    [&]
    {
      found.increase = given != nullptr;
      for (vtkIdType i = 0; given && i < points; ++i)
      {
        found.ids.push_back(static_cast<Index>(given->GetComponent(i, 0)));
        found.increase = found.increase && (i == 0 || found.ids[i - 1] < found.ids[i]);
      }
    });
  const bool one = group.sum(static_cast<Index>(points > 0)) < 2;
  const bool all = !group.any(points > 0 && !given);
  found.order = one ? PointOrder::Given : all ? PointOrder::ById : PointOrder::Coordinates;
  found.increase = one && !group.any(points > 0 && !found.increase);
  if (!all)
  {
    found.ids = {};
  }
  return found;
}

//------------------------------------------------------------------------------
std::vector<Index> positionsOf(
  RankGroup& group, const std::vector<Index>& ids, const PointFlags& chosen, Index& count)
{
  const int processes = group.size();
  Index highest = NoPlace;
  for (const Index id : ids)
  {
    highest = std::max(highest, id);
  }
  const Index width = group.maximum(highest) / processes + 1; // of a range of ids
  std::vector<std::vector<SentId>> sent;
  group.together(
    [&]
    {
      sent.resize(processes);
      for (std::size_t p = 0; p < ids.size(); ++p)
      {
        if (ids[p] >= 0)
        {
          sent[ids[p] / width].push_back({ ids[p], chosen[p] });
        }
      }
    });
  const std::vector<std::vector<SentId>> received = group.exchangeItems(sent);
  std::vector<Index> known;
  group.together(
    [&]
    {
      sent = {};
      for (const std::vector<SentId>& list : received)
      {
        for (const SentId& one : list)
        {
          if (one.chosen)
          {
            known.push_back(one.id);
          }
        }
      }
      std::sort(known.begin(), known.end());
      known.erase(std::unique(known.begin(), known.end()), known.end());
    });
  count = 0;
  Index before = 0;
  const auto counts = group.gatherItems(std::vector<Index>{ static_cast<Index>(known.size()) });
  for (int process = 0; process < processes; ++process)
  {
    before += process < group.rank() ? counts[process][0] : 0;
    count += counts[process][0];
  }
  std::vector<std::vector<Index>> answers;
  group.together(
    [&]
    {
      for (const std::vector<SentId>& list : received)
      {
        answers.emplace_back();
        for (const SentId& one : list)
        {
          const auto at = std::lower_bound(known.begin(), known.end(), one.id);
          const bool has = at != known.end() && *at == one.id;
          answers.back().push_back(has ? before + (at - known.begin()) : NoPlace);
        }
      }
    });
  const std::vector<std::vector<Index>> answered = group.exchangeItems(answers);
  std::vector<Index> positions;
  group.together(
    [&]
    {
      std::vector<std::size_t> next(processes, 0); // answers come in the order of the questions
      for (const Index id : ids)
      {
        positions.push_back(id < 0 ? NoPlace : answered[id / width][next[id / width]++]);
      }
    });
  return positions;
}

//------------------------------------------------------------------------------
bool edgesFit(RankGroup& group, const MeshView& mesh, const std::vector<Index>& ofMesh,
  const MeshView& target, const std::vector<Index>& ofTarget)
{
  bool unknown = false, others = false;
  std::vector<std::vector<Edge>> sent, asked;
  group.together(
    [&]
    {
      sent = edgesByHome(group.size(), mesh, ofMesh, others);
      asked = edgesByHome(group.size(), target, ofTarget, unknown);
    });
  const std::vector<std::vector<Edge>> edges = group.exchangeItems(sent);
  sent = {};
  const std::vector<std::vector<Edge>> questions = group.exchangeItems(asked);
  group.together(
    [&]
    {
      const std::vector<Edge> known = united(edges);
      for (const Edge& edge : united(questions))
      {
        unknown = unknown || !std::binary_search(known.begin(), known.end(), edge);
      }
    });
  return !group.any(unknown);
}

//------------------------------------------------------------------------------
Index countByPlace(RankGroup& group, vtkDataSet* piece, const PointFlags& flags)
{
  const auto processes = static_cast<std::size_t>(group.size());
  std::vector<std::vector<SentPlace>> sent;
  Index count = 0;
  group.together(
    [&]
    {
      sent.resize(processes);
      const PointFlags own = piece ? ownPoints(piece) : PointFlags();
      for (std::size_t p = 0; p < flags.size(); ++p)
      {
        Vec3 x;
        piece->GetPoint(static_cast<vtkIdType>(p), x.data());
        x = x + Vec3{ 0, 0, 0 }; // -0 becomes 0
        const bool finite = std::isfinite(x[0] + x[1] + x[2]);
        count += flags[p] && !finite;
        if (flags[p] && finite)
        {
          std::size_t home = 0;
          for (const double c : x)
          {
            home = mixed(home, std::hash<double>()(c));
          }
          sent[home % processes].push_back({ x, own[p] });
        }
      }
    });
  const std::vector<std::vector<SentPlace>> received = group.exchangeItems(sent);
  group.together(
    [&]
    {
      struct Found
      {
        Vec3 place;
        std::size_t process;
        Index own;
      };
      std::vector<Found> all;
      for (std::size_t process = 0; process < received.size(); ++process)
      {
        for (const SentPlace& one : received[process])
        {
          all.push_back({ one.place, process, one.own });
        }
      }
      std::sort(all.begin(), all.end(),
        [](const Found& a, const Found& b)
        { return std::tie(a.place, a.process) < std::tie(b.place, b.process); });
      for (std::size_t from = 0, to = 0; from < all.size(); from = to)
      {
        Index owned = 0, most = 0, here = 0;
        for (; to < all.size() && all[to].place == all[from].place; ++to)
        {
          const bool fresh = to == from || all[to].process != all[to - 1].process;
          here = (fresh ? 0 : here) + all[to].own;
          owned += all[to].own;
          most = std::max(most, here);
        }
        count += most > 1 ? owned : 1;
      }
    });
  return group.sum(count);
}
}
