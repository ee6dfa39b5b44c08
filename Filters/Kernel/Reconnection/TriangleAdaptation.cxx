// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleAdaptation.h"

#include "Constants.h"
#include "UnitFrame.h"
#include "tautline/Core/Interruption.h"

#include <limits>
#include <tuple>

namespace tautline
{
namespace
{
constexpr double ShortestEdge = 1.0 / TriangleAdaptation::LongestEdge;
/// The smallest allowed quality after a contraction or, if it was smaller before, the fraction of
/// that.
constexpr double LeastQuality = 0.4, LeastPart = 0.8;
/// The same for a split: it does not make triangles below this quality worse.
constexpr double LeastAfterSplit = 0.2;
/// Splits of longer edges may leave edges shorter than ShortestEdge, but at least the inverse:
/// between close walls, longer ones are impossible.
constexpr double MuchTooLong = 2.0;
/// The number of sweeps over all points in a round.
constexpr int SweepsOfRound = 3;
/// A motion is made if it is at least this long in the metric, and decreases the energy by this
/// fraction.
constexpr double LeastMotion = 0.01, LeastEnergyGain = 1e-3;
/// The number of motions of the remaining or new point if the change alone is not good enough.
constexpr int MotionsAfterChange = 3;
/// The number of trials of a motion, each half as long as the previous one.
constexpr int MotionTrials = 3;
/// The number of operations between two calls of `proceed`.
constexpr Index StepsBetweenChecks = 256;
/// Edges are coded in 31 bits.
constexpr Index MaxTriangles = std::numeric_limits<std::int32_t>::max() / 8;
/// For the unit triangle: twice its area, squared.
constexpr double UnitArea2 = 0.75;

/**
 * @brief The deviation of a triangle from the unit one: (2 S / 3) (1 + 3 / (4 D^2)) - 4, with the
 * sum S of the squared edges and twice the area D in the metric. With the matrix T that maps the
 * unit triangle to it, this is |T|^2 + |T^-1|^2 - 4: 0 for the unit triangle, infinite for flat
 * ones. As a function of a vertex, with gradient and second derivatives.
 */
struct UnitEnergy
{
  double value = 0;
  double g[2] = { 0, 0 };
  double h[3] = { 0, 0, 0 }; ///< xx xy yy

  static double of(double sum, double area2)
  {
    return area2 > 0.0 ? 2.0 / 3.0 * sum * (1.0 + UnitArea2 / (area2 * area2)) - 4.0
                       : std::numeric_limits<double>::infinity();
  }

  /// @param u, v the other corners, relative to the vertex
  void add(const Vec3& u, const Vec3& v, const PlaneTensor& m)
  {
    const auto applied = [&m](const Vec3& e) {
      return Vec2{ m[0] * e[0] + m[1] * e[1], m[1] * e[0] + m[2] * e[1] };
    };
    const Vec3 w = v - u;
    const Vec2 mu = applied(u), mv = applied(v), mw = applied(w);
    const double root = std::sqrt(std::max(m[0] * m[2] - m[1] * m[1], 0.0));
    const double d = root * (u[0] * v[1] - u[1] * v[0]);
    const double s =
      u[0] * mu[0] + u[1] * mu[1] + v[0] * mv[0] + v[1] * mv[1] + w[0] * mw[0] + w[1] * mw[1];
    this->value += of(s, d);
    const double d2 = d * d;
    const double f = 1.0 + UnitArea2 / d2, f1 = -2.0 * UnitArea2 / (d2 * d),
                 f2 = 6.0 * UnitArea2 / (d2 * d2);
    const double gs[2] = { -2.0 * (mu[0] + mv[0]), -2.0 * (mu[1] + mv[1]) };
    const double gd[2] = { -root * w[1], root * w[0] };
    for (int i = 0; i < 2; ++i)
    {
      this->g[i] += 2.0 / 3.0 * (gs[i] * f + s * f1 * gd[i]);
      for (int j = i; j < 2; ++j)
      {
        this->h[i + j] += 2.0 / 3.0 *
          (4.0 * m[i + j] * f + f1 * (gs[i] * gd[j] + gs[j] * gd[i]) + s * f2 * gd[i] * gd[j]);
      }
    }
  }

