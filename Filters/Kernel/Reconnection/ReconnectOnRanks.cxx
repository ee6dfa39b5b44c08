// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectOnRanks.h"

#include "RankParts.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
constexpr int Corners = 4;

/// The least of the values of all ranks.
double minimum(RankGroup& group, double value)
{
  return -group.maximum(-value);
}

/// A part in the form that improveConnectivity() takes: its own cells first.
struct LocalMesh
{
  std::vector<PartPoint> points; ///< of the part and around it
  std::vector<double> coordinates;
  std::vector<unsigned char> types, fixed, outside, starts;
  std::vector<Index> offsets = { 0 }, connectivity, regions;

  MeshView view() const
  {
    return { static_cast<Index>(this->points.size()), this->coordinates.data(),
      static_cast<Index>(this->types.size()), this->types.data(), this->offsets.data(),
      this->connectivity.data() };
  }
};

//------------------------------------------------------------------------------
class RankRounds
{
public:
  RankRounds(RankGroup& group, const RankTetrahedra& mesh, const ReconnectionOptions& options)
    : Group(group)
    , Options(options)
    , Mirrored(mesh.mirrored)
  {
    this->take(mesh);
  }

  RankReconnection run(int rounds);

private:
  void take(const RankTetrahedra& mesh);
  bool runRound(int round, int rounds);
  LocalMesh localMesh(const PartSurroundings& around, int round) const;
  void setOptions(const LocalMesh& local, int round, int rounds, ReconnectionOptions& options);
  void setBounds(const LocalMesh& local, ReconnectionOptions& options) const;
  void takeResult(
    const LocalMesh& local, const PartSurroundings& around, const ReconnectionResult& result);
  void addShares(const LocalMesh& local, const ReconnectionResult& result, Index first,
    const std::vector<Index>& numbers);
  void record(const ReconnectionResult& result, bool any);
  void shareRecord(ReconnectionRecord& record) const;
  bool anyOnAllSeams();
  void countMarked(const PartSurroundings& around);
  RankReconnection finish();

  RankGroup& Group;
  const ReconnectionOptions& Options;
  bool Mirrored;
  MeshPart Part;
  std::vector<std::array<Index, 3>> Marked; ///< of the whole mesh, sorted
  Index FirstInserted = 0, NextPoint = 0, FirstSize = 0;
  Stopwatch Clock;
  RankReconnection Result;
};

//------------------------------------------------------------------------------
/// Takes the cells of this rank, and the marks of all.
void RankRounds::take(const RankTetrahedra& mesh)
{
  Index largest = -1;
  this->Group.together(
    [&]
    {
      const std::size_t cells = mesh.tetrahedra.size() / Corners;
      std::vector<char> used(mesh.numbers.size(), 0);
      this->Part.cells.resize(cells);
      for (std::size_t c = 0; c < cells; ++c)
      {
        PartCell& cell = this->Part.cells[c];
        for (int k = 0; k < Corners; ++k)
        {
          const Index p = mesh.tetrahedra[Corners * c + k];
          cell.points[k] = mesh.numbers[p];
          used[p] = 1;
        }
        cell.region = mesh.regions.empty() ? 0 : mesh.regions[c];
        cell.originRank = this->Group.rank();
        cell.originCell = static_cast<Index>(c);
      }
      for (std::size_t p = 0; p < used.size(); ++p)
      {
        if (used[p])
        {
          const double* x = &mesh.points[3 * p];
          const unsigned char fixed = mesh.fixed.empty() ? 0 : mesh.fixed[p];
          this->Part.points.push_back({ mesh.numbers[p], { x[0], x[1], x[2] }, fixed, 1 });
          largest = std::max(largest, mesh.numbers[p]);
        }
      }
      unitePoints(this->Part.points);
    });
  this->FirstInserted = this->NextPoint = this->Group.maximum(largest) + 1;
  this->FirstSize = this->Group.sum(static_cast<Index>(this->Part.cells.size()));
  for (const auto& list : this->Group.gatherItems(mesh.markedFacets))
  {
    this->Marked.insert(this->Marked.end(), list.begin(), list.end());
  }
  for (std::array<Index, 3>& facet : this->Marked)
  {
    std::sort(facet.begin(), facet.end());
  }
  std::sort(this->Marked.begin(), this->Marked.end());
  this->Marked.erase(std::unique(this->Marked.begin(), this->Marked.end()), this->Marked.end());
}

