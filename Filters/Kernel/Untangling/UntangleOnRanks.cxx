// SPDX-License-Identifier: BSD-3-Clause
#include "UntangleOnRanks.h"

#include "Untangle.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <tuple>

namespace tautline
{
namespace
{
/// Widths of the rings about the invalid elements, in cells; then comes the whole mesh.
constexpr int widths[] = { 4, 12 };
/// Bytes per cell of untangle() with its mesh, measured on tetrahedra and rounded up.
constexpr double bytesPerCell = 1500;

struct RegionPoint
{
  Index number;
  double x[3];
  Index free;
};

struct RegionCell
{
  std::vector<Index> sorted, numbers;
  unsigned char type;

  auto key() const { return std::tie(this->sorted, this->type, this->numbers); }
};

/// The cells about invalid elements, of the whole mesh and in its order.
struct Region
{
  std::vector<RegionPoint> points; ///< in the order of their numbers
  std::vector<RegionCell> cells;

  Index find(Index number) const
  {
    const auto at = std::lower_bound(this->points.begin(), this->points.end(), number,
      [](const RegionPoint& p, Index n) { return p.number < n; });
    return at - this->points.begin();
  }
};

/// Each point once, in the order of the numbers.
void unify(std::vector<RegionPoint>& points)
{
  std::sort(points.begin(), points.end(),
    [](const RegionPoint& a, const RegionPoint& b) { return a.number < b.number; });
  points.erase(std::unique(points.begin(), points.end(),
                 [](const RegionPoint& a, const RegionPoint& b) { return a.number == b.number; }),
    points.end());
}

/// @param cells type, number of points and their numbers of each, by ranks
Region makeRegion(
  const std::vector<std::vector<RegionPoint>>& points, const std::vector<std::vector<Index>>& cells)
{
  Region region;
  for (const auto& list : points)
  {
    region.points.insert(region.points.end(), list.begin(), list.end());
  }
  unify(region.points);
  for (const auto& list : cells)
  {
    for (std::size_t i = 0; i < list.size();)
    {
      RegionCell cell;
      cell.type = static_cast<unsigned char>(list[i]);
      const auto begin = list.begin() + static_cast<std::ptrdiff_t>(i) + 2;
      cell.numbers.assign(begin, begin + list[i + 1]);
      cell.sorted = cell.numbers;
      std::sort(cell.sorted.begin(), cell.sorted.end());
      i += 2 + cell.numbers.size();
      region.cells.push_back(std::move(cell));
    }
  }
  std::sort(region.cells.begin(), region.cells.end(),
    [](const RegionCell& a, const RegionCell& b) { return a.key() < b.key(); });
  return region;
}

/// A connected part of a region as a mesh of its own.
struct Part
{
  std::vector<Index> pointOf; ///< of the region, per point
  std::vector<Index> cellOf;  ///< of the region, per cell
  std::vector<double> x;
  std::vector<unsigned char> types, fixed;
  std::vector<Index> offsets = { 0 }, connectivity;

