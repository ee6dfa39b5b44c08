// SPDX-License-Identifier: BSD-3-Clause
#include "MovingBarrier.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// Determinants are measured in units of this fraction of their mean at the start.
constexpr double unitOfDeterminant = 0.1;
/// The initial and final width of the window, and its reduction factor.
constexpr double firstWindow = 0.35, lastWindow = 0.004, narrower = 0.6;
/// The window begins below the worst corner by this fraction of its width.
constexpr double belowWorst = 0.08;
/// A round that improves the worst corner by less than this fraction of the window is poor; after
/// this many poor rounds, the window is narrowed.
constexpr double poorGain = 0.01;
constexpr int poorRounds = 3;
constexpr int stepsOfRound = 4;
/// Fraction of the shortest edge at a point: its largest step.
constexpr double longestStep = 0.3;
/// The constant added to the shape of a corner for its curvature, see addCell().
constexpr double curvatureOfPerfect = 0.3;
/// The factor on the weight of the bounds after a round that ends beyond them.
constexpr double strongerBounds = 1.3;
constexpr Index cellsOfChunk = 64;
/// An upper bound of the threshold: larger determinants do not contribute.
constexpr double mostThreshold = 1 + firstWindow;

/// b(u) = -(1 - u)^2 ln u, and its derivatives.
struct Barrier
{
  double value = 0, first = 0, second = 0;
  explicit Barrier(double u)
  {
    if (u < 1)
    {
      const double log = std::log(u), rest = 1 - u, ratio = rest / u;
      this->value = -rest * rest * log;
      this->first = rest * (2 * log - ratio);
      this->second = -2 * log + 4 * ratio + ratio * ratio;
    }
  }
};
}

//------------------------------------------------------------------------------
MovingBarrier::MovingBarrier(const SlidingCells& cells, const ConstrainedPoints& constrained,
  BoundaryTerms& boundary, std::vector<Vec3>& x, const BarrierOptions& options)
  : Cells(cells)
  , Constrained(constrained)
  , Boundary(boundary)
  , X(x)
  , Options(options)
  , Units(cells.cells().size())
  , Worst(cells.cells().size())
  , WorstCorner(cells.cells().size())
  , Least(cells.cells().size())
  , Longest(cells.cells().size())
  , Local(x.size(), -1)
{
  // Cells of almost zero size use the size of their neighborhood as a unit.
  double total = 0;
  for (std::size_t c = 0; c < this->Units.size(); ++c)
  {
    const SlidingCells::Cell& cell = this->Cells.cells()[c];
    Vec3 vertices[MaxNodes];
    this->Cells.load(cell, x, vertices);
    const auto& places = determinantPlaces(cell.t->type);
    double sum = 0, length = 0;
    for (const DeterminantPlace& place : places)
    {
      sum += this->Cells.sign() * determinantAt(*cell.t, place, vertices, cells.normal(), nullptr);
    }
    for (int e = 0; e < cell.t->edges; ++e)
    {
      const auto& [a, b] = cell.t->edgeNodes[e];
      length += norm(vertices[b] - vertices[a]);
    }
    length /= cell.t->edges;
    constexpr double leastOfCube = 0.1;
    const double cube = cell.t->dimension == 3 ? length * length * length : length * length;
    this->Units[c] =
      unitOfDeterminant * std::max(sum / static_cast<double>(places.size()), leastOfCube * cube);
    total += this->Units[c];
  }
  const double least = 1e-6 * total / static_cast<double>(std::max<std::size_t>(1, Units.size()));
  for (double& unit : this->Units)
  {
    unit = std::max({ unit, least, std::numeric_limits<double>::min() });
  }
  this->findMovable();
  this->measureAll();
}

//------------------------------------------------------------------------------
/// Finds the corners and determinants that depend on a movable point.
void MovingBarrier::findMovable()
{
  for (const SlidingCells::Cell& cell : this->Cells.cells())
  {
    const CellTopology& t = *cell.t;
    std::uint64_t flags = 0;
    const auto moves = [&](int node)
    { return this->Constrained.freedom(cell.nodes[node]) != Freedom::None; };
    for (int corner = 0; corner < t.corners; ++corner)
    {
      const std::array<int, 4>& nodes = t.cornerNodes[corner];
      const bool any = std::any_of(nodes.begin(), nodes.begin() + t.dimension + 1, moves);
      flags |= static_cast<std::uint64_t>(any) << corner;
    }
    const std::vector<DeterminantPlace>& places = determinantPlaces(t.type);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      bool any = false;
      for (int node = 0; node < t.nodes; ++node)
      {
        const auto& w = places[i].weights;
        any = any || ((w[0][node] != 0 || w[1][node] != 0 || w[2][node] != 0) && moves(node));
      }
      flags |= static_cast<std::uint64_t>(any) << (MaxNodes + i);
    }
    this->Movable.push_back(flags);
  }
}