//------------------------------------------------------------------------------
LocalMesh RankRounds::localMesh(const PartSurroundings& around, int round) const
{
  LocalMesh local;
  std::set_union(this->Part.points.begin(), this->Part.points.end(), around.points.begin(),
    around.points.end(), std::back_inserter(local.points),
    [](const PartPoint& a, const PartPoint& b) { return a.number < b.number; });
  const std::vector<PartPoint>& points = local.points;
  for (const PartPoint& point : points)
  {
    local.coordinates.insert(local.coordinates.end(), point.x.begin(), point.x.end());
    local.fixed.push_back(point.fixed);
  }
  std::vector<unsigned char> isAround(points.size(), 0);
  local.starts.assign(points.size(), round == 0);
  for (const std::vector<PartCell>* cells : { &this->Part.cells, &around.cells })
  {
    const bool own = cells == &this->Part.cells;
    for (const PartCell& cell : *cells)
    {
      std::array<Index, Corners> v;
      std::transform(cell.points.begin(), cell.points.end(), v.begin(),
        [&](Index number) { return placeOf(points, number); });
      const bool onAllSeams =
        std::any_of(v.begin(), v.end(), [&](Index p) { return points[p].onAllSeams != 0; });
      for (const Index p : v)
      {
        local.starts[p] |= onAllSeams; // a ring around what was on a seam
        isAround[p] |= !own;
      }
      local.connectivity.insert(local.connectivity.end(), v.begin(), v.end());
      local.offsets.push_back(static_cast<Index>(local.connectivity.size()));
      local.types.push_back(static_cast<unsigned char>(CellType::Tetrahedron));
      local.regions.push_back(cell.region);
      local.outside.push_back(!own);
    }
  }
  // Where only a point or an edge is common with other ranks, nothing is around.
  for (const Index number : around.shared)
  {
    const Index p = placeOf(points, number);
    local.fixed[p] |= !isAround[p];
  }
  return local;
}

//------------------------------------------------------------------------------
/// Shares what the number of cells may still grow and shrink by among the ranks.
void RankRounds::setBounds(const LocalMesh& local, ReconnectionOptions& options) const
{
  if (options.smallestCount == 1.0 && options.largestCount == 1.0)
  {
    return;
  }
  const auto first = static_cast<double>(this->FirstSize);
  const double now = this->Result.history.empty()
    ? first
    : static_cast<double>(this->Result.history.back().tetrahedra);
  const auto own = static_cast<double>(this->Part.cells.size());
  const auto all = static_cast<double>(local.types.size());
  const auto sharedOut = [&](double cells)
  { return std::floor(std::max(cells, 0.0) * own / std::max(now, 1.0)); };
  const double most = sharedOut(options.largestCount * first - now);
  const double least = sharedOut(now - options.smallestCount * first);
  options.largestCount = (all + most) / std::max(all, 1.0);
  options.smallestCount = (all - least) / std::max(all, 1.0);
  if (options.largestCount == 1.0 && options.smallestCount == 1.0)
  {
    // Both 1 would mean any number by swaps; rounded up, the number of cells is the same.
    options.smallestCount = std::nextafter(1.0, 0.0);
  }
}

//------------------------------------------------------------------------------
void RankRounds::setOptions(
  const LocalMesh& local, int round, int rounds, ReconnectionOptions& options)
{
  options.fixed = local.fixed.data();
  options.regions = local.regions.data();
  options.outside = local.outside.data();
  options.starts = round == 0 ? nullptr : local.starts.data();
  options.markedFacets.clear();
  for (const std::array<Index, 3>& facet : this->Marked)
  {
    std::array<Index, 3> places;
    bool here = true;
    for (std::size_t k = 0; k < facet.size() && here; ++k)
    {
      places[k] = placeOf(local.points, facet[k]);
      here = places[k] < static_cast<Index>(local.points.size()) &&
        local.points[places[k]].number == facet[k];
    }
    if (here)
    {
      options.markedFacets.push_back(places);
    }
  }
  this->setBounds(local, options);
  if (options.maximumSeconds > 0.0)
  {
    constexpr double least = 1e-9; // 0 would be no limit
    options.maximumSeconds = std::max(least, options.maximumSeconds - this->Clock.seconds());
  }
  const auto& observer = this->Options.observer;
  if (observer)
  {
    options.observer = [&observer, round, rounds](const ReconnectionRecord& record, double progress)
    { return observer(record, (round + progress) / rounds); };
  }
}