  MeshView view() const
  {
    MeshView view;
    view.numberOfPoints = static_cast<Index>(this->pointOf.size());
    view.points = this->x.data();
    view.numberOfCells = static_cast<Index>(this->types.size());
    view.cellTypes = this->types.data();
    view.offsets = this->offsets.data();
    view.connectivity = this->connectivity.data();
    return view;
  }
};

Part makePart(const Region& region, std::vector<Index> cells)
{
  Part part;
  part.cellOf = std::move(cells);
  for (const Index cell : part.cellOf)
  {
    for (const Index number : region.cells[cell].numbers)
    {
      part.pointOf.push_back(region.find(number));
    }
  }
  std::sort(part.pointOf.begin(), part.pointOf.end());
  part.pointOf.erase(std::unique(part.pointOf.begin(), part.pointOf.end()), part.pointOf.end());
  for (const Index p : part.pointOf)
  {
    part.x.insert(part.x.end(), region.points[p].x, region.points[p].x + 3);
    part.fixed.push_back(!region.points[p].free);
  }
  for (const Index cell : part.cellOf)
  {
    part.types.push_back(region.cells[cell].type);
    for (const Index number : region.cells[cell].numbers)
    {
      const auto at =
        std::lower_bound(part.pointOf.begin(), part.pointOf.end(), region.find(number));
      part.connectivity.push_back(at - part.pointOf.begin());
    }
    part.offsets.push_back(static_cast<Index>(part.connectivity.size()));
  }
  return part;
}

/// The parts of a region that its free points connect; cells without one are a part each.
std::vector<std::vector<Index>> connectedParts(const Region& region)
{
  UnionFind sets(static_cast<Index>(region.points.size()));
  std::vector<Index> leader;
  for (const RegionCell& cell : region.cells)
  {
    Index first = -1;
    for (const Index number : cell.numbers)
    {
      const Index p = region.find(number);
      if (region.points[p].free)
      {
        first = first < 0 ? p : first;
        sets.join(first, p);
      }
    }
    leader.push_back(first);
  }
  std::map<Index, std::vector<Index>> parts;
  for (std::size_t cell = 0; cell < leader.size(); ++cell)
  {
    if (leader[cell] >= 0)
    {
      parts[sets.find(leader[cell])].push_back(static_cast<Index>(cell));
    }
  }
  std::vector<std::vector<Index>> result;
  for (auto& part : parts)
  {
    result.push_back(std::move(part.second));
  }
  return result;
}

/**
 * @class RankUntangler
 * @brief The state of a run.
 */
class RankUntangler
{
public:
  RankUntangler(DistributedMesh& mesh, bool mirrored, const UntangleOptions& options);
  RankUntangleResult run();

private:
  Index examine();
  bool fitsWhole();
  void untangleWithin(int width);
  void listNear(const std::vector<unsigned char>& near, std::vector<RegionPoint>& points,
    std::vector<Index>& cells) const;
  Region gather(int width);
  void solve(const Region& region, int width);
  void note(const std::vector<std::vector<Index>>& lists, int width);
  void take(const std::vector<RegionPoint>& moved);
  void listInvalid(std::vector<Index>& lists, std::vector<Vec3>& centers) const;
  void listRemaining();
  bool report();
  bool outOfTime() { return this->Group.any(this->Clock.reached(this->Options.maximumSeconds)); }

  DistributedMesh& TheMesh;
  RankGroup& Group;
  bool Mirrored;
  const UntangleOptions& Options;
  Stopwatch Clock;
  std::vector<unsigned char> Fixed;
  std::vector<double> Points;
  std::vector<signed char> Validity; ///< of the local cells
  std::map<std::vector<Index>, Obstacle> Obstacles;
  double Objective = 0;
  bool Stopped = false;
  RankUntangleResult Result;
};

//------------------------------------------------------------------------------
RankUntangler::RankUntangler(DistributedMesh& mesh, bool mirrored, const UntangleOptions& options)
  : TheMesh(mesh)
  , Group(mesh.group())
  , Mirrored(mirrored)
  , Options(options)
{
  this->Fixed.assign(options.fixed, options.fixed + mesh.localPoints());
  this->Points = mesh.points();
  mesh.exchange(this->Fixed.data());
}

//------------------------------------------------------------------------------
/// Validity of the local cells; the number of invalid cells of the whole mesh.
Index RankUntangler::examine()
{
  const MeshView& local = this->TheMesh.view();
  Index count = 0;
  this->Validity.assign(local.numberOfCells, Valid);
  if (local.numberOfCells > 0)
  {
    MeshView view = local;
    view.points = this->Points.data();
    Mesh moved(view, this->Options.threads);
    moved.setMirrored(this->Mirrored);
    moved.classifyCells(this->Validity.data(), this->Options.threads);
  }
  for (Index cell = 0; cell < local.numberOfCells; ++cell)
  {
    count += this->TheMesh.ownedCells()[cell] && isInvalid(this->Validity[cell]);
  }
  return this->Group.sum(count);
}

//------------------------------------------------------------------------------
/// The owned cells with a free point that is marked: type, number of points, their numbers; and
/// their points.
void RankUntangler::listNear(const std::vector<unsigned char>& near,
  std::vector<RegionPoint>& points, std::vector<Index>& cells) const
{
  const MeshView& view = this->TheMesh.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index* begin = view.connectivity + view.offsets[cell];
    const Index* end = view.connectivity + view.offsets[cell + 1];
    if (!this->TheMesh.ownedCells()[cell] ||
      !std::any_of(begin, end, [&](Index p) { return near[p] && !this->Fixed[p]; }))
    {
      continue;
    }
    cells.push_back(view.cellTypes[cell]);
    cells.push_back(end - begin);
    for (const Index* p = begin; p != end; ++p)
    {
      cells.push_back(this->TheMesh.numbers()[*p]);
      RegionPoint point = { cells.back(), { 0, 0, 0 }, near[*p] && !this->Fixed[*p] };
      std::copy_n(&this->Points[3 * *p], 3, point.x);
      points.push_back(point);
    }
  }
  unify(points);
}

//------------------------------------------------------------------------------
/// The cells with a point within `width` cells of an invalid one that can be repaired, on all
/// ranks; all cells if width is negative, on the first rank: they are one part as a rule, and each
/// copy takes as much memory as the whole mesh.
Region RankUntangler::gather(int width)
{
  const MeshView& view = this->TheMesh.view();
  std::vector<unsigned char> near, next;
  const auto mark = [&](auto wanted)
  {
    next = near;
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      const Index* begin = view.connectivity + view.offsets[cell];
      const Index* end = view.connectivity + view.offsets[cell + 1];
      if (wanted(cell, begin, end))
      {
        std::for_each(begin, end, [&](Index p) { next[p] = 1; });
      }
    }
    near.swap(next);
    this->TheMesh.exchange(near.data());
  };
  near.assign(this->TheMesh.localPoints(), width < 0);
  mark(
    [&](Index cell, const Index* begin, const Index* end)
    {
      return isInvalid(this->Validity[cell]) &&
        std::any_of(begin, end, [&](Index p) { return !this->Fixed[p]; });
    });
  for (int ring = 0; ring < width; ++ring)
  {
    mark([&](Index, const Index* begin, const Index* end)
      { return std::any_of(begin, end, [&](Index p) { return near[p] != 0; }); });
  }
  std::vector<RegionPoint> points;
  std::vector<Index> cells;
  this->listNear(near, points, cells);
  const auto collect = [&](const auto& items)
  {
    if (width >= 0)
    {
      return this->Group.gatherItems(items);
    }
    std::vector<std::decay_t<decltype(items)>> sent;
    sent.resize(this->Group.size());
    sent.front() = items;
    return this->Group.exchangeItems(sent);
  };
  const auto allPoints = collect(points);
  const auto allCells = collect(cells);
  Region region;
  region = makeRegion(allPoints, allCells);
  return region;
}

