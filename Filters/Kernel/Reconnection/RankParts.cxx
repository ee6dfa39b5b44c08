// SPDX-License-Identifier: BSD-3-Clause
#include "RankParts.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>

namespace tautline
{
namespace
{
using Facet = std::array<Index, 3>;
constexpr int OppositeFacet[4][3] = { { 1, 2, 3 }, { 0, 2, 3 }, { 0, 1, 3 }, { 0, 1, 2 } };
/// So many centroids for each rank decide where the planes are.
constexpr Index SamplesOfRank = 2000;
/// The three frames of directions are used in turn; each time after that the planes are moved by
/// so much more of the cells, to the one side and to the other, in so many steps.
constexpr int Frames = 3, Shifts = 7;
constexpr double Shift = 0.08;

/// By which part of the cells the planes of a round are moved.
double shiftOf(int round)
{
  const int turn = (round / Frames) % Shifts;
  return (turn % 2 == 1 ? Shift : -Shift) * ((turn + 1) / 2);
}

Facet facetOf(const PartCell& cell, int i)
{
  const int* f = OppositeFacet[i];
  Facet facet = { cell.points[f[0]], cell.points[f[1]], cell.points[f[2]] };
  std::sort(facet.begin(), facet.end());
  return facet;
}

bool byNumber(const PartPoint& a, const PartPoint& b)
{
  return a.number < b.number;
}

std::array<Index, 4> sorted(std::array<Index, 4> points)
{
  std::sort(points.begin(), points.end());
  return points;
}

template <class Item>
std::vector<Item> joined(std::vector<std::vector<Item>>&& lists)
{
  std::vector<Item> all;
  for (const std::vector<Item>& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

/// The points of cells.
std::vector<PartPoint> pointsOf(const MeshPart& part, const std::vector<PartCell>& cells)
{
  std::vector<Index> numbers;
  for (const PartCell& cell : cells)
  {
    numbers.insert(numbers.end(), cell.points.begin(), cell.points.end());
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<PartPoint> points;
  for (const Index number : numbers)
  {
    points.push_back(part.points[placeOf(part.points, number)]);
  }
  return points;
}

std::uint64_t hashOf(const PartCell& cell)
{
  std::uint64_t hash = 0;
  for (const Index number : sorted(cell.points))
  {
    constexpr std::uint64_t odd = 0x9E3779B97F4A7C15u; // 2^64 over the golden ratio
    hash = (hash ^ static_cast<std::uint64_t>(number)) * odd;
    hash ^= hash >> 32;
  }
  return hash;
}

Vec3 normalized(const Vec3& v)
{
  return (1.0 / norm(v)) * v;
}

/// Three orthogonal directions; no two of different frames are parallel.
std::array<Vec3, 3> directionsOf(int frame)
{
  if (frame == 0)
  {
    return { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
  }
  const Vec3 a = normalized(frame == 1 ? Vec3{ 1, 1, 1 } : Vec3{ -1, 1, 0.5 });
  const Vec3 b = normalized(cross(a, frame == 1 ? Vec3{ 0, 0, 1 } : Vec3{ 0, 1, 1 }));
  return { a, b, cross(a, b) };
}

/// Planes that divide a sample among ranks: a node has the ranks from first to end.
class RankTree
{
public:
  RankTree(std::vector<Vec3> sample, int ranks, int round)
    : Directions(directionsOf(round % Frames))
    , Moved(shiftOf(round))
  {
    this->split(0, ranks, sample.begin(), sample.end());
  }

  int find(const Vec3& x) const
  {
    std::size_t node = 0;
    while (this->Nodes[node].below > 0)
    {
      const Node& n = this->Nodes[node];
      node = dot(this->Directions[n.direction], x) < n.position ? n.below : n.above;
    }
    return this->Nodes[node].rank;
  }

private:
  struct Node
  {
    int rank = 0, direction = 0;
    double position = 0;
    std::size_t below = 0, above = 0; ///< 0: a leaf
  };
  using Iterator = std::vector<Vec3>::iterator;

  std::size_t split(int first, int end, Iterator from, Iterator to)
  {
    const std::size_t node = this->Nodes.size();
    this->Nodes.emplace_back();
    this->Nodes[node].rank = first;
    if (end - first < 2 || from == to)
    {
      return node;
    }
    double longest = -1.0;
    int direction = 0;
    for (int k = 0; k < 3; ++k)
    {
      const auto less = [&](const Vec3& a, const Vec3& b)
      { return dot(this->Directions[k], a) < dot(this->Directions[k], b); };
      const auto ends = std::minmax_element(from, to, less);
      const double extent = dot(this->Directions[k], *ends.second - *ends.first);
      direction = extent > longest ? k : direction;
      longest = std::max(extent, longest);
    }
    const int middle = first + (end - first) / 2;
    const double share = static_cast<double>(middle - first) / (end - first) + this->Moved;
    const Iterator at = from +
      std::min(static_cast<std::ptrdiff_t>(share * static_cast<double>(to - from)), to - from - 1);
    const Vec3 d = this->Directions[direction];
    std::nth_element(
      from, at, to, [&](const Vec3& a, const Vec3& b) { return dot(d, a) < dot(d, b); });
    this->Nodes[node].direction = direction;
    this->Nodes[node].position = dot(d, *at);
    const std::size_t below = this->split(first, middle, from, at);
    const std::size_t above = this->split(middle, end, at, to);
    this->Nodes[node].below = below;
    this->Nodes[node].above = above;
    return node;
  }

  std::array<Vec3, 3> Directions;
  double Moved;
  std::vector<Node> Nodes;
};

/// Keeps the directory entry of what has a first number.
int directoryOf(Index number, int ranks)
{
  return static_cast<int>(number % ranks);
}

/// A facet that one cell of a rank has.
struct OuterFacet
{
  Facet facet;
  Index cell;
  Index rank;
  bool operator<(const OuterFacet& other) const
  {
    return this->facet != other.facet ? this->facet < other.facet : this->rank < other.rank;
  }
};

/// The other rank that has the facet of a cell.
struct Neighbour
{
  Index cell, rank;
};

void throwIfAny(RankGroup& group, Index facets)
{
  const Index all = group.sum(facets);
  if (all > 0)
  {
    throw Error(std::to_string(all) +
      " faces are used by three or more tetrahedra: remove duplicate or overlapping cells first");
  }
}

/// Pairs the outer facets of all ranks. @param paired gets those of this rank that have a cell on
/// another one
std::vector<Neighbour> findNeighbours(
  RankGroup& group, const std::vector<OuterFacet>& outer, std::vector<Facet>& paired)
{
  std::vector<std::vector<OuterFacet>> sent(group.size());
  for (const OuterFacet& facet : outer)
  {
    sent[directoryOf(facet.facet[0], group.size())].push_back(facet);
  }
  std::vector<OuterFacet> all = joined(group.exchangeItems(sent));
  std::sort(all.begin(), all.end());
  struct Answer
  {
    Facet facet;
    Neighbour neighbour;
  };
  std::vector<std::vector<Answer>> answers(group.size());
  Index tooMany = 0;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end)
  {
    for (end = i; end < all.size() && all[end].facet == all[i].facet; ++end)
    {
    }
    tooMany += end - i > 2;
    if (end - i == 2)
    {
      const OuterFacet &a = all[i], &b = all[i + 1];
      answers[a.rank].push_back({ a.facet, { a.cell, b.rank } });
      answers[b.rank].push_back({ b.facet, { b.cell, a.rank } });
    }
  }
  throwIfAny(group, tooMany);
  std::vector<Neighbour> neighbours;
  for (const Answer& answer : joined(group.exchangeItems(answers)))
  {
    neighbours.push_back(answer.neighbour);
    paired.push_back(answer.facet);
  }
  return neighbours;
}

/// Which of the points of outer facets other ranks have, too.
std::vector<Index> findShared(RankGroup& group, const std::vector<OuterFacet>& outer)
{
  std::vector<Index> own;
  for (const OuterFacet& facet : outer)
  {
    own.insert(own.end(), facet.facet.begin(), facet.facet.end());
  }
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  std::vector<std::vector<Index>> sent(group.size());
  for (const Index number : own)
  {
    sent[directoryOf(number, group.size())].push_back(number);
  }
  const std::vector<std::vector<Index>> received = group.exchangeItems(sent);
  std::vector<Index> all = joined(std::vector<std::vector<Index>>(received));
  std::sort(all.begin(), all.end());
  std::vector<std::vector<Index>> answers(group.size());
  for (std::size_t r = 0; r < received.size(); ++r)
  {
    std::copy_if(received[r].begin(), received[r].end(), std::back_inserter(answers[r]),
      [&](Index number)
      {
        const auto range = std::equal_range(all.begin(), all.end(), number);
        return range.second - range.first > 1;
      });
  }
  std::vector<Index> shared = joined(group.exchangeItems(answers));
  std::sort(shared.begin(), shared.end());
  return shared;
}
}

//------------------------------------------------------------------------------
void unitePoints(std::vector<PartPoint>& points)
{
  std::sort(points.begin(), points.end(), byNumber);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (kept > 0 && points[kept - 1].number == points[i].number)
    {
      points[kept - 1].onAllSeams |= points[i].onAllSeams;
      points[kept - 1].fixed |= points[i].fixed;
      continue;
    }
    points[kept++] = points[i];
  }
  points.resize(kept);
}

//------------------------------------------------------------------------------
Index placeOf(const std::vector<PartPoint>& points, Index number)
{
  PartPoint wanted;
  wanted.number = number;
  return std::lower_bound(points.begin(), points.end(), wanted, byNumber) - points.begin();
}

Vec3 centroidOf(const MeshPart& part, const PartCell& cell)
{
  Vec3 sum = { 0, 0, 0 };
  for (const Index number : sorted(cell.points)) // the same sum wherever the cell is
  {
    sum += part.points[placeOf(part.points, number)].x;
  }
  return 0.25 * sum;
}

//------------------------------------------------------------------------------
void redistribute(RankGroup& group, const std::vector<int>& targets, MeshPart& part)
{
  std::vector<std::vector<PartCell>> cells(group.size());
  std::vector<std::vector<PartPoint>> points(group.size());
  std::vector<std::vector<PartShare>> shares(group.size());
  group.together(
    [&]
    {
      for (std::size_t c = 0; c < targets.size(); ++c)
      {
        cells[targets[c]].push_back(part.cells[c]);
      }
      for (std::size_t r = 0; r < cells.size(); ++r)
      {
        points[r] = pointsOf(part, cells[r]);
        auto share = part.shares.begin();
        for (const PartPoint& point : points[r])
        {
          share = std::lower_bound(share, part.shares.end(), point.number,
            [](const PartShare& a, Index number) { return a.point < number; });
          for (auto s = share; s != part.shares.end() && s->point == point.number; ++s)
          {
            shares[r].push_back(*s);
          }
        }
      }
    });
  part.cells = joined(group.exchangeItems(cells));
  part.points = joined(group.exchangeItems(points));
  part.shares = joined(group.exchangeItems(shares));
  group.together(
    [&]
    {
      std::sort(part.cells.begin(), part.cells.end(),
        [](const PartCell& a, const PartCell& b) { return sorted(a.points) < sorted(b.points); });
      unitePoints(part.points);
      const auto key = [](const PartShare& share)
      { return std::make_pair(share.point, share.number); };
      std::sort(part.shares.begin(), part.shares.end(),
        [&](const PartShare& a, const PartShare& b) { return key(a) < key(b); });
      part.shares.erase(std::unique(part.shares.begin(), part.shares.end(),
                          [&](const PartShare& a, const PartShare& b) { return key(a) == key(b); }),
        part.shares.end());
    });
}

//------------------------------------------------------------------------------
std::vector<int> divideAmongRanks(RankGroup& group, const MeshPart& part, int round)
{
  const Index all = group.sum(static_cast<Index>(part.cells.size()));
  const Index step = std::max<Index>(1, all / (SamplesOfRank * group.size()));
  std::vector<Vec3> own;
  for (const PartCell& cell : part.cells)
  {
    // Chosen by its points: the same cells wherever they are.
    if (hashOf(cell) % static_cast<std::uint64_t>(step) == 0)
    {
      own.push_back(centroidOf(part, cell));
    }
  }
  const RankTree tree(joined(group.gatherItems(own)), group.size(), round);
  std::vector<int> targets;
  for (const PartCell& cell : part.cells)
  {
    targets.push_back(tree.find(centroidOf(part, cell)));
  }
  return targets;
}

//------------------------------------------------------------------------------
PartSurroundings surroundingsOf(RankGroup& group, const MeshPart& part)
{
  PartSurroundings around;
  std::vector<OuterFacet> outer;
  Index tooMany = 0;
  group.together(
    [&]
    {
      std::vector<OuterFacet> all;
      for (std::size_t c = 0; c < part.cells.size(); ++c)
      {
        for (int i = 0; i < 4; ++i)
        {
          all.push_back({ facetOf(part.cells[c], i), static_cast<Index>(c), Index(group.rank()) });
        }
      }
      std::sort(all.begin(), all.end());
      for (std::size_t i = 0, end = 0; i < all.size(); i = end)
      {
        for (end = i; end < all.size() && all[end].facet == all[i].facet; ++end)
        {
        }
        tooMany += end - i > 2;
        if (end - i == 1)
        {
          outer.push_back(all[i]);
        }
        else
        {
          around.inner.insert(around.inner.end(), 2, all[i].facet);
        }
      }
    });
  throwIfAny(group, tooMany);
  const std::vector<Neighbour> neighbours = findNeighbours(group, outer, around.inner);
  around.shared = findShared(group, outer);
  std::vector<std::vector<PartCell>> cells(group.size());
  std::vector<std::vector<PartPoint>> points(group.size());
  group.together(
    [&]
    {
      std::sort(around.inner.begin(), around.inner.end());
      std::vector<std::vector<Index>> ids(group.size());
      for (const Neighbour& neighbour : neighbours)
      {
        ids[neighbour.rank].push_back(neighbour.cell);
      }
      for (std::size_t r = 0; r < ids.size(); ++r)
      {
        std::sort(ids[r].begin(), ids[r].end());
        ids[r].erase(std::unique(ids[r].begin(), ids[r].end()), ids[r].end());
        for (const Index cell : ids[r])
        {
          cells[r].push_back(part.cells[cell]);
        }
        points[r] = pointsOf(part, cells[r]);
      }
    });
  around.cells = joined(group.exchangeItems(cells));
  around.points = joined(group.exchangeItems(points));
  std::sort(around.cells.begin(), around.cells.end(),
    [](const PartCell& a, const PartCell& b) { return sorted(a.points) < sorted(b.points); });
  unitePoints(around.points);
  return around;
}
}