//------------------------------------------------------------------------------
/// Makes the figures of ranks those of the whole mesh.
void RankRounds::shareRecord(ReconnectionRecord& record) const
{
  record.smallestAngle = minimum(this->Group, record.smallestAngle);
  record.largestAngle = this->Group.maximum(record.largestAngle);
  record.worstInverseMeanRatio = this->Group.maximum(record.worstInverseMeanRatio);
  record.worstQuality = minimum(this->Group, record.worstQuality);
  for (Index* count :
    { &record.tetrahedra, &record.belowTarget, &record.edgeRemovals, &record.faceRemovals,
      &record.boundarySwaps, &record.contractions, &record.insertions, &record.moves })
  {
    *count = this->Group.sum(*count);
  }
  record.seconds = this->Group.maximum(this->Clock.seconds());
}

//------------------------------------------------------------------------------
/// @param any whether this rank had cells
void RankRounds::record(const ReconnectionResult& result, bool any)
{
  std::vector<ReconnectionRecord>& history = this->Result.history;
  ReconnectionRecord none;
  none.smallestAngle = 180.0;
  none.worstQuality = none.worstInverseMeanRatio = 1.0;
  if (history.empty())
  {
    ReconnectionRecord first = any ? result.history.front() : none;
    this->shareRecord(first);
    first.seconds = 0.0;
    history.push_back(first);
  }
  ReconnectionRecord last = any ? result.history.back() : none;
  this->shareRecord(last);
  const ReconnectionRecord& before = history.back();
  last.pass = before.pass + 1;
  last.edgeRemovals += before.edgeRemovals;
  last.faceRemovals += before.faceRemovals;
  last.boundarySwaps += before.boundarySwaps;
  last.contractions += before.contractions;
  last.insertions += before.insertions;
  last.moves += before.moves;
  history.push_back(last);
  this->Result.forcedQuality = minimum(this->Group, any ? result.forcedQuality : none.worstQuality);
  this->Result.forcedInverseMeanRatio =
    this->Group.maximum(any ? result.forcedInverseMeanRatio : none.worstInverseMeanRatio);
}

//------------------------------------------------------------------------------
/// What inserted points consist of. @param first the number of the first one of this rank
void RankRounds::addShares(const LocalMesh& local, const ReconnectionResult& result, Index first,
  const std::vector<Index>& numbers)
{
  std::vector<PartShare> added;
  const std::vector<PartShare>& known = this->Part.shares;
  for (const PointInterpolation& place : result.interpolations)
  {
    const Index number = numbers[place.point];
    if (number < first)
    {
      continue; // no cell of this rank has it
    }
    for (int k = 0; k < Corners; ++k)
    {
      const Index corner = local.points[local.connectivity[Corners * place.cell + k]].number;
      if (corner < this->FirstInserted)
      {
        added.push_back({ number, corner, place.weights[k] });
        continue;
      }
      auto share = std::lower_bound(known.begin(), known.end(), corner,
        [](const PartShare& a, Index point) { return a.point < point; });
      for (; share != known.end() && share->point == corner; ++share)
      {
        added.push_back({ number, share->number, place.weights[k] * share->weight });
      }
    }
  }
  std::stable_sort(added.begin(), added.end(),
    [](const PartShare& a, const PartShare& b)
    { return a.point != b.point ? a.point < b.point : a.number < b.number; });
  std::vector<PartShare>& shares = this->Part.shares;
  for (const PartShare& share : added)
  {
    if (!shares.empty() && shares.back().point == share.point &&
      shares.back().number == share.number)
    {
      shares.back().weight += share.weight;
      continue;
    }
    shares.push_back(share);
  }
}

