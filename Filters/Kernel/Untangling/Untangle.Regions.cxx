// SPDX-License-Identifier: BSD-3-Clause
#include "UntangleRegions.h"

#include "Untangle.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <tuple>

namespace tautline
{
namespace
{
/// Widths of the rings around the invalid elements, in cells; then follows the whole mesh.
constexpr int widths[] = { 4, 12 };
/// Bytes per cell of untangle() including the mesh, measured for tetrahedra and rounded up.
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

/// The cells around invalid elements, from the whole mesh and in its order.
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

/// @param cells type, number of points, and point numbers of each cell
Region makeRegion(std::vector<RegionPoint> points, const std::vector<Index>& cells)
{
  Region region;
  region.points = std::move(points);
  unify(region.points);
  for (auto next = cells.begin(); next != cells.end();)
  {
    RegionCell cell;
    cell.type = static_cast<unsigned char>(*next++);
    const auto begin = next + 1;
    next = begin + *next;
    cell.numbers.assign(begin, next);
    cell.sorted = cell.numbers;
    std::sort(cell.sorted.begin(), cell.sorted.end());
    region.cells.push_back(std::move(cell));
  }
  std::sort(region.cells.begin(), region.cells.end(),
    [](const RegionCell& a, const RegionCell& b) { return a.key() < b.key(); });
  return region;
}

/// A connected part of a region as a separate mesh.
struct Part
{
  std::vector<Index> pointOf; ///< number in the region, per point
  std::vector<Index> cellOf;  ///< number in the region, per cell
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

/// The parts of a region that its free points connect; each cell without one is a separate part.
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

/// The state of a run; the result has the points.
class RegionUntangler
{
public:
  RegionUntangler(const Mesh& mesh, const UntangleOptions& options, const Ranks& ranks,
    UntangleProgress& progress, std::vector<signed char>& validity, UntangleResult& result);
  void run();

private:
  bool fitsWhole();
  void untangleWithin(int width);
  void listNear(const std::vector<unsigned char>& near, std::vector<RegionPoint>& points,
    std::vector<Index>& cells) const;
  Region gather(int width);
  double solve(const Region& region, int width);
  void note(const std::vector<Index>& list, int width);
  void take(const std::vector<RegionPoint>& moved);
  std::vector<Index> numbersOf(Index cell) const;
  void findObstacles();
  void listRemaining();

