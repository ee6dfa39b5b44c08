// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectionRounds.h"

#include "Constants.h"
#include "TetrahedronPiece.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
constexpr int CornersOfCell = 4;
/// Cells with a point at a seam, and this many rings around them, are near it; about the same in
/// edge lengths.
constexpr int Reach = 2;
constexpr double NearSeam = 2.0;
/// In this many initial rounds, when later rounds will treat the regions near the seams better, the
/// number of cells may only use this fraction of the remaining growth.
constexpr int FirstRounds = 3;
constexpr double FirstShare = 0.25;
/// An operation usually adds at most this many cells.
constexpr double LargestGrowth = 4.0;
/// The number of positions per rank that determine where planes must not be.
constexpr std::size_t MostPlaces = 2000;

/// The minimum over all ranks.
double minimum(RankGroup& group, double value)
{
  return -group.maximum(-value);
}

/// A part in the form for improveConnectivity(): owned cells first.
struct LocalMesh
{
  std::vector<PartPoint> points; ///< of the part and its surroundings
  std::vector<double> coordinates;
  std::vector<unsigned char> types, fixed, outside, starts, onSeam, nearSeam;
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
    , Target(options.objective == ReconnectionObjective::Sum
          ? 1.0
          : std::sin(options.targetAngle * (Pi / 180.0)))
  {
    this->take(mesh);
  }

  RankReconnection run(int rounds);

private:
  void take(const RankTetrahedra& mesh);
  bool runRound(int round, int rounds);
  LocalMesh localMesh(const PartSurroundings& around, int round) const;
  void setOptions(const LocalMesh& local, int round, int rounds, ReconnectionOptions& options);
  void shareOut(int round, int rounds);
  void setBounds(const LocalMesh& local, ReconnectionOptions& options);
  void takeResult(const LocalMesh& local, const ReconnectionResult& result);
  void addShares(const LocalMesh& local, const ReconnectionResult& result, Index first,
    const std::vector<Index>& numbers);
  void record(const ReconnectionResult& result, bool any);
  void shareRecord(ReconnectionRecord& record) const;
  bool isLeft(const PartCell& cell) const;
  bool neverInside(const PartCell& cell, const PointPlaces& places) const;
  bool anyNeverInside();
  std::vector<Ball> placesToKeep() const;
  RankReconnection finish();

  RankGroup& Group;
  const ReconnectionOptions& Options;
  bool Mirrored;
  int Frame = -1;     ///< of the planes of the last round
  double Target;      ///< the target quality of cells
  double Share = 1;   ///< share of this rank in the allowed change of the number of cells
  double Spent = 1;   ///< fraction of the allowed growth for this round
  double Largest = 0; ///< maximum number of cells of this rank
  TetrahedronPiece Part;
  std::vector<std::array<Index, 3>> Marked; ///< of the whole mesh, sorted
  Index FirstInserted = 0, NextPoint = 0, FirstSize = 0;
  Stopwatch Clock;
  RankReconnection Result;
};