//------------------------------------------------------------------------------
CornerEdges MovingBarrier::edgesAt(
  const SlidingCells::Cell& cell, int corner, const Vec3* vertices) const
{
  const std::array<int, 4>& nodes = cell.t->cornerNodes[corner];
  const Vec3& origin = vertices[nodes[0]];
  return { { vertices[nodes[1]] - origin, vertices[nodes[2]] - origin,
             cell.t->dimension == 3 ? vertices[nodes[3]] - origin : this->Cells.normal() },
    cell.t->dimension, this->Cells.sign() };
}

//------------------------------------------------------------------------------
/// @param least a lower bound of the determinants, which are measured if it is below the threshold
void MovingBarrier::valuesOf(
  std::size_t index, const std::vector<Vec3>& x, double least, Values& values) const
{
  const SlidingCells::Cell& cell = this->Cells.cells()[index];
  const CellTopology& t = *cell.t;
  Vec3 vertices[MaxNodes];
  this->Cells.load(cell, x, vertices);
  values.count = 0;
  for (int corner = 0; corner < this->cornersOf(t); ++corner)
  {
    if (!this->canMove(index, corner))
    {
      continue;
    }
    values.s[values.count++] =
      measureCorner(t, corner, this->edgesAt(cell, corner, vertices), this->Options.measure, false)
        .value;
  }
  values.corners = values.count;
  values.measured = least < mostThreshold;
  const std::vector<DeterminantPlace>& places = determinantPlaces(t.type);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const DeterminantPlace& place = places[i];
    if (values.measured && this->canMove(index, MaxNodes + static_cast<int>(i)))
    {
      values.s[values.count++] = this->Cells.sign() *
        determinantAt(t, place, vertices, this->Cells.normal(), nullptr) / this->Units[index];
    }
  }
}

//------------------------------------------------------------------------------
/// A lower bound of the determinants of a cell at x, from the displacements of its points. The
/// derivatives, at most as long as the longest edge, change by up to twice the displacement.
double MovingBarrier::leastDeterminant(std::size_t index, const std::vector<Vec3>& x) const
{
  const SlidingCells::Cell& cell = this->Cells.cells()[index];
  double most2 = 0;
  for (int k = 0; k < cell.t->nodes; ++k)
  {
    const Vec3 d = x[cell.nodes[k]] - this->X[cell.nodes[k]];
    most2 = std::max(most2, dot(d, d));
  }
  const double length = this->Longest[index], more = length + 2 * std::sqrt(most2);
  const bool flat = cell.t->dimension == 2;
  const double change =
    flat ? more * more - length * length : more * more * more - length * length * length;
  return this->Least[index] - change / this->Units[index];
}

//------------------------------------------------------------------------------
/// @param least a lower bound of the determinants at the points
void MovingBarrier::measure(std::size_t index, double least)
{
  Values values;
  this->valuesOf(index, this->X, least, values);
  const auto begin = values.s.begin(), end = begin + values.count, middle = begin + values.corners;
  const auto leastOf = [](auto from, auto to)
  { return from == to ? mostThreshold : *std::min_element(from, to); };
  this->WorstCorner[index] = leastOf(begin, middle);
  this->Least[index] = values.measured ? leastOf(middle, end) : least;
  this->Worst[index] = std::min(this->WorstCorner[index], this->Least[index]);
  const SlidingCells::Cell& cell = this->Cells.cells()[index];
  double longest2 = 0;
  for (int e = 0; e < cell.t->edges; ++e)
  {
    const auto& [a, b] = cell.t->edgeNodes[e];
    const Vec3 edge = this->X[cell.nodes[b]] - this->X[cell.nodes[a]];
    longest2 = std::max(longest2, dot(edge, edge));
  }
  this->Longest[index] = std::sqrt(longest2);
}

