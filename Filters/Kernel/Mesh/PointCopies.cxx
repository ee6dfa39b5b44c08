// SPDX-License-Identifier: BSD-3-Clause
#include "PointCopies.h"

#include "tautline/Core/Random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace tautline
{
namespace
{
constexpr double nearFraction = 1e-5; ///< of the shortest edge
/// The maximum number of positions of an id that are compared: with more, the ids are meaningless.
constexpr std::size_t mostPlaces = 64;

struct Copy
{
  Index id;
  double x[3], shortest;
  Index source; ///< the point of the piece
  Index rank;   ///< of the piece

  auto key() const { return std::tie(this->id, this->x[0], this->x[1], this->x[2]); }
};

/// The new position of a copy.
struct Moved
{
  Index source;
  double x[3];
};

/// Low x y z and high x y z of the points of a rank; empty at first.
struct RankBox
{
  std::array<double, 3> low = { HUGE_VAL, HUGE_VAL, HUGE_VAL };
  std::array<double, 3> high = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };

  void add(const double* x)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->low[c] = std::min(this->low[c], x[c]);
      this->high[c] = std::max(this->high[c], x[c]);
    }
  }
  bool has(const double* x, double distance) const
  {
    bool inside = true;
    for (int c = 0; c < 3; ++c)
    {
      inside = inside && x[c] >= this->low[c] - distance && x[c] <= this->high[c] + distance;
    }
    return inside;
  }
};

/// One flag per point: nonzero if another point of the piece has its id.
std::vector<unsigned char> repeatedIds(const MeshView& view, const Index* ids)
{
  std::vector<unsigned char> repeated(view.numberOfPoints, 0);
  const Index* end = ids + view.numberOfPoints;
  if (std::adjacent_find(ids, end, [](Index a, Index b) { return a >= b; }) == end)
  {
    return repeated; // ids increase, so there are no repetitions
  }
  std::vector<Index> order(view.numberOfPoints);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    order[p] = p;
  }
  std::sort(order.begin(), order.end(), [ids](Index a, Index b) { return ids[a] < ids[b]; });
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    if (ids[order[i]] == ids[order[i - 1]])
    {
      repeated[order[i]] = repeated[order[i - 1]] = 1;
    }
  }
  return repeated;
}

/// The points that may have copies, by the rank that compares the points with their id.
std::vector<std::vector<Copy>> candidates(RankGroup& group, const MeshView& view, const Index* ids,
  const std::vector<double>& shortest, const std::vector<RankBox>& boxes)
{
  std::vector<std::vector<Copy>> sent(group.size());
  if (view.numberOfPoints == 0)
  {
    return sent;
  }
  const std::vector<unsigned char> repeated = repeatedIds(view, ids);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const double* x = view.points + 3 * p;
    const double distance = shortest[p]; // copies that are farther apart are also counted
    if (!std::isfinite(x[0] + x[1] + x[2] + distance))
    {
      continue;
    }
    bool any = repeated[p] != 0;
    for (std::size_t r = 0; r < boxes.size() && !any; ++r)
    {
      any = static_cast<int>(r) != group.rank() && boxes[r].has(x, distance);
    }
    if (any)
    {
      sent[SplitMix::mixed(static_cast<std::uint64_t>(ids[p])) % sent.size()].push_back(
        { ids[p], { x[0], x[1], x[2] }, shortest[p], p, group.rank() });
    }
  }
  return sent;
}