//------------------------------------------------------------------------------
/// Reads the cells of this rank, and the marks of all ranks.
void RankRounds::take(const RankTetrahedra& mesh)
{
  Index largest = -1;
  const std::size_t cells = mesh.tetrahedra.size() / CornersOfCell;
  std::vector<char> used(mesh.numbers.size(), 0);
  this->Part.cells.resize(cells);
  for (std::size_t c = 0; c < cells; ++c)
  {
    PartCell& cell = this->Part.cells[c];
    for (int k = 0; k < CornersOfCell; ++k)
    {
      const Index p = mesh.tetrahedra[CornersOfCell * c + k];
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
  // Inserted points get numbers beyond the input points of all ranks.
  this->FirstInserted = this->NextPoint = this->Group.maximum(largest) + 1;
  this->FirstSize = this->Group.sum(static_cast<Index>(this->Part.cells.size()));
  this->Marked = this->Group.gatherJoined(mesh.markedFacets);
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
  const PointPlaces places(points);
  for (const PartPoint& point : points)
  {
    local.coordinates.insert(local.coordinates.end(), point.x.begin(), point.x.end());
    local.fixed.push_back(point.fixed);
  }
  std::vector<unsigned char>& isAround = local.onSeam;
  isAround.assign(points.size(), 0);
  local.starts.assign(points.size(), round == 0);
  for (const std::vector<PartCell>* cells : { &this->Part.cells, &around.cells })
  {
    const bool own = cells == &this->Part.cells;
    for (const PartCell& cell : *cells)
    {
      std::array<Index, CornersOfCell> v;
      std::transform(cell.points.begin(), cell.points.end(), v.begin(),
        [&](Index number) { return places(number); });
      const bool onAllSeams =
        std::any_of(v.begin(), v.end(), [&](Index p) { return points[p].onAllSeams != 0; });
      for (const Index p : v)
      {
        local.starts[p] |= onAllSeams; // a ring around the former seam
        isAround[p] |= !own;
      }
      local.connectivity.insert(local.connectivity.end(), v.begin(), v.end());
      local.offsets.push_back(static_cast<Index>(local.connectivity.size()));
      local.types.push_back(static_cast<unsigned char>(CellType::Tetrahedron));
      local.regions.push_back(cell.region);
      local.outside.push_back(!own);
    }
  }
  // If only a point or an edge is shared with other ranks, there are no surrounding cells.
  for (const Index number : around.shared)
  {
    const Index p = placeOf(points, number);
    local.fixed[p] |= !isAround[p];
    isAround[p] = 1;
  }
  local.nearSeam = local.onSeam;
  for (int ring = 0; ring < Reach; ++ring)
  {
    // The copy limits the growth to one ring per sweep.
    const std::vector<unsigned char> inner = local.nearSeam;
    for (auto v = local.connectivity.begin(); v != local.connectivity.end(); v += CornersOfCell)
    {
      if (std::any_of(v, v + CornersOfCell, [&](Index p) { return inner[p] != 0; }))
      {
        std::for_each(v, v + CornersOfCell, [&](Index p) { local.nearSeam[p] = 1; });
      }
    }
  }
  return local;
}

//------------------------------------------------------------------------------
/// Shares are proportional to the remaining cells of each rank; in the first round, when these are
/// unknown, to all cells. Collective.
void RankRounds::shareOut(int round, int rounds)
{
  const std::vector<PartCell>& cells = this->Part.cells;
  const Index left = round == 0 ? 0
                                : std::count_if(cells.begin(), cells.end(),
                                    [this](const PartCell& cell) { return this->isLeft(cell); });
  const auto size = static_cast<Index>(cells.size());
  const Index allLeft = this->Group.sum(left), all = this->Group.sum(size);
  const bool early = this->Group.size() > 1 && round < std::min(FirstRounds, rounds - 1);
  this->Spent = early ? FirstShare : 1.0;
  this->Share = allLeft > 0 ? static_cast<double>(left) / static_cast<double>(allLeft)
                            : static_cast<double>(size) / std::max(1.0, static_cast<double>(all));
}

//------------------------------------------------------------------------------
/// Distributes the remaining allowed growth and decrease of the number of cells among the ranks.
void RankRounds::setBounds(const LocalMesh& local, ReconnectionOptions& options)
{
  this->Largest = std::numeric_limits<double>::infinity();
  if (options.smallestCount == 1.0 && options.largestCount == 1.0)
  {
    return;
  }
  const auto first = static_cast<double>(this->FirstSize);
  const double now = this->Result.history.empty()
    ? first
    : static_cast<double>(this->Result.history.back().tetrahedra);
  const auto all = static_cast<double>(local.types.size());
  const auto sharedOut = [this](double cells)
  { return std::floor(std::max(cells, 0.0) * this->Share); };
  const double most = std::floor(this->Spent * sharedOut(options.largestCount * first - now));
  const double least = sharedOut(now - options.smallestCount * first);
  this->Largest = static_cast<double>(this->Part.cells.size()) + most;
  // The bounds refer to the number of local cells, which includes the surroundings.
  options.largestCount = (all + most) / std::max(all, 1.0);
  options.smallestCount = (all - least) / std::max(all, 1.0);
  if (options.largestCount == 1.0 && options.smallestCount == 1.0)
  {
    // If both were 1, swaps could change the number freely; rounded up, the number of cells is the
    // same.
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
  // At seams, operations that change the number of points are left to rounds with other seams: with
  // fixed facets, they would need many insertions, and the number of cells is bounded.
  options.postponed = round + 1 < rounds ? local.onSeam.data() : nullptr;
  options.markedFacets.clear();
  for (const std::array<Index, 3>& facet : this->Marked)
  {
    std::array<Index, 3> places;
    bool here = true;
    for (std::size_t k = 0; k < facet.size() && here; ++k)
    {
      // If the point is not here, placeOf() returns the place of the next larger number.
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
/// Combines the values of the ranks for the whole mesh.
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
/// @param any whether this rank has cells
void RankRounds::record(const ReconnectionResult& result, bool any)
{
  std::vector<ReconnectionRecord>& history = this->Result.history;
  // A rank without cells must not affect the minima and maxima of the others.
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
  // The counts of a round start at 0, but the history has totals.
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
/// Adds the interpolation weights of inserted points. @param first the number of the first one of
/// this rank
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
    for (int k = 0; k < CornersOfCell; ++k)
    {
      const Index corner = local.points[local.connectivity[CornersOfCell * place.cell + k]].number;
      if (corner < this->FirstInserted)
      {
        added.push_back({ number, corner, place.weights[k] });
        continue;
      }
      // A corner inserted earlier is replaced by its own shares, so that only input points remain.
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
    // Several corners may depend on the same input point: their weights are added.
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
/// Stores the part from the result, without its surroundings.
void RankRounds::takeResult(const LocalMesh& local, const ReconnectionResult& result)
{
  TetrahedronPiece& part = this->Part;
  const auto own = static_cast<Index>(part.cells.size());
  std::vector<char> used(result.originalPoints.size(), 0);
  std::vector<Index> numbers(used.size(), -1);
  Index inserted = 0;
  // In the local numbering, the cells of the surroundings follow the owned ones.
  for (std::size_t c = 0; c < result.originalCells.size(); ++c)
  {
    for (int k = 0; k < CornersOfCell && result.originalCells[c] < own; ++k)
    {
      used[result.tetrahedra[CornersOfCell * c + k]] = 1;
    }
  }
  for (std::size_t p = 0; p < used.size(); ++p)
  {
    inserted += used[p] && result.originalPoints[p] < 0;
  }
  // Operations prevented by the number of cells are tried again when it may be larger.
  const bool retries = this->Spent < 1.0 &&
    std::count_if(result.originalCells.begin(), result.originalCells.end(),
      [own](Index cell) { return cell < own; }) +
        LargestGrowth >
      this->Largest;
  // The inserted points are numbered consecutively, in the order of the ranks.
  Index first = this->NextPoint;
  const std::vector<std::vector<Index>> counts =
    this->Group.gatherItems(std::vector<Index>{ inserted });
  for (int r = 0; r < this->Group.size(); ++r)
  {
    first += r < this->Group.rank() ? counts[r][0] : 0;
    this->NextPoint += counts[r][0];
  }
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
      point.onAllSeams = before.onAllSeams && (local.nearSeam[original] || retries);
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
    for (int k = 0; k < CornersOfCell; ++k)
    {
      cell.points[k] = numbers[result.tetrahedra[CornersOfCell * c + k]];
    }
    cell.quality = result.qualities[c];
    cell.bound = result.bounds[c];
    cell.obstacle = result.obstacles[c];
    cells.push_back(cell);
  }
  part.points = std::move(points); // originals keep their order, inserted ones follow
  part.cells = std::move(cells);
}

//------------------------------------------------------------------------------
/// Whether a cell is below the target and can be improved.
bool RankRounds::isLeft(const PartCell& cell) const
{
  return cell.quality < this->Target && cell.bound > (1.0 + AtBound) * cell.quality;
}

//------------------------------------------------------------------------------
/// Whether a remaining cell was near a seam in every round.
bool RankRounds::neverInside(const PartCell& cell, const PointPlaces& places) const
{
  return this->isLeft(cell) &&
    std::any_of(cell.points.begin(), cell.points.end(),
      [&](Index number) { return this->Part.points[places(number)].onAllSeams != 0; });
}

//------------------------------------------------------------------------------
bool RankRounds::anyNeverInside()
{
  bool found = false;
  const PointPlaces places(this->Part.points);
  found = std::any_of(this->Part.cells.begin(), this->Part.cells.end(),
    [&](const PartCell& cell) { return this->neverInside(cell, places); });
  return this->Group.any(found);
}

//------------------------------------------------------------------------------
/// The regions to avoid with the planes of the next round: the worst cells have the largest weight.
std::vector<Ball> RankRounds::placesToKeep() const
{
  std::vector<Ball> balls;
  const std::vector<PartPoint>& points = this->Part.points;
  const PointPlaces places(points);
  for (const PartCell& cell : this->Part.cells)
  {
    if (!this->neverInside(cell, places))
    {
      continue;
    }
    double longest = 0.0;
    for (int i = 0; i < CornersOfCell; ++i)
    {
      const Vec3& x = points[places(cell.points[i])].x;
      for (int j = 0; j < i; ++j)
      {
        longest = std::max(longest, norm(x - points[places(cell.points[j])].x));
      }
    }
    const double lacking = 1.0 - cell.quality / this->Target;
    balls.push_back(
      { centroidOf(this->Part, places, cell), NearSeam * longest, lacking * lacking });
  }
  std::stable_sort(
    balls.begin(), balls.end(), [](const Ball& a, const Ball& b) { return a.weight > b.weight; });
  balls.resize(std::min(balls.size(), MostPlaces));
  return balls;
}

//------------------------------------------------------------------------------
/// @return whether to continue
bool RankRounds::runRound(int round, int rounds)
{
  std::vector<Ball> inside;
  inside = round == 0 ? std::vector<Ball>() : this->placesToKeep();
  redistribute(
    this->Group, divideAmongRanks(this->Group, this->Part, inside, this->Frame), this->Part);
  const std::vector<std::array<Index, 3>> none;
  const PartSurroundings around =
    surroundingsOf(this->Group, this->Part, round == 0 ? this->Marked : none);
  if (round == 0)
  {
    // A marked facet is counted on both of its sides.
    this->Result.markedFacets = this->Group.sum(around.markedSides) / 2;
  }
  this->shareOut(round, rounds);
  LocalMesh local;
  ReconnectionResult result;
  const bool any = !this->Part.cells.empty();
  local = this->localMesh(around, round);
  ReconnectionOptions options = this->Options;
  this->setOptions(local, round, rounds, options);
  if (any)
  {
    Mesh mesh(local.view(), options.threads);
    mesh.setMirrored(this->Mirrored);
    result = improveConnectivity(mesh, options);
  }
  // Ranks without cells also take part in the collective calls.
  this->takeResult(local, result);
  this->record(result, any);
  const ReconnectionRecord& last = this->Result.history.back();
  StopReason& reason = this->Result.reason;
  // An abort on any rank takes precedence over the time limit on another.
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
  return this->anyNeverInside();
}

//------------------------------------------------------------------------------
/// Sends the cells to the ranks of their original cells.
RankReconnection RankRounds::finish()
{
  std::vector<int> targets;
  for (const PartCell& cell : this->Part.cells)
  {
    targets.push_back(static_cast<int>(cell.originRank));
  }
  redistribute(this->Group, targets, this->Part);
  RankReconnection& result = this->Result;
  std::vector<std::pair<Index, std::size_t>> order; // of cells, by their original cells
  for (const PartCell& cell : this->Part.cells)
  {
    order.emplace_back(cell.originCell, order.size());
  }
  std::sort(order.begin(), order.end());
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
  const PointPlaces places(this->Part.points);
  for (const auto& [origin, c] : order)
  {
    const PartCell& cell = this->Part.cells[c];
    for (const Index number : cell.points)
    {
      result.tetrahedra.push_back(places(number));
    }
    result.originalCells.push_back(origin);
    result.obstacles.push_back(cell.obstacle);
    result.qualities.push_back(cell.quality);
    result.bounds.push_back(cell.bound);
  }
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
  return options.boundary == BoundaryMotion::OnSurface   ? "a boundary on the surface"
    : options.objective == ReconnectionObjective::Metric ? "a metric as objective"
    : options.improveMean                                ? "the best shape at the end"
    : options.adapt                                      ? "an adaptation"
    : options.overlaps                                   ? "a conservative transfer"
    : options.size != ReconnectionSize::None && options.size != ReconnectionSize::Length
    ? "lengths per point"
    : "";
}

//------------------------------------------------------------------------------
RankReconnection improveConnectivity(
  RankGroup& group, RankTetrahedra mesh, const ReconnectionOptions& options, int rounds)
{
  const std::string what = needsOneRank(options);
  if (!what.empty())
  {
    throw Error("with " + what + ", the mesh must be improved on one rank: gather it");
  }
  if (rounds < 1)
  {
    throw Error("the number of rounds must be at least 1");
  }
  RankReconnection result;
  group.together(
    [&]
    {
      RankRounds work(group, mesh, options);
      mesh = RankTetrahedra();
      result = work.run(rounds);
    });
  return result;
}
}