void MovingBarrier::measureAll()
{
  parallelFor(static_cast<Index>(this->Worst.size()), cellsOfChunk, this->Options.threads,
    [this](Index c) { this->measure(static_cast<std::size_t>(c), -1.0); });
}

double MovingBarrier::worst() const
{
  return this->Worst.empty() ? 1.0 : *std::min_element(this->Worst.begin(), this->Worst.end());
}

double MovingBarrier::worstCorner() const
{
  return this->WorstCorner.empty()
    ? 1.0
    : *std::min_element(this->WorstCorner.begin(), this->WorstCorner.end());
}

double MovingBarrier::worstCornerOf(std::size_t index, const Vec3* vertices) const
{
  const SlidingCells::Cell& cell = this->Cells.cells()[index];
  const CellTopology& t = *cell.t;
  double worst = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < this->cornersOf(t); ++corner)
  {
    if (!this->canMove(index, corner))
    {
      continue;
    }
    const CornerEdges edges = this->edgesAt(cell, corner, vertices);
    worst = std::min(worst, measureCorner(t, corner, edges, this->Options.measure, false).value);
  }
  return worst;
}

//------------------------------------------------------------------------------
/// Numbers the flagged movable points, and lists their cells.
void MovingBarrier::indexPoints(const std::vector<char>& moving)
{
  std::fill(this->Local.begin(), this->Local.end(), -1);
  this->Moving.clear();
  std::vector<char> flags(moving.size(), 0), near;
  for (std::size_t p = 0; p < moving.size(); ++p)
  {
    const auto point = static_cast<Index>(p);
    if (moving[p] && this->Constrained.freedom(point) != Freedom::None &&
      this->Cells.starts()[p + 1] > this->Cells.starts()[p])
    {
      this->Local[p] = static_cast<std::int32_t>(this->Moving.size());
      this->Moving.push_back(point);
      flags[p] = 1;
    }
  }
  this->Cells.flagCells(flags, near);
  this->Near.clear();
  for (std::size_t c = 0; c < near.size(); ++c)
  {
    if (near[c])
    {
      this->Near.push_back(static_cast<std::int32_t>(c));
    }
  }
  this->Boundary.select(flags);
  this->Shortest = this->Cells.shortestEdges(this->X);
}

/// Selects the points of the cells in the window, and the points beyond their bounds.
bool MovingBarrier::selectNear()
{
  std::vector<char> cells(this->Worst.size()), moving(this->X.size(), 0);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    cells[c] = this->Worst[c] < this->Threshold;
  }
  this->Cells.flagPoints(cells, moving);
  this->Boundary.flagBeyond(moving);
  this->indexPoints(moving);
  return !this->Moving.empty();
}

//------------------------------------------------------------------------------
double MovingBarrier::energy(const std::vector<Vec3>& x) const
{
  const auto count = static_cast<Index>(this->Near.size());
  std::vector<double> ofCells(this->Near.size());
  const double scale = 1.0 / (this->Threshold - this->Low);
  parallelFor(count, cellsOfChunk, this->Options.threads,
    [&](Index i)
    {
      Values values;
      this->valuesOf(this->Near[i], x, this->leastDeterminant(this->Near[i], x), values);
      double sum = 0;
      for (int k = 0; k < values.count; ++k)
      {
        const double u = (values.s[k] - this->Low) * scale;
        sum += u > 0 ? Barrier(u).value : std::numeric_limits<double>::infinity();
      }
      ofCells[i] = sum;
    });
  double sum = 0;
  for (const double value : ofCells)
  {
    sum += value;
  }
  return std::isfinite(sum) ? sum + this->Boundary.value(x)
                            : std::numeric_limits<double>::infinity();
}