/// The copies that move, by rank; adds the counts to `result`.
/// @param together receives the number of ids of several points that coincide afterwards
std::vector<std::vector<Moved>> findMoved(
  std::vector<Copy>& copies, std::size_t ranks, JoinedCopies& result, Index& together)
{
  std::vector<std::vector<Moved>> moved(ranks);
  std::sort(copies.begin(), copies.end(),
    [](const Copy& a, const Copy& b)
    {
      return std::make_tuple(a.key(), a.rank, a.source) <
        std::make_tuple(b.key(), b.rank, b.source);
    });
  struct Place
  {
    const Copy* first;
    double shortest;
    bool several;
  };
  std::vector<Place> places; // of an id
  std::size_t first = 0;     // its first copy
  for (std::size_t i = 0; i < copies.size(); ++i)
  {
    const Copy& copy = copies[i];
    if (copies[first].id != copy.id)
    {
      result.apart += places.size() > 1;
      together += places.size() == 1 && i - first > 1;
      places.clear();
      first = i;
    }
    if (places.size() == mostPlaces)
    {
      continue;
    }
    const auto last = std::find_if(places.rbegin(), places.rend(),
      [&](const Place& place)
      {
        return areCopies(place.first->x, place.shortest, copy.x, copy.shortest) ||
          copy.x[0] - place.first->x[0] > nearFraction * copy.shortest;
      });
    if (last == places.rend() || !areCopies(last->first->x, last->shortest, copy.x, copy.shortest))
    {
      places.push_back({ &copy, copy.shortest, false });
      continue;
    }
    last->shortest = std::min(last->shortest, copy.shortest);
    const double* to = last->first->x;
    if (!std::equal(copy.x, copy.x + 3, to))
    {
      moved[copy.rank].push_back({ copy.source, { to[0], to[1], to[2] } });
      result.joined += !last->several;
      last->several = true;
      result.farthest = std::max(
        result.farthest, std::hypot(copy.x[0] - to[0], copy.x[1] - to[1], copy.x[2] - to[2]));
    }
  }
  result.apart += places.size() > 1;
  together += places.size() == 1 && copies.size() - first > 1;
  return moved;
}
}

//------------------------------------------------------------------------------
std::vector<double> shortestEdges(const MeshView& view)
{
  std::vector<double> shortest(view.numberOfPoints, HUGE_VAL);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    if (type == CellType::Unsupported)
    {
      continue;
    }
    const CellTopology& t = topology(type);
    const Index* nodes = view.connectivity + view.offsets[cell];
    for (int e = 0; e < t.edges; ++e)
    {
      const Index a = nodes[t.edgeNodes[e][0]], b = nodes[t.edgeNodes[e][1]];
      const double length = norm(pointOf(view, a) - pointOf(view, b));
      if (length > 0) // and not NaN
      {
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
      }
    }
  }
  return shortest;
}

//------------------------------------------------------------------------------
bool areCopies(const double* a, double shortestA, const double* b, double shortestB)
{
  const double limit = nearFraction * std::min(shortestA, shortestB);
  return std::isfinite(limit) && std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= limit;
}

//------------------------------------------------------------------------------
JoinedCopies joinCopies(RankGroup& group, const MeshView& view, const Index* ids)
{
  JoinedCopies result;
  if (group.any(view.numberOfPoints > 0 && !ids))
  {
    return result;
  }
  Index together = 0;
  std::vector<double> shortest;
  std::vector<RankBox> boxes(1);
  std::vector<std::vector<Copy>> sent;
  std::vector<std::vector<Moved>> moved;
  shortest = shortestEdges(view);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (std::isfinite(shortest[p]))
    {
      boxes[0].add(view.points + 3 * p);
    }
  }
  sent = candidates(group, view, ids, shortest, group.gatherJoined(boxes));
  std::vector<Copy> copies = group.exchangeJoined(sent);
  moved = findMoved(copies, sent.size(), result, together);
  // If most ids are at several positions, they do not belong to one mesh.
  result.apart = group.sum(result.apart);
  if (group.sum(together) <= result.apart)
  {
    return JoinedCopies();
  }
  result.joined = group.sum(result.joined);
  result.farthest = group.maximum(result.farthest);
  if (result.joined == 0)
  {
    return result;
  }
  const auto places = group.exchangeItems(moved);
  for (const std::vector<Moved>& list : places)
  {
    if (!list.empty() && result.points.empty())
    {
      result.points.assign(view.points, view.points + 3 * view.numberOfPoints);
    }
    for (const Moved& one : list)
    {
      std::copy_n(one.x, 3, &result.points[3 * one.source]);
    }
  }
  return result;
}
}