//------------------------------------------------------------------------------
/// The part as the result has it, without what is around it.
void RankRounds::takeResult(
  const LocalMesh& local, const PartSurroundings& around, const ReconnectionResult& result)
{
  MeshPart& part = this->Part;
  const auto own = static_cast<Index>(part.cells.size());
  std::vector<char> onSeam(local.points.size(), 0);
  std::vector<char> used(result.originalPoints.size(), 0);
  std::vector<Index> numbers(used.size(), -1);
  Index inserted = 0;
  this->Group.together(
    [&]
    {
      for (const PartPoint& point : around.points)
      {
        onSeam[placeOf(local.points, point.number)] = 1;
      }
      for (const Index number : around.shared)
      {
        onSeam[placeOf(local.points, number)] = 1;
      }
      for (std::size_t c = 0; c < result.originalCells.size(); ++c)
      {
        for (int k = 0; k < Corners && result.originalCells[c] < own; ++k)
        {
          used[result.tetrahedra[Corners * c + k]] = 1;
        }
      }
      for (std::size_t p = 0; p < used.size(); ++p)
      {
        inserted += used[p] && result.originalPoints[p] < 0;
      }
    });
  Index first = this->NextPoint;
  const std::vector<std::vector<Index>> counts =
    this->Group.gatherItems(std::vector<Index>{ inserted });
  for (int r = 0; r < this->Group.size(); ++r)
  {
    first += r < this->Group.rank() ? counts[r][0] : 0;
    this->NextPoint += counts[r][0];
  }
  this->Group.together(
    [&]
    {
      std::vector<PartPoint> points;
      Index next = first;
      for (std::size_t p = 0; p < used.size(); ++p)
      {
        if (!used[p])
        {
          continue;
        }
        const Index original = result.originalPoints[p];
        const double* x = &result.points[3 * p];
        PartPoint point = { next, { x[0], x[1], x[2] }, 0, 0 };
        if (original >= 0)
        {
          const PartPoint& before = local.points[original];
          point.number = before.number;
          point.fixed = before.fixed;
          point.onAllSeams = onSeam[original] && local.starts[original];
        }
        else
        {
          ++next;
        }
        numbers[p] = point.number;
        points.push_back(point);
      }
      this->addShares(local, result, first, numbers);
      std::vector<PartCell> cells;
      for (std::size_t c = 0; c < result.originalCells.size(); ++c)
      {
        if (result.originalCells[c] >= own)
        {
          continue;
        }
        PartCell cell = part.cells[result.originalCells[c]];
        for (int k = 0; k < Corners; ++k)
        {
          cell.points[k] = numbers[result.tetrahedra[Corners * c + k]];
        }
        cell.quality = result.qualities[c];
        cell.bound = result.bounds[c];
        cell.obstacle = result.obstacles[c];
        cells.push_back(cell);
      }
      part.points = std::move(points); // originals keep their order, inserted ones follow
      part.cells = std::move(cells);
    });
}

//------------------------------------------------------------------------------
/// The number of marked facets that have a cell on both sides.
void RankRounds::countMarked(const PartSurroundings& around)
{
  const Index sides = std::count_if(around.inner.begin(), around.inner.end(),
    [this](const std::array<Index, 3>& facet)
    { return std::binary_search(this->Marked.begin(), this->Marked.end(), facet); });
  this->Result.markedFacets = this->Group.sum(sides) / 2;
}

//------------------------------------------------------------------------------
/// Whether there are points that were on a seam in every round.
bool RankRounds::anyOnAllSeams()
{
  return this->Group.any(std::any_of(this->Part.points.begin(), this->Part.points.end(),
    [](const PartPoint& point) { return point.onAllSeams != 0; }));
}