//------------------------------------------------------------------------------
/// The shape of a corner as a function of its points has a curvature that the product of gradients
/// lacks: about (s + 0.3) / |edge|^2 along each edge.
void MovingBarrier::addCell(std::size_t index, QuadraticModel& model) const
{
  const SlidingCells::Cell& cell = this->Cells.cells()[index];
  const CellTopology& t = *cell.t;
  Vec3 vertices[MaxNodes];
  this->Cells.load(cell, this->X, vertices);
  const double scale = 1.0 / (this->Threshold - this->Low);
  const auto local = [&](int node) { return this->Local[cell.nodes[node]]; };
  const auto addEdge = [&](int a, int b, double slope, double s)
  {
    const Vec3 edge = vertices[b] - vertices[a];
    const double size = std::abs(slope) * (std::max(s, 0.0) + curvatureOfPerfect);
    model.addEdge(local(a), local(b), size / std::max(dot(edge, edge), 1e-300));
  };
  for (int corner = 0; corner < this->cornersOf(t); ++corner)
  {
    if (!this->canMove(index, corner))
    {
      continue;
    }
    const CornerValue at =
      measureCorner(t, corner, this->edgesAt(cell, corner, vertices), this->Options.measure, true);
    if (at.value >= this->Threshold)
    {
      continue;
    }
    const Barrier b((at.value - this->Low) * scale);
    const std::array<int, 4>& nodes = t.cornerNodes[corner];
    std::array<std::int32_t, 4> points = { local(nodes[0]), -1, -1, -1 };
    std::array<Vec3, 4> vectors = {};
    for (int k = 0; k < t.dimension; ++k)
    {
      points[k + 1] = local(nodes[k + 1]);
      vectors[k + 1] = at.gradient[k];
      vectors[0] -= at.gradient[k];
    }
    for (int k = 0; k <= t.dimension; ++k)
    {
      model.addGradient(points[k], b.first * scale * vectors[k]);
    }
    model.addRankOne(t.dimension + 1, points.data(), vectors.data(), b.second * scale * scale);
    for (int k = 0; k < t.dimension; ++k)
    {
      addEdge(nodes[0], nodes[k + 1], b.first * scale, at.value);
    }
  }
  const std::vector<DeterminantPlace>& places = determinantPlaces(t.type);
  for (std::size_t i = 0; i < places.size() && this->Least[index] < this->Threshold; ++i)
  {
    const DeterminantPlace& place = places[i];
    if (!this->canMove(index, MaxNodes + static_cast<int>(i)))
    {
      continue;
    }
    Vec3 gradient[MaxNodes];
    const double unit = this->Cells.sign() / this->Units[index];
    const double s = unit * determinantAt(t, place, vertices, this->Cells.normal(), gradient);
    if (s >= this->Threshold)
    {
      continue;
    }
    const Barrier b((s - this->Low) * scale);
    std::array<std::int32_t, MaxNodes> points;
    for (int k = 0; k < t.nodes; ++k)
    {
      points[k] = local(k);
      gradient[k] = unit * gradient[k];
      model.addGradient(points[k], b.first * scale * gradient[k]);
    }
    model.addRankOne(t.nodes, points.data(), gradient, b.second * scale * scale);
    for (int e = 0; e < t.edges; ++e)
    {
      addEdge(t.edgeNodes[e][0], t.edgeNodes[e][1], b.first * scale, s);
    }
  }
}

//------------------------------------------------------------------------------
void MovingBarrier::linearize(QuadraticModel& model) const
{
  model.start(this->Moving.size());
  for (std::size_t i = 0; i < this->Moving.size(); ++i)
  {
    model.setFreedom(static_cast<std::int32_t>(i), this->Constrained.freedom(this->Moving[i]),
      this->Constrained.direction(this->Moving[i]));
  }
  for (const std::int32_t cell : this->Near)
  {
    if (this->Worst[cell] < this->Threshold)
    {
      this->addCell(cell, model);
    }
  }
  this->Boundary.add(this->Local, model);
}

//------------------------------------------------------------------------------
/// Moves the points; `x` receives the previous ones.
void MovingBarrier::moveTo(std::vector<Vec3>& x)
{
  std::vector<double> least(this->Near.size());
  for (std::size_t i = 0; i < least.size(); ++i)
  {
    least[i] = this->leastDeterminant(this->Near[i], x);
  }
  this->Boundary.moveTo(x);
  this->X.swap(x);
  parallelFor(static_cast<Index>(this->Near.size()), cellsOfChunk, this->Options.threads,
    [&](Index i) { this->measure(this->Near[i], least[i]); });
}