//------------------------------------------------------------------------------
/// Untangles the parts of a region, each on one rank: those of the whole mesh on the first one.
void RankUntangler::solve(const Region& region, int width)
{
  std::vector<RegionPoint> moved;
  std::vector<Index> obstacles; // of elements: the obstacle, how many points, their numbers
  std::vector<double> objectives;
  const std::vector<std::vector<Index>> parts = connectedParts(region);
  const bool whole = width < 0;
  const std::size_t step = whole ? 1 : static_cast<std::size_t>(this->Group.size());
  for (std::size_t i = whole ? 0 : this->Group.rank(); i < parts.size(); i += step)
  {
    const Part part = makePart(region, parts[i]);
    Mesh mesh(part.view(), this->Options.threads);
    mesh.setMirrored(this->Mirrored);
    UntangleOptions options;
    options.method = this->Options.method;
    options.effort = this->Options.effort;
    options.fixed = part.fixed.data();
    options.threads = this->Options.threads;
    if (this->Options.maximumSeconds > 0)
    {
      options.maximumSeconds = std::max(
        std::numeric_limits<double>::min(), this->Options.maximumSeconds - this->Clock.seconds());
    }
    const UntangleResult result = tautline::untangle(mesh, options);
    objectives.push_back(result.history.empty() ? 0.0 : result.history.back().objective);
    for (std::size_t p = 0; p < part.pointOf.size(); ++p)
    {
      RegionPoint point = region.points[part.pointOf[p]];
      if (!std::equal(point.x, point.x + 3, &result.points[3 * p]))
      {
        std::copy_n(&result.points[3 * p], 3, point.x);
        moved.push_back(point);
      }
    }
    for (std::size_t cell = 0; cell < part.cellOf.size(); ++cell)
    {
      if (result.obstacles[cell] != static_cast<signed char>(Obstacle::None))
      {
        const std::vector<Index>& sorted = region.cells[part.cellOf[cell]].sorted;
        obstacles.push_back(result.obstacles[cell]);
        obstacles.push_back(static_cast<Index>(sorted.size()));
        obstacles.insert(obstacles.end(), sorted.begin(), sorted.end());
      }
    }
  }
  this->Objective = this->Group.orderlessSum(objectives);
  for (const auto& list : this->Group.gatherItems(moved))
  {
    this->take(list);
  }
  const auto found = this->Group.gatherItems(obstacles);
  this->note(found, width);
}

