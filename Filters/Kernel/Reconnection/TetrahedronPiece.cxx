// SPDX-License-Identifier: BSD-3-Clause
#include "TetrahedronPiece.h"

#include "CuttingFrames.h"
#include "tautline/Core/BisectionTree.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace tautline
{
namespace
{
using Facet = std::array<Index, 3>;
/// The number of centroids per rank that determine the planes.
constexpr Index SamplesOfRank = 2000;
/// The frames of directions are used in turn, and the planes are shifted by increasing fractions of
/// the cells, alternately to either side, in this number of steps.
constexpr int Shifts = 7;
constexpr double Shift = 0.08;
/// The maximum number of centroids sorted to find the planes of a round.
constexpr std::size_t MostSorted = 1000000;

/// The fraction of the cells by which planes are shifted in a step.
double shiftOf(int step)
{
  return (step % 2 == 1 ? Shift : -Shift) * ((step + 1) / 2);
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

/// The points of cells. @param places the positions of the points of the part
std::vector<PartPoint> pointsOf(
  const TetrahedronPiece& part, const PointPlaces& places, const std::vector<PartCell>& cells)
{
  std::vector<Index> used;
  used.reserve(4 * cells.size());
  for (const PartCell& cell : cells)
  {
    for (const Index number : cell.points)
    {
      used.push_back(places(number));
    }
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<PartPoint> points;
  points.reserve(used.size());
  for (const Index p : used)
  {
    points.push_back(part.points[p]);
  }
  return points;
}

/// Sorts cells by the numbers of their points.
void sortCells(std::vector<PartCell>& cells)
{
  struct Key
  {
    std::array<Index, 4> points;
    std::size_t cell;
  };
  std::vector<Key> keys;
  keys.reserve(cells.size());
  for (const PartCell& cell : cells)
  {
    keys.push_back({ sorted(cell.points), keys.size() });
  }
  std::sort(
    keys.begin(), keys.end(), [](const Key& a, const Key& b) { return a.points < b.points; });
  std::vector<PartCell> inOrder;
  inOrder.reserve(cells.size());
  for (const Key& key : keys)
  {
    inOrder.push_back(cells[key.cell]);
  }
  cells = std::move(inOrder);
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

/// Planes that divide a sample among ranks.
using RankTree = BisectionTree<CuttingFrame>;

/// The cost of the proximity of planes to the center of a ball: 0 at the radius or farther, the
/// weight at the center.
double costOf(const RankTree& tree, const CuttingFrame& frame, const Ball& ball)
{
  double nearest = ball.radius;
  tree.find(ball.center,
    [&](int direction, const Vec3& place)
    {
      const double distance = frame.along(direction, ball.center) - frame.along(direction, place);
      nearest = std::min(nearest, std::abs(distance));
    });
  return ball.weight * (1.0 - nearest / ball.radius);
}

/// The planes of a round: the cheapest over all shifts and all directions except the last ones.
/// @param frame of the last round, -1 before the first one; set to the frame of this round
RankTree chooseTree(
  std::vector<Vec3> sample, int ranks, const std::vector<Ball>& inside, int& frame)
{
  const auto treeOf = [&](int step, int direction)
  { return RankTree(CuttingFrame(direction), sample, ranks, shiftOf(step)); };
  const auto cost = [&](const RankTree& tree, int direction)
  {
    const CuttingFrame directions(direction);
    return std::accumulate(inside.begin(), inside.end(), 0.0,
      [&](double sum, const Ball& ball) { return sum + costOf(tree, directions, ball); });
  };
  const int last = frame;
  frame = (last + 1) % CuttingFrame::count;
  RankTree best = treeOf(0, frame);
  double least = cost(best, frame);
  const std::size_t affordable = MostSorted / std::max<std::size_t>(sample.size(), 1);
  std::size_t choices = 1;
  for (int step = 0; step < Shifts; ++step)
  {
    for (int k = 1; k < CuttingFrame::count; ++k)
    {
      const int direction = (last + k) % CuttingFrame::count;
      if (step == 0 && k == 1)
      {
        continue; // the first one
      }
      if (least == 0.0 || ++choices > affordable)
      {
        return best;
      }
      RankTree tree = treeOf(step, direction);
      const double found = cost(tree, direction);
      if (found < least)
      {
        least = found;
        best = std::move(tree);
        frame = direction;
      }
    }
  }
  return best;
}

/// The rank with the directory entry of items with this first number.
int directoryOf(Index number, int ranks)
{
  return static_cast<int>(number % ranks);
}

/// A facet of exactly one cell of a rank.
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

/// The other rank that has a facet of a cell.
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

/// All facets of the cells of a part, in increasing order.
std::vector<OuterFacet> sortedFacets(const TetrahedronPiece& part, Index rank)
{
  // Group facets by their first point, then sort each group.
  const PointPlaces places(part.points);
  std::vector<std::size_t> begins(part.points.size() + 1, 0);
  std::vector<std::array<Index, 4>> numbers;
  numbers.reserve(part.cells.size());
  // number of facets with the first of four points; one lacks it
  constexpr std::size_t withFirst = 3;
  for (const PartCell& cell : part.cells)
  {
    numbers.push_back(sorted(cell.points));
    begins[places(numbers.back()[0]) + 1] += withFirst;
    begins[places(numbers.back()[1]) + 1] += 1;
  }
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
  std::vector<OuterFacet> facets(4 * part.cells.size());
  for (std::size_t c = 0; c < numbers.size(); ++c)
  {
    const auto cell = static_cast<Index>(c);
    const std::array<Index, 4>& v = numbers[c];
    std::size_t& first = next[places(v[0])];
    facets[first++] = { { v[0], v[1], v[2] }, cell, rank };
    facets[first++] = { { v[0], v[1], v[3] }, cell, rank };
    facets[first++] = { { v[0], v[2], v[3] }, cell, rank };
    facets[next[places(v[1])]++] = { { v[1], v[2], v[3] }, cell, rank };
  }
  for (std::size_t p = 0; p + 1 < begins.size(); ++p)
  {
    std::sort(facets.begin() + static_cast<std::ptrdiff_t>(begins[p]),
      facets.begin() + static_cast<std::ptrdiff_t>(begins[p + 1]));
  }
  return facets;
}

/// Pairs the outer facets of all ranks. @param paired receives the facets of this rank that have a
/// cell on another one
std::vector<Neighbour> findNeighbours(
  RankGroup& group, const std::vector<OuterFacet>& outer, std::vector<Facet>& paired)
{
  std::vector<std::vector<OuterFacet>> sent(group.size());
  for (const OuterFacet& facet : outer)
  {
    sent[directoryOf(facet.facet[0], group.size())].push_back(facet);
  }
  std::vector<OuterFacet> all = group.exchangeJoined(sent);
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
  for (const Answer& answer : group.exchangeJoined(answers))
  {
    neighbours.push_back(answer.neighbour);
    paired.push_back(answer.facet);
  }
  return neighbours;
}

/// The points of outer facets that other ranks also have.
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
  std::vector<Index> all = joinLists(received);
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
  std::vector<Index> shared = group.exchangeJoined(answers);
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

Vec3 centroidOf(const TetrahedronPiece& part, const PointPlaces& places, const PartCell& cell)
{
  Vec3 sum = { 0, 0, 0 };
  for (const Index number : sorted(cell.points)) // the same sum on any rank
  {
    sum += part.points[places(number)].x;
  }
  return 0.25 * sum;
}

//------------------------------------------------------------------------------
void redistribute(RankGroup& group, const std::vector<int>& targets, TetrahedronPiece& part)
{
  std::vector<std::vector<PartCell>> cells(group.size());
  std::vector<std::vector<PartPoint>> points(group.size());
  std::vector<std::vector<PartShare>> shares(group.size());
  for (std::size_t c = 0; c < targets.size(); ++c)
  {
    cells[targets[c]].push_back(part.cells[c]);
  }
  const PointPlaces places(part.points);
  for (std::size_t r = 0; r < cells.size(); ++r)
  {
    points[r] = pointsOf(part, places, cells[r]);
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
  part.cells = group.exchangeJoined(cells);
  part.points = group.exchangeJoined(points);
  part.shares = group.exchangeJoined(shares);
  sortCells(part.cells);
  unitePoints(part.points);
  const auto key = [](const PartShare& share) { return std::make_pair(share.point, share.number); };
  std::sort(part.shares.begin(), part.shares.end(),
    [&](const PartShare& a, const PartShare& b) { return key(a) < key(b); });
  part.shares.erase(std::unique(part.shares.begin(), part.shares.end(),
                      [&](const PartShare& a, const PartShare& b) { return key(a) == key(b); }),
    part.shares.end());
}

//------------------------------------------------------------------------------
std::vector<int> divideAmongRanks(
  RankGroup& group, const TetrahedronPiece& part, const std::vector<Ball>& inside, int& frame)
{
  const Index all = group.sum(static_cast<Index>(part.cells.size()));
  const Index step = std::max<Index>(1, all / (SamplesOfRank * group.size()));
  std::vector<Vec3> centroids, own;
  const PointPlaces places(part.points);
  centroids.reserve(part.cells.size());
  for (const PartCell& cell : part.cells)
  {
    centroids.push_back(centroidOf(part, places, cell));
    // Selected by its points: the same cells on any rank.
    if (hashOf(cell) % static_cast<std::uint64_t>(step) == 0)
    {
      own.push_back(centroids.back());
    }
  }
  std::vector<Vec3> sample = group.gatherJoined(own);
  const std::vector<Ball> balls = group.gatherJoined(inside);
  std::vector<int> targets;
  const RankTree tree = chooseTree(std::move(sample), group.size(), balls, frame);
  targets.reserve(centroids.size());
  std::transform(centroids.begin(), centroids.end(), std::back_inserter(targets),
    [&tree](const Vec3& x) { return tree.find(x); });
  return targets;
}

//------------------------------------------------------------------------------
PartSurroundings surroundingsOf(
  RankGroup& group, const TetrahedronPiece& part, const std::vector<std::array<Index, 3>>& marked)
{
  const auto isMarked = [&marked](const Facet& facet)
  { return std::binary_search(marked.begin(), marked.end(), facet); };
  PartSurroundings around;
  std::vector<OuterFacet> outer;
  Index tooMany = 0;
  const std::vector<OuterFacet> all = sortedFacets(part, Index(group.rank()));
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
    else if (isMarked(all[i].facet))
    {
      around.markedSides += 2;
    }
  }
  throwIfAny(group, tooMany);
  std::vector<Facet> paired;
  const std::vector<Neighbour> neighbours = findNeighbours(group, outer, paired);
  around.markedSides += std::count_if(paired.begin(), paired.end(), isMarked);
  around.shared = findShared(group, outer);
  std::vector<std::vector<PartCell>> cells(group.size());
  std::vector<std::vector<PartPoint>> points(group.size());
  const PointPlaces places(part.points);
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
    points[r] = pointsOf(part, places, cells[r]);
  }
  around.cells = group.exchangeJoined(cells);
  around.points = group.exchangeJoined(points);
  sortCells(around.cells);
  unitePoints(around.points);
  return around;
}
}