  /// Newton's step; along the gradient if that is not a descent direction.
  Vec3 step() const
  {
    const double determinant = this->h[0] * this->h[2] - this->h[1] * this->h[1];
    const double x = (this->h[1] * this->g[1] - this->h[2] * this->g[0]) / determinant;
    const double y = (this->h[1] * this->g[0] - this->h[0] * this->g[1]) / determinant;
    if (determinant > 0.0 && x * this->g[0] + y * this->g[1] < 0.0)
    {
      return { x, y, 0.0 };
    }
    const double size = std::abs(this->h[0]) + std::abs(this->h[2]);
    return { -this->g[0] / size, -this->g[1] / size, 0.0 };
  }
  /// The same along a unit direction.
  double stepAlong(const Vec3& d) const
  {
    const double slope = d[0] * this->g[0] + d[1] * this->g[1];
    const double curvature =
      d[0] * d[0] * this->h[0] + 2.0 * d[0] * d[1] * this->h[1] + d[1] * d[1] * this->h[2];
    const double size = std::abs(this->h[0]) + std::abs(this->h[2]);
    return -slope / (curvature > 0.0 ? curvature : size);
  }
};

MetricTensor meanOf(const MetricTensor& a, const MetricTensor& b, const MetricTensor& c)
{
  MetricTensor mean;
  for (std::size_t k = 0; k < mean.size(); ++k)
  {
    mean[k] = (a[k] + b[k] + c[k]) / 3.0;
  }
  return mean;
}

/// Heaps have the largest entry first: the longest edge, or the first of equal ones.
constexpr auto LongestFirst = [](const auto& a, const auto& b)
{
  return std::make_tuple(a.length, b.low, b.high, b.triangle) <
    std::make_tuple(b.length, a.low, a.high, a.triangle);
};
constexpr auto ShortestFirst = [](const auto& a, const auto& b)
{
  return std::make_tuple(b.length, b.low, b.high, b.triangle) <
    std::make_tuple(a.length, a.low, a.high, a.triangle);
};
constexpr auto IsLong = [](double length) { return length > TriangleAdaptation::LongestEdge; };
constexpr auto IsShort = [](double length) { return length < ShortestEdge; };
}

bool TriangleAdaptation::goesOn()
{
  return ++this->Steps % StepsBetweenChecks != 0 || !this->proceed || this->proceed();
}

//------------------------------------------------------------------------------
/// The edge, once for both sides; false for the other side.
bool TriangleAdaptation::makeEdge(TriId t, int i, Edge& edge) const
{
  const Triangle& triangle = this->Mesh.triangle(t);
  const std::int32_t n = triangle.neighbors[i];
  if (n != NoNumber && n >> 2 < t)
  {
    return false;
  }
  const VertexId a = triangle.vertices[Next[i]], b = triangle.vertices[Previous[i]];
  edge = { this->Mesh.length(a, b), std::min(a, b), std::max(a, b), t, i };
  return true;
}

/// Whether it is still the edge that was put on the heap.
bool TriangleAdaptation::isStill(const Edge& edge) const
{
  if (edge.triangle >= this->Mesh.slots() || !this->Mesh.alive(edge.triangle))
  {
    return false;
  }
  const Corners& v = this->Mesh.triangle(edge.triangle).vertices;
  const VertexId a = v[Next[edge.side]], b = v[Previous[edge.side]];
  return std::min(a, b) == edge.low && std::max(a, b) == edge.high;
}

template <class Wanted>
void TriangleAdaptation::collect(const Wanted& wanted)
{
  this->Edges.clear();
  Edge edge;
  for (TriId t = 0; t < this->Mesh.slots(); ++t)
  {
    pollInterruption(t);
    for (int i = 0; this->Mesh.alive(t) && i < 3; ++i)
    {
      if (this->makeEdge(t, i, edge) && wanted(edge.length))
      {
        this->Edges.push_back(edge);
      }
    }
  }
}

/// Puts edges of changed triangles on the heap.
template <class Less, class Wanted>
void TriangleAdaptation::pushChanged(const Less& less, const Wanted& wanted)
{
  std::sort(this->Changed.begin(), this->Changed.end());
  this->Changed.erase(std::unique(this->Changed.begin(), this->Changed.end()), this->Changed.end());
  for (TriId t : this->Changed)
  {
    for (int i = 0; this->Mesh.alive(t) && i < 3; ++i)
    {
      // Check from both sides: the other triangle may not be among the changed ones.
      const Corners& v = this->Mesh.triangle(t).vertices;
      const VertexId a = v[Next[i]], b = v[Previous[i]];
      const double length = this->Mesh.length(a, b);
      if (wanted(length))
      {
        this->Edges.push_back({ length, std::min(a, b), std::max(a, b), t, i });
        std::push_heap(this->Edges.begin(), this->Edges.end(), less);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Flips the edges opposite a point, and edges that become opposite to it.
void TriangleAdaptation::flipAround(VertexId p)
{
  this->Mesh.star(p, this->Stack);
  this->Changed.insert(this->Changed.end(), this->Stack.begin(), this->Stack.end());
  while (this->flips && !this->Stack.empty())
  {
    const TriId t = this->Stack.back();
    this->Stack.pop_back();
    const int i = this->Mesh.indexOf(t, p);
    const std::int32_t n = this->Mesh.triangle(t).neighbors[i];
    if (this->Mesh.triangle(t).vertices[i] == p && this->Operations.flip(t, i))
    {
      this->Stack.insert(this->Stack.end(), { t, n >> 2 });
      this->Changed.push_back(n >> 2);
    }
  }
}

/// Whether the triangles of the transaction may stay; they are `Changed`.
template <class Unwanted>
bool TriangleAdaptation::isGoodAround(VertexId p, const Unwanted& unwanted, const Bounds& bounds)
{
  this->Mesh.compare(this->Changed, this->Before);
  const double before = *std::min_element(this->Before.begin(), this->Before.end());
  const double least = std::min(bounds.quality, bounds.part * before);
  this->Mesh.star(p, this->Around);
  return std::all_of(this->Changed.begin(), this->Changed.end(),
           [&](TriId s)
           {
             const Triangle& triangle = this->Mesh.triangle(s);
             return triangle.quality >= least && triangle.quality > 0.0 &&
               this->Operations.accepts(triangle.vertices, triangle.origin);
           }) &&
    std::all_of(this->Around.begin(), this->Around.end(),
      [&](TriId s)
      {
        const Corners& v = this->Mesh.triangle(s).vertices;
        return std::all_of(v.begin(), v.end(),
          [&](VertexId u) { return u == p || !unwanted(this->Mesh.length(u, p)); });
      });
}

/**
 * @brief Carries out a change, then flips around a point and moves it; keeps this only if no
 * triangle becomes bad and no edge of the point gets an unwanted length.
 * @param change returns the point; negative if it is not possible
 */
template <class Change, class Unwanted>
bool TriangleAdaptation::changeAndMove(
  const Change& change, const Unwanted& unwanted, const Bounds& bounds, Index& counter)
{
  const TriangleOperations::Counts counts = this->Operations.counters();
  this->Mesh.begin();
  const VertexId p = change();
  if (p != NoNumber)
  {
    this->Mesh.star(p, this->Around);
    if (std::all_of(this->Around.begin(), this->Around.end(),
          [this](TriId s) { return this->Mesh.quality(s) > 0.0; }))
    {
      this->flipAround(p);
      for (int k = 0; k < MotionsAfterChange && this->moves && this->move(p); ++k)
      {
        this->flipAround(p);
      }
      if (this->isGoodAround(p, unwanted, bounds))
      {
        this->Mesh.commit();
        ++counter;
        this->Operations.touch(this->Changed);
        return true;
      }
    }
  }
  this->Mesh.undo();
  this->Operations.counters() = counts;
  return false;
}

/// The point that would divide an edge.
TriangleAdaptation::Middle TriangleAdaptation::middleOf(TriId t, int i) const
{
  const Triangle& triangle = this->Mesh.triangle(t);
  const VertexId first = triangle.vertices[Next[i]], last = triangle.vertices[Previous[i]];
  const Vec3 a = this->Mesh.point(first), b = this->Mesh.point(last);
  Middle middle;
  middle.x = a + this->Operations.middleOf(first, last) * (b - a);
  if (this->Mesh.isWall(t, i))
  {
    middle.freedom = { PointFreedom::OnLine, (1.0 / norm(b - a)) * (b - a) };
  }
  else if (!this->Input.planar)
  {
    middle.x = this->Input.surface.closest(middle.x, this->Operations.patchOf(t));
  }
  middle.metric = this->Operations.field->at(middle.x, this->Mesh.metric(first).place);
  return middle;
}

/**
 * @brief The smaller quality of the parts of a triangle that is divided at a point of its edge i;
 * negative if the new edge is shorter than `least`, or the surface does not allow them.
 */
double TriangleAdaptation::qualityOfHalves(TriId t, int i, const Middle& middle, double least) const
{
  const Corners& v = this->Mesh.triangle(t).vertices;
  std::array<Vec3, 3> x;
  std::array<const MetricTensor*, 3> metrics;
  for (int k = 0; k < 3; ++k)
  {
    x[k] = this->Mesh.point(v[k]);
    metrics[k] = &this->Mesh.metric(v[k]).tensor;
  }
  if (edgeLength(x[i] - middle.x, middle.metric.tensor, *metrics[i]) < least)
  {
    return -1.0;
  }
  double quality = 1.0;
  for (const int k : { Next[i], Previous[i] })
  {
    std::array<Vec3, 3> half = x;
    std::array<const MetricTensor*, 3> ofHalf = metrics;
    half[k] = middle.x;
    ofHalf[k] = &middle.metric.tensor;
    quality = std::min(quality, this->Mesh.qualityOf(half, ofHalf));
    if (!this->Input.planar &&
      !this->Input.surface.accepts(half[0], half[1], half[2], this->Operations.patchOf(t)))
    {
      return -1.0;
    }
  }
  return quality;
}

VertexId TriangleAdaptation::divide(TriId t, int i, const Middle& middle)
{
  const VertexId p = this->Mesh.splitEdge(t, i, middle.x, &middle.metric);
  this->Operations.freedoms.resize(this->Mesh.pointSlots());
  this->Operations.freedoms[p] = middle.freedom;
  return p;
}

bool TriangleAdaptation::split(TriId t, int i)
{
  if (!this->Operations.mayDivide(t, i))
  {
    return false;
  }
  const Triangle& triangle = this->Mesh.triangle(t);
  const double length =
    this->Mesh.length(triangle.vertices[Next[i]], triangle.vertices[Previous[i]]);
  const double least = 1.0 / length;
  const Middle middle = this->middleOf(t, i);
  const std::int32_t n = triangle.neighbors[i];
  double before = triangle.quality, after = this->qualityOfHalves(t, i, middle, least);
  if (n != NoNumber)
  {
    before = std::min(before, this->Mesh.quality(n >> 2));
    after = std::min(after, this->qualityOfHalves(n >> 2, n & 3, middle, least));
  }
  Index& counter = this->Operations.counters().insertions;
  if (!(after >= std::min(LeastAfterSplit, before)))
  {
    const double shortest = length > MuchTooLong ? least : ShortestEdge;
    return this->changeAndMove([&] { return this->divide(t, i, middle); },
      [shortest](double x) { return x < shortest; }, { LeastAfterSplit, 1.0 }, counter);
  }
  ++counter;
  this->Changed.clear();
  this->flipAround(this->divide(t, i, middle));
  this->Operations.touch(this->Changed);
  return true;
}

bool TriangleAdaptation::splitAll()
{
  this->collect(IsLong);
  std::make_heap(this->Edges.begin(), this->Edges.end(), LongestFirst);
  while (!this->Edges.empty())
  {
    std::pop_heap(this->Edges.begin(), this->Edges.end(), LongestFirst);
    const Edge edge = this->Edges.back();
    this->Edges.pop_back();
    if (!this->goesOn())
    {
      return false;
    }
    if (this->isStill(edge) && this->Mesh.size() < MaxTriangles &&
      this->split(edge.triangle, edge.side))
    {
      this->pushChanged(LongestFirst, IsLong);
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// Whether vertex i may move to the position of vertex j.
bool TriangleAdaptation::mayMoveInto(TriId t, int i, int j) const
{
  const PointFreedom& freedom = this->Operations.freedoms[this->Mesh.triangle(t).vertices[i]];
  return freedom.kind == PointFreedom::Free ||
    (freedom.kind == PointFreedom::OnLine && this->Mesh.isWall(t, 3 - i - j));
}

/// The result of contracting vertex i into vertex j.
TriangleAdaptation::Contraction TriangleAdaptation::tryContraction(TriId t, int i, int j)
{
  Contraction result;
  if (!this->mayMoveInto(t, i, j))
  {
    return result;
  }
  const VertexId v = this->Mesh.triangle(t).vertices[i], w = this->Mesh.triangle(t).vertices[j];
  this->Mesh.star(v, this->Around);
  double before = 1.0, after = 1.0;
  for (TriId s : this->Around)
  {
    const Triangle& triangle = this->Mesh.triangle(s);
    Corners c = triangle.vertices;
    before = std::min(before, triangle.quality);
    if (c[0] == w || c[1] == w || c[2] == w)
    {
      continue;
    }
    std::replace(c.begin(), c.end(), v, w);
    const int k = this->Mesh.indexOf(s, v);
    for (const int side : { Next[k], Previous[k] })
    {
      // The second end of the one triangle is the first of the other, except at borders.
      if (side == Next[k] || this->Mesh.isBorder(s, Next[k]))
      {
        result.longest = std::max(result.longest, this->Mesh.length(w, c[side]));
      }
    }
    after = std::min(after, this->Mesh.qualityOf(c));
    if (result.longest > LongestEdge || !(after >= std::min(LeastQuality, LeastPart * before)) ||
      !(after > 0.0) || !this->Operations.accepts(c, triangle.origin))
    {
      return result;
    }
  }
  result.quality = after;
  return result;
}

bool TriangleAdaptation::contract(TriId t, int i)
{
  const int j = Next[i], k = Previous[i];
  const Contraction first = this->tryContraction(t, j, k), second = this->tryContraction(t, k, j);
  const bool swapped = second.quality > first.quality;
  for (const bool other : { swapped, !swapped })
  {
    const int from = other ? k : j, to = other ? j : k;
    const VertexId w = this->Mesh.triangle(t).vertices[to];
    if (!((other ? second : first).quality > 0.0) || !this->Mesh.contract(t, from, to))
    {
      continue;
    }
    ++this->Operations.counters().contractions;
    this->Changed.clear();
    this->flipAround(w);
    this->Operations.touch(this->Changed);
    return true;
  }
  return this->contractAndMove(t, j, k) || this->contractAndMove(t, k, j);
}

/// Contracts vertex i into vertex j, and then moves this one to a position where its edges are not
/// too long, if possible.
bool TriangleAdaptation::contractAndMove(TriId t, int i, int j)
{
  const VertexId w = this->Mesh.triangle(t).vertices[j];
  return this->mayMoveInto(t, i, j) &&
    this->changeAndMove([&] { return this->Mesh.contract(t, i, j) ? w : NoNumber; }, IsLong,
      { LeastQuality, LeastPart }, this->Operations.counters().contractions);
}

bool TriangleAdaptation::contractAll()
{
  this->collect(IsShort);
  std::make_heap(this->Edges.begin(), this->Edges.end(), ShortestFirst);
  while (!this->Edges.empty())
  {
    std::pop_heap(this->Edges.begin(), this->Edges.end(), ShortestFirst);
    const Edge edge = this->Edges.back();
    this->Edges.pop_back();
    if (!this->goesOn())
    {
      return false;
    }
    if (this->isStill(edge) && this->contract(edge.triangle, edge.side))
    {
      this->pushChanged(ShortestFirst, IsShort);
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// Flips edges where anything has changed since the last call.
bool TriangleAdaptation::flipAll()
{
  this->Stack.clear();
  for (TriId t = this->Mesh.slots() - 1; t >= 0; --t)
  {
    const Corners& v = this->Mesh.triangle(t).vertices;
    if (this->Mesh.alive(t) &&
      std::any_of(v.begin(), v.end(),
        [this](VertexId w) { return this->Operations.stamp(w) >= this->Flipped; }))
    {
      this->Stack.push_back(t);
    }
  }
  while (!this->Stack.empty())
  {
    const TriId t = this->Stack.back();
    this->Stack.pop_back();
    if (!this->goesOn())
    {
      return false;
    }
    for (int i = 0; i < 3; ++i)
    {
      const std::int32_t n = this->Mesh.triangle(t).neighbors[i];
      if (this->Operations.flip(t, i))
      {
        this->Stack.insert(this->Stack.end(), { n >> 2, t });
        break;
      }
    }
  }
  this->Flipped = this->Operations.clock() + 1;
  return true;
}

//------------------------------------------------------------------------------
/// The energy of the triangles `Around` with the point at x; infinite if one is inverted.
double TriangleAdaptation::energyAround(VertexId v, const Vec3& x, const PointMetric& metric) const
{
  double sum = 0.0;
  for (TriId t : this->Around)
  {
    const Corners& c = this->Mesh.triangle(t).vertices;
    const int k = this->Mesh.indexOf(t, v);
    const VertexId b = c[Next[k]], d = c[Previous[k]];
    const MetricTensor m =
      meanOf(metric.tensor, this->Mesh.metric(b).tensor, this->Mesh.metric(d).tensor);
    const Vec3 u = this->Mesh.point(b) - x, w = this->Mesh.point(d) - x;
    const double uu = squaredLength(u, m), ww = squaredLength(w, m),
                 opposite = squaredLength(w - u, m);
    double area2 = 0.0;
    if (this->Input.planar)
    {
      const double area = u[0] * w[1] - u[1] * w[0];
      area2 = area * std::sqrt(std::max(m[0] * m[1] - m[3] * m[3], 0.0));
    }
    else
    {
      const double uw = 0.5 * (uu + ww - opposite);
      area2 = std::sqrt(std::max(uu * ww - uw * uw, 0.0));
    }
    sum += UnitEnergy::of(uu + ww + opposite, area2);
  }
  return sum;
}

bool TriangleAdaptation::move(VertexId v)
{
  const PointFreedom::Kind kind = this->Operations.freedoms[v].kind;
  if (!this->Mesh.used(v) || kind == PointFreedom::Fixed)
  {
    return false;
  }
  this->Mesh.star(v, this->Around);
  const TriangleStar::Directions frame = this->Operations.directionsAt(v, this->Around);
  const Vec3 start = this->Mesh.point(v);
  const PointMetric before = this->Mesh.metric(v);
  const UnitFrame unit(before.tensor, frame.first, frame.second);
  UnitEnergy energy;
  for (TriId t : this->Around)
  {
    const Corners& c = this->Mesh.triangle(t).vertices;
    const int k = this->Mesh.indexOf(t, v);
    const VertexId b = c[Next[k]], d = c[Previous[k]];
    energy.add(unit.leave(this->Mesh.point(b) - start), unit.leave(this->Mesh.point(d) - start),
      unit.turned(meanOf(before.tensor, this->Mesh.metric(b).tensor, this->Mesh.metric(d).tensor)));
  }
  Vec3 step = energy.step();
  if (frame.count == 1)
  {
    const Vec3 along = unit.leave(frame.first);
    step = energy.stepAlong((1.0 / norm(along)) * along) / norm(along) * frame.first;
  }
  else
  {
    const double size = norm(step);
    step = unit.enter(size > 1.0 ? (1.0 / size) * step : step);
  }
  const double length = std::sqrt(squaredLength(step, before.tensor));
  if (!(length > LeastMotion))
  {
    return false;
  }
  const double value = this->energyAround(v, start, before);
  double part = 1.0;
  for (int trial = 0; trial < MotionTrials && part * length > LeastMotion; ++trial, part *= 0.5)
  {
    Vec3 x = start + part * step;
    if (!this->Input.planar && kind != PointFreedom::OnLine)
    {
      x = this->Input.surface.closest(x, this->Operations.patchOf(this->Around.front()));
    }
    // Check with the former metric first: an inverted triangle would be outside the mesh.
    if (this->Input.planar && !std::isfinite(this->energyAround(v, x, before)))
    {
      continue;
    }
    const PointMetric metric = this->Operations.field->at(x, before.place);
    if (!(this->energyAround(v, x, metric) < value * (1.0 - LeastEnergyGain)))
    {
      continue;
    }
    this->Mesh.movePoint(v, x, this->Around, &metric);
    if (std::all_of(this->Around.begin(), this->Around.end(),
          [this](TriId t)
          {
            const Triangle& triangle = this->Mesh.triangle(t);
            return triangle.quality > 0.0 &&
              this->Operations.accepts(triangle.vertices, triangle.origin);
          }))
    {
      ++this->Operations.counters().moves;
      this->Operations.touch(this->Around);
      return true;
    }
    this->Mesh.movePoint(v, start, this->Around, &before);
  }
  return false;
}

bool TriangleAdaptation::moveAll()
{
  this->Still.resize(this->Mesh.pointSlots(), 0);
  for (int sweep = 0; sweep < SweepsOfRound; ++sweep)
  {
    for (VertexId v = 0; v < this->Mesh.pointSlots(); ++v)
    {
      if (!this->goesOn())
      {
        return false;
      }
      // Skip it while its surroundings have not changed.
      if (this->Mesh.used(v) && this->Operations.stamp(v) >= this->Still[v] && !this->move(v))
      {
        this->Still[v] = this->Operations.clock() + 1;
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------
double TriangleAdaptation::shareOfUnitEdges() const
{
  Index all = 0, unit = 0;
  Edge edge;
  for (TriId t = 0; t < this->Mesh.slots(); ++t)
  {
    for (int i = 0; this->Mesh.alive(t) && i < 3; ++i)
    {
      if (this->makeEdge(t, i, edge))
      {
        ++all;
        unit += !IsLong(edge.length) && !IsShort(edge.length);
      }
    }
  }
  return static_cast<double>(unit) / static_cast<double>(std::max<Index>(all, 1));
}

bool TriangleAdaptation::runRound()
{
  return (!this->splits || this->splitAll()) && (!this->contracts || this->contractAll()) &&
    (!this->flips || this->flipAll()) && (!this->moves || this->moveAll()) &&
    (!this->flips || this->flipAll());
}
}