//------------------------------------------------------------------------------
/// @param lists by ranks, of elements: the obstacle, how many points, their numbers
void RankUntangler::note(const std::vector<std::vector<Index>>& lists, int width)
{
  for (const std::vector<Index>& list : lists)
  {
    for (std::size_t i = 0; i < list.size(); i += 2 + static_cast<std::size_t>(list[i + 1]))
    {
      const auto begin = list.begin() + static_cast<std::ptrdiff_t>(i) + 2;
      // Points around a region that is not the whole mesh are held, but not fixed.
      const bool known = width < 0 || list[i] == static_cast<Index>(Obstacle::FixedElement);
      this->Obstacles[{ begin, begin + list[i + 1] }] =
        known ? static_cast<Obstacle>(list[i]) : Obstacle::Unknown;
    }
  }
}

//------------------------------------------------------------------------------
void RankUntangler::take(const std::vector<RegionPoint>& moved)
{
  const std::vector<Index>& numbers = this->TheMesh.numbers();
  for (const RegionPoint& point : moved)
  {
    const auto at = std::lower_bound(numbers.begin(), numbers.end(), point.number);
    if (at != numbers.end() && *at == point.number)
    {
      std::copy_n(point.x, 3, &this->Points[3 * (at - numbers.begin())]);
    }
  }
}

//------------------------------------------------------------------------------
/// Adds a record; false if an observer stops the run.
bool RankUntangler::report()
{
  IterationRecord record;
  record.iteration = static_cast<int>(this->Result.result.history.size());
  record.seconds = this->Clock.seconds();
  record.objective = this->Objective;
  record.inverted = this->Result.result.invertedAfter;
  this->Result.result.history.push_back(record);
  constexpr double stages = 3.0;
  const auto points = [&](double* to) { std::copy(this->Points.begin(), this->Points.end(), to); };
  bool proceed = true;
  proceed = !this->Options.observer ||
    this->Options.observer({ record, std::min(1.0, record.iteration / stages), points });
  return !this->Group.any(!proceed);
}

//------------------------------------------------------------------------------
/// Whether the whole mesh can be untangled on the first rank. Where it cannot, what was repaired
/// before is kept; Error if nothing was.
bool RankUntangler::fitsWhole()
{
  const double bytes = bytesPerCell * static_cast<double>(this->TheMesh.globalCells());
  std::string lack;
  try
  {
    requireMemory(this->Group.rank() == 0 ? bytes : 0.0,
      "untangling the whole mesh on the first process, where what is about the invalid elements is "
      "not enough,",
      "choose the Effort Local");
  }
  catch (const MemoryError& error)
  {
    lack = error.what();
  }
  this->Result.exceededMemory = this->Group.any(!lack.empty());
  if (!lack.empty() && this->Result.result.invertedAfter == this->Result.result.invertedBefore)
  {
    throw MemoryError(lack);
  }
  return !this->Result.exceededMemory;
}

//------------------------------------------------------------------------------
void RankUntangler::untangleWithin(int width)
{
  UntangleResult& result = this->Result.result;
  if (width < 0 && !this->fitsWhole())
  {
    return;
  }
  const Index before = result.invertedAfter;
  std::vector<double> kept;
  std::vector<signed char> validity;
  kept = this->Points;
  validity = this->Validity;
  const Region region = this->gather(width);
  this->solve(region, width);
  result.invertedAfter = this->examine();
  if (result.invertedAfter > before)
  {
    this->Points.swap(kept);
    this->Validity.swap(validity);
    result.invertedAfter = before;
  }
  if (!this->report())
  {
    result.reason = StopReason::Aborted;
    this->Stopped = true;
  }
  else if (result.invertedAfter > 0 && this->outOfTime())
  {
    result.reason = StopReason::TimeLimit;
    this->Stopped = true;
  }
}