  const Mesh& Local;
  const MeshView& View;
  const UntangleOptions& Options;
  const Ranks& TheRanks;
  DistributedMesh& Spread;
  RankGroup& Group;
  UntangleProgress& Progress;
  UntangleResult& Result;
  std::vector<signed char>& Validity; ///< of the local cells
  const std::vector<signed char> Before;
  std::vector<unsigned char> Fixed;
  std::map<std::vector<Index>, Obstacle> Obstacles;
};

//------------------------------------------------------------------------------
RegionUntangler::RegionUntangler(const Mesh& mesh, const UntangleOptions& options,
  const Ranks& ranks, UntangleProgress& progress, std::vector<signed char>& validity,
  UntangleResult& result)
  : Local(mesh)
  , View(mesh.view())
  , Options(options)
  , TheRanks(ranks)
  , Spread(ranks.mesh())
  , Group(ranks.mesh().group())
  , Progress(progress)
  , Result(result)
  , Validity(validity)
  , Before(validity)
{
  this->Fixed.assign(options.fixed, options.fixed + this->View.numberOfPoints);
  this->Spread.exchange(this->Fixed.data());
}

//------------------------------------------------------------------------------
/// The owned cells with a marked free point (type, number of points, point numbers) and their
/// points.
void RegionUntangler::listNear(const std::vector<unsigned char>& near,
  std::vector<RegionPoint>& points, std::vector<Index>& cells) const
{
  const MeshView& view = this->View;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index* begin = view.connectivity + view.offsets[cell];
    const Index* end = view.connectivity + view.offsets[cell + 1];
    if (!this->TheRanks.ownsCell(cell) ||
      !std::any_of(begin, end, [&](Index p) { return near[p] && !this->Fixed[p]; }))
    {
      continue;
    }
    cells.push_back(view.cellTypes[cell]);
    cells.push_back(end - begin);
    for (const Index* p = begin; p != end; ++p)
    {
      cells.push_back(this->Spread.numbers()[*p]);
      RegionPoint point = { cells.back(), { 0, 0, 0 }, near[*p] && !this->Fixed[*p] };
      std::copy_n(&this->Result.points[3 * *p], 3, point.x);
      points.push_back(point);
    }
  }
  unify(points);
}

//------------------------------------------------------------------------------
/// The cells with a point within `width` cells of an invalid one that can be repaired, on all
/// ranks; all cells if width is negative, on the first rank only: they are usually one part, and
/// each copy takes as much memory as the whole mesh.
Region RegionUntangler::gather(int width)
{
  const MeshView& view = this->View;
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
    this->Spread.exchange(near.data());
  };
  near.assign(view.numberOfPoints, width < 0);
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
  { return width < 0 ? this->Group.gatherOnFirst(items) : this->Group.gatherJoined(items); };
  std::vector<RegionPoint> allPoints = collect(points);
  return makeRegion(std::move(allPoints), collect(cells));
}

//------------------------------------------------------------------------------
/// Untangles the parts of a region, each on one rank; parts of the whole mesh on the first rank.
/// Returns the sum of their objectives.
double RegionUntangler::solve(const Region& region, int width)
{
  std::vector<RegionPoint> moved;
  std::vector<Index> obstacles; // per element: the obstacle, the number of points, their numbers
  std::vector<double> objectives;
  const std::vector<std::vector<Index>> parts = connectedParts(region);
  const bool whole = width < 0;
  const std::size_t step = whole ? 1 : static_cast<std::size_t>(this->Group.size());
  for (std::size_t i = whole ? 0 : this->Group.rank(); i < parts.size(); i += step)
  {
    const Part part = makePart(region, parts[i]);
    Mesh mesh(part.view(), this->Options.threads);
    mesh.setMirrored(this->Local.mirrored());
    UntangleOptions options;
    options.method = this->Options.method;
    options.effort = this->Options.effort;
    options.fixed = part.fixed.data();
    options.threads = this->Options.threads;
    options.maximumSeconds = this->Progress.secondsLeft();
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
  const double objective = this->Group.orderlessSum(objectives);
  this->take(this->Group.gatherJoined(moved));
  this->note(this->Group.gatherJoined(obstacles), width);
  return objective;
}

//------------------------------------------------------------------------------
/// @param list per element: the obstacle, the number of points, the point numbers
void RegionUntangler::note(const std::vector<Index>& list, int width)
{
  for (auto next = list.begin(); next != list.end();)
  {
    const Index obstacle = *next++;
    const auto begin = next + 1;
    next = begin + *next;
    // Points around a partial region are held but not fixed.
    const bool known = width < 0 || obstacle == static_cast<Index>(Obstacle::FixedElement);
    this->Obstacles[{ begin, next }] = known ? static_cast<Obstacle>(obstacle) : Obstacle::Unknown;
  }
}

//------------------------------------------------------------------------------
void RegionUntangler::take(const std::vector<RegionPoint>& moved)
{
  for (const RegionPoint& point : moved)
  {
    const Index p = this->Spread.local(point.number);
    if (p >= 0)
    {
      std::copy_n(point.x, 3, &this->Result.points[3 * p]);
    }
  }
}

//------------------------------------------------------------------------------
/// Whether the whole mesh can be untangled on the first rank. If not, the previous repairs are
/// kept; throws Error if there are none.
bool RegionUntangler::fitsWhole()
{
  const double bytes = bytesPerCell * static_cast<double>(this->Spread.globalCells());
  std::string lack;
  try
  {
    requireMemory(this->Group.rank() == 0 ? bytes : 0.0,
      "untangling the whole mesh on the first process, because the regions around the invalid "
      "elements are not sufficient,",
      "choose Effort = Local");
  }
  catch (const MemoryError& error)
  {
    lack = error.what();
  }
  this->Result.exceededMemory = this->Group.any(!lack.empty());
  if (!lack.empty() && this->Result.invertedAfter == this->Result.invertedBefore)
  {
    throw MemoryError(lack);
  }
  return !this->Result.exceededMemory;
}

//------------------------------------------------------------------------------
/// @param width of the rings; negative: the whole mesh
void RegionUntangler::untangleWithin(int width)
{
  UntangleResult& result = this->Result;
  if (width < 0 && !this->fitsWhole())
  {
    return;
  }
  const Index before = result.invertedAfter;
  std::vector<double> kept = result.points;
  std::vector<signed char> validity = this->Validity;
  const double objective = this->solve(this->gather(width), width);
  this->Validity = this->Before;
  this->Local.classifyMovedCells(
    result.points.data(), this->Validity.data(), this->Options.threads);
  result.invertedAfter = countInvalid(this->Local, this->Validity, this->TheRanks);
  if (result.invertedAfter > before)
  {
    result.points.swap(kept);
    this->Validity.swap(validity);
    result.invertedAfter = before;
  }
  constexpr double stages = 3.0;
  this->Progress.record(result.invertedAfter, objective, this->Progress.iteration() / stages,
    [&](double* to) { std::copy(result.points.begin(), result.points.end(), to); });
}

//------------------------------------------------------------------------------
/// The point numbers of a cell in increasing order.
std::vector<Index> RegionUntangler::numbersOf(Index cell) const
{
  std::vector<Index> sorted;
  for (Index n = this->View.offsets[cell]; n < this->View.offsets[cell + 1]; ++n)
  {
    sorted.push_back(this->Spread.numbers()[this->View.connectivity[n]]);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

//------------------------------------------------------------------------------
/// Finds the obstacles of the local cells.
void RegionUntangler::findObstacles()
{
  for (Index cell = 0; cell < this->View.numberOfCells; ++cell)
  {
    if (isInvalid(this->Validity[cell]))
    {
      const auto found = this->Obstacles.find(this->numbersOf(cell));
      const bool allFixed = std::all_of(this->View.connectivity + this->View.offsets[cell],
        this->View.connectivity + this->View.offsets[cell + 1],
        [&](Index p) { return this->Fixed[p] != 0; });
      this->Result.obstacles[cell] = static_cast<signed char>(allFixed ? Obstacle::FixedElement
          : found == this->Obstacles.end()                             ? Obstacle::Unknown
                                                                       : found->second);
    }
  }
}

//------------------------------------------------------------------------------
/// Lists the invalid elements of the whole mesh with their obstacles.
void RegionUntangler::listRemaining()
{
  std::vector<Index> numbers; // of each element: the number of points, the point numbers
  std::vector<TangledElement> elements;
  for (Index cell = 0; cell < this->View.numberOfCells; ++cell)
  {
    if (!this->TheRanks.ownsCell(cell) || !isInvalid(this->Validity[cell]))
    {
      continue;
    }
    const std::vector<Index> sorted = this->numbersOf(cell);
    numbers.push_back(static_cast<Index>(sorted.size()));
    numbers.insert(numbers.end(), sorted.begin(), sorted.end());
    TangledElement element;
    element.obstacle = static_cast<Obstacle>(this->Result.obstacles[cell]);
    const double part = 1.0 / static_cast<double>(sorted.size());
    for (Index n = this->View.offsets[cell]; n < this->View.offsets[cell + 1]; ++n)
    {
      const double* x = &this->Result.points[3 * this->View.connectivity[n]];
      element.center += part * Vec3{ x[0], x[1], x[2] };
    }
    elements.push_back(element);
  }
  const std::vector<Index> allNumbers = this->Group.gatherJoined(numbers);
  auto next = allNumbers.begin();
  for (const TangledElement& element : this->Group.gatherJoined(elements))
  {
    const auto begin = next + 1;
    next = begin + *next;
    this->Result.remaining[{ begin, next }] = element;
  }
  for (const auto& element : this->Result.remaining)
  {
    this->Result.impossible += element.second.obstacle == Obstacle::FixedElement ||
      element.second.obstacle == Obstacle::FixedNeighbours;
  }
}

//------------------------------------------------------------------------------
void RegionUntangler::run()
{
  UntangleResult& result = this->Result;
  Index free = 0;
  for (Index p = 0; p < this->View.numberOfPoints; ++p)
  {
    free += this->TheRanks.owns(p) && !this->Fixed[p];
  }
  if (this->TheRanks.sum(free) == 0)
  {
    result.reason = StopReason::NoFreeVertices;
  }
  else if (result.invertedBefore > 0)
  {
    const bool whole = this->Options.method == UntangleMethod::Simultaneous;
    for (const int width : widths)
    {
      if (!whole && !this->Progress.stopped() && result.invertedAfter > 0)
      {
        this->untangleWithin(width);
      }
    }
    if (!this->Progress.stopped() && result.invertedAfter > 0 &&
      (whole || this->Options.effort != Effort::Local))
    {
      this->untangleWithin(-1);
    }
    this->TheRanks.exchange(result.points.data(), 3);
  }
  this->findObstacles();
  this->listRemaining();
}
}

//------------------------------------------------------------------------------
void untangleRegions(const Mesh& mesh, const UntangleOptions& options, const Ranks& ranks,
  UntangleProgress& progress, std::vector<signed char>& validity, UntangleResult& result)
{
  RegionUntangler(mesh, options, ranks, progress, validity, result).run();
}
}