//------------------------------------------------------------------------------
/// One step; false if no step reduces the energy sufficiently.
bool MovingBarrier::step()
{
  constexpr int trials = 6, halvings = 8;
  constexpr double enough = 1e-4, good = 0.75, poor = 0.25, worthwhile = 1e-3;
  constexpr double leastDamping = 1e-8, mostDamping = 1e6;
  QuadraticModel model;
  this->linearize(model);
  const double before = this->energy(this->X);
  std::vector<Vec3> d;
  std::vector<double> damping(this->Moving.size());
  for (int trial = 0; trial < trials && this->Damping < mostDamping; ++trial)
  {
    for (std::size_t i = 0; i < damping.size(); ++i)
    {
      const double h = this->Shortest[this->Moving[i]];
      damping[i] = this->Damping * model.sizeOf(i) + leastDamping / (h * h);
    }
    const double promised = model.solve(damping, SolutionLimits(), d);
    if (!(promised < 0))
    {
      return false;
    }
    for (std::size_t i = 0; i < d.size(); ++i)
    {
      const double most = longestStep * this->Shortest[this->Moving[i]], length = norm(d[i]);
      d[i] = length > most ? (most / length) * d[i] : d[i];
    }
    double t = 1;
    for (int half = 0; half <= halvings; ++half, t *= 0.5)
    {
      std::vector<Vec3> x = this->X;
      for (std::size_t i = 0; i < d.size(); ++i)
      {
        x[this->Moving[i]] += t * d[i];
      }
      const double now = this->energy(x);
      if (now < before + enough * t * promised)
      {
        this->moveTo(x);
        // A step shortened by the barrier is no evidence against the model: more damping would slow
        // down points far from the barrier.
        constexpr int fewHalvings = 1;
        const double ratio = (now - before) / (t * promised);
        this->Damping *= ratio < poor ? 3.0 : ratio > good && half <= fewHalvings ? 0.3 : 1.0;
        this->Damping = std::max(this->Damping, leastDamping);
        return before - now > worthwhile * before;
      }
    }
    this->Damping *= 10;
  }
  return false;
}

//------------------------------------------------------------------------------
void MovingBarrier::run(const std::function<bool(const std::vector<Vec3>&)>& accept)
{
  constexpr double worthChecking = 0.1; // of the window
  std::vector<Vec3> best = this->X;
  double bestWorst = this->worst();
  double window = firstWindow;
  int poor = 0;
  constexpr double mostDamping = 1e3;
  this->Boundary.allowWhatIs();
  // If the start is beyond its bounds, any improvement is accepted until the points are within.
  bool bestWithin = this->Boundary.isWithin();
  while (window > lastWindow && this->Steps < this->Options.steps)
  {
    throwIfInterrupted();
    const double worst = this->worst();
    this->Low = worst - belowWorst * window;
    this->Threshold = worst + window;
    if (!this->selectNear())
    {
      break;
    }
    this->Damping = std::min(this->Damping, mostDamping);
    for (int k = 0; k < stepsOfRound; ++k)
    {
      ++this->Steps;
      if (!this->step())
      {
        break;
      }
    }
    const double now = this->worst();
    const bool within = this->Boundary.isWithin();
    if (!within)
    {
      this->Boundary.strengthen(strongerBounds);
    }
    const bool worthIt =
      now > bestWorst + worthChecking * window || (within && !bestWithin && now > 0);
    if ((within || !bestWithin) && worthIt && accept(this->X))
    {
      best = this->X;
      bestWorst = now;
      bestWithin = within;
      this->Boundary.allowWhatIs();
    }
    poor = now - worst < poorGain * window ? poor + 1 : 0;
    if (poor >= poorRounds)
    {
      poor = 0;
      window *= narrower;
    }
    const bool enough = bestWithin && bestWorst >= this->Options.enough;
    if ((this->Options.proceed && !this->Options.proceed(now)) || enough)
    {
      break;
    }
  }
  if (this->worst() > bestWorst + worthChecking * lastWindow && this->Boundary.isWithin() &&
    accept(this->X))
  {
    return;
  }
  this->X = best;
  this->Boundary.select(std::vector<char>(best.size(), 1));
  this->Boundary.moveTo(best);
  this->measureAll();
}

//------------------------------------------------------------------------------
void MovingBarrier::selectAll()
{
  this->indexPoints(std::vector<char>(this->X.size(), 1));
}

double MovingBarrier::energyWith(double low, double threshold)
{
  this->Low = low;
  this->Threshold = threshold;
  this->selectAll();
  this->measureAll();
  return this->energy(this->X);
}

void MovingBarrier::modelWith(double low, double threshold, QuadraticModel& model)
{
  this->energyWith(low, threshold);
  this->linearize(model);
}
}