//------------------------------------------------------------------------------
/// @return whether to go on
bool RankRounds::runRound(int round, int rounds)
{
  redistribute(this->Group, divideAmongRanks(this->Group, this->Part, round), this->Part);
  const PartSurroundings around = surroundingsOf(this->Group, this->Part);
  if (round == 0)
  {
    this->countMarked(around);
  }
  LocalMesh local;
  ReconnectionResult result;
  const bool any = !this->Part.cells.empty();
  this->Group.together(
    [&]
    {
      local = this->localMesh(around, round);
      ReconnectionOptions options = this->Options;
      this->setOptions(local, round, rounds, options);
      if (any)
      {
        Mesh mesh(local.view(), options.threads);
        mesh.setMirrored(this->Mirrored);
        result = improveConnectivity(mesh, options);
      }
    });
  this->takeResult(local, around, result);
  this->record(result, any);
  const ReconnectionRecord& last = this->Result.history.back();
  StopReason& reason = this->Result.reason;
  for (const StopReason stop : { StopReason::TimeLimit, StopReason::Aborted })
  {
    reason = this->Group.any(any && result.reason == stop) ? stop : reason;
  }
  if (reason != StopReason::NoProgress)
  {
    return false;
  }
  const bool stops =
    this->Options.observer && !this->Options.observer(last, (round + 1.0) / rounds);
  if (this->Group.any(stops))
  {
    reason = StopReason::Aborted;
    return false;
  }
  if (last.belowTarget == 0 && this->Options.objective != ReconnectionObjective::Sum)
  {
    reason = StopReason::Reduction;
    return false;
  }
  return this->anyOnAllSeams();
}

//------------------------------------------------------------------------------
/// Sends the cells to where their original ones are.
RankReconnection RankRounds::finish()
{
  std::vector<int> targets;
  for (const PartCell& cell : this->Part.cells)
  {
    targets.push_back(static_cast<int>(cell.originRank));
  }
  redistribute(this->Group, targets, this->Part);
  RankReconnection& result = this->Result;
  this->Group.together(
    [&]
    {
      std::stable_sort(this->Part.cells.begin(), this->Part.cells.end(),
        [](const PartCell& a, const PartCell& b) { return a.originCell < b.originCell; });
      result.firstInserted = this->FirstInserted;
      result.shareOffsets = { 0 };
      auto share = this->Part.shares.begin();
      for (const PartPoint& point : this->Part.points)
      {
        result.numbers.push_back(point.number);
        result.points.insert(result.points.end(), point.x.begin(), point.x.end());
        for (; share != this->Part.shares.end() && share->point == point.number; ++share)
        {
          result.shares.push_back({ share->number, share->weight });
        }
        result.shareOffsets.push_back(static_cast<Index>(result.shares.size()));
      }
      for (const PartCell& cell : this->Part.cells)
      {
        for (const Index number : cell.points)
        {
          result.tetrahedra.push_back(placeOf(this->Part.points, number));
        }
        result.originalCells.push_back(cell.originCell);
        result.obstacles.push_back(cell.obstacle);
        result.qualities.push_back(cell.quality);
        result.bounds.push_back(cell.bound);
      }
    });
  return std::move(result);
}

//------------------------------------------------------------------------------
RankReconnection RankRounds::run(int rounds)
{
  int round = 0;
  while (this->runRound(round, rounds) && ++round < rounds)
  {
  }
  return this->finish();
}
}

//------------------------------------------------------------------------------
std::string needsOneRank(const ReconnectionOptions& options)
{
  return options.boundary == ReconnectionBoundary::Surface ? "a boundary on the surface"
    : options.objective == ReconnectionObjective::Metric   ? "a metric as objective"
    : options.improveMean                                  ? "the best shape at the end"
    : options.overlaps                                     ? "a conservative transfer"
    : options.size != ReconnectionSize::None && options.size != ReconnectionSize::Length
    ? "lengths per point"
    : "";
}

//------------------------------------------------------------------------------
RankReconnection improveOnRanks(
  RankGroup& group, RankTetrahedra mesh, const ReconnectionOptions& options, int rounds)
{
  group.together(
    [&]
    {
      const std::string what = needsOneRank(options);
      if (!what.empty())
      {
        throw Error("with " + what + ", the mesh is improved on one rank: gather it");
      }
      if (rounds < 1)
      {
        throw Error("the number of rounds must be at least 1");
      }
    });
  RankRounds work(group, mesh, options);
  mesh = RankTetrahedra();
  return work.run(rounds);
}
}