//------------------------------------------------------------------------------
/// The owned invalid elements: the obstacle, the type, how many points, their numbers; and their
/// centers.
void RankUntangler::listInvalid(std::vector<Index>& lists, std::vector<Vec3>& centers) const
{
  const MeshView& view = this->TheMesh.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    if (!this->TheMesh.ownedCells()[cell] || !isInvalid(this->Validity[cell]))
    {
      continue;
    }
    std::vector<Index> sorted;
    bool allFixed = true;
    Vec3 center = { 0, 0, 0 };
    const Index begin = view.offsets[cell], end = view.offsets[cell + 1];
    for (Index n = begin; n < end; ++n)
    {
      const Index p = view.connectivity[n];
      sorted.push_back(this->TheMesh.numbers()[p]);
      allFixed = allFixed && this->Fixed[p];
      const double share = 1.0 / static_cast<double>(end - begin);
      center +=
        share * Vec3{ this->Points[3 * p], this->Points[3 * p + 1], this->Points[3 * p + 2] };
    }
    std::sort(sorted.begin(), sorted.end());
    const auto found = this->Obstacles.find(sorted);
    const Obstacle obstacle = allFixed ? Obstacle::FixedElement
      : found == this->Obstacles.end() ? Obstacle::Unknown
                                       : found->second;
    lists.insert(lists.end(),
      { static_cast<Index>(obstacle), static_cast<Index>(view.cellTypes[cell]), end - begin });
    lists.insert(lists.end(), sorted.begin(), sorted.end());
    centers.push_back(center);
  }
}

//------------------------------------------------------------------------------
/// The invalid elements of the whole mesh with their obstacles.
void RankUntangler::listRemaining()
{
  std::vector<Index> lists;
  std::vector<Vec3> centers;
  this->listInvalid(lists, centers);
  const auto allCenters = this->Group.gatherItems(centers);
  const auto allLists = this->Group.gatherItems(lists);
  for (std::size_t rank = 0; rank < allLists.size(); ++rank)
  {
    const std::vector<Index>& list = allLists[rank];
    for (std::size_t i = 0, k = 0; i < list.size(); i += 3 + list[i + 2], ++k)
    {
      const auto begin = list.begin() + static_cast<std::ptrdiff_t>(i) + 3;
      const auto obstacle = static_cast<Obstacle>(list[i]);
      this->Result.remaining[{ begin, begin + list[i + 2] }] = { obstacle,
        static_cast<unsigned char>(list[i + 1]), allCenters[rank][k] };
    }
  }
  for (const auto& element : this->Result.remaining)
  {
    this->Result.result.impossible += element.second.obstacle == Obstacle::FixedElement ||
      element.second.obstacle == Obstacle::FixedNeighbours;
  }
}

//------------------------------------------------------------------------------
RankUntangleResult RankUntangler::run()
{
  UntangleResult& result = this->Result.result;
  result.points = this->Points;
  result.invertedBefore = result.invertedAfter = this->examine();
  const std::vector<signed char> before = this->Validity;
  Index free = 0;
  for (Index p = 0; p < this->TheMesh.localPoints(); ++p)
  {
    free += this->TheMesh.owned(p) && !this->Fixed[p];
  }
  free = this->Group.sum(free);
  if (result.invertedBefore > 0 && free > 0)
  {
    const bool whole = this->Options.method == UntangleMethod::Simultaneous;
    result.reason = StopReason::NoProgress;
    for (const int width : widths)
    {
      if (!whole && !this->Stopped && result.invertedAfter > 0)
      {
        this->untangleWithin(width);
      }
    }
    if (!this->Stopped && result.invertedAfter > 0 &&
      (whole || this->Options.effort != Effort::Local))
    {
      this->untangleWithin(-1);
    }
    this->TheMesh.exchange(this->Points.data(), 3);
    result.points = this->Points;
  }
  else
  {
    result.reason = result.invertedBefore == 0 ? StopReason::AllValid : StopReason::NoFreeVertices;
  }
  result.reason = result.invertedAfter == 0 ? StopReason::AllValid : result.reason;
  Index newly = 0;
  for (std::size_t cell = 0; cell < before.size(); ++cell)
  {
    newly +=
      this->TheMesh.ownedCells()[cell] && before[cell] == Valid && isInvalid(this->Validity[cell]);
  }
  result.newlyInvalid = this->Group.sum(newly);
  this->listRemaining();
  return this->Result;
}
}

//------------------------------------------------------------------------------
RankUntangleResult untangleOnRanks(
  DistributedMesh& mesh, bool mirrored, const UntangleOptions& options)
{
  RankUntangleResult result;
  mesh.group().together(
    [&]
    {
      if (!options.fixed && mesh.localPoints() > 0)
      {
        throw Error(
          "The fixed points of a mesh on several ranks must be given, see rankBoundary().");
      }
      result = RankUntangler(mesh, mirrored, options).run();
    });
  return result;
}
}
