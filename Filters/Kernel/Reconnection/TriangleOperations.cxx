// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleOperations.h"

#include "Constants.h"
#include "UnitFrame.h"

#include <limits>

namespace tautline
{
namespace
{
/// The numbers of rounds of flips, and of flips and motions, after an insertion or a contraction.
constexpr int FlipRounds = 4, TidyRounds = 3;
constexpr int TidySteps = 2;
/// The maximum number of triangles visited on the path to a position.
constexpr int MaxWalk = 40;
/// Below this relative difference, the length of an edge is treated as equal in the metrics of both
/// ends.
constexpr double NearlyConstant = 1e-6;
/// The mean ratio is at least this many times the quality.
constexpr double LeastRatio = 1.1547005383792515; // 2 / sqrt(3)

Vec3 normalAround(const TriangleMesh& mesh, const std::vector<TriId>& triangles)
{
  Vec3 sum = { 0, 0, 0 };
  for (TriId t : triangles)
  {
    const Corners& v = mesh.triangle(t).vertices;
    const Vec3& a = mesh.point(v[0]);
    sum += cross(mesh.point(v[1]) - a, mesh.point(v[2]) - a);
  }
  const double length = norm(sum);
  return length > 0.0 ? (1.0 / length) * sum : Vec3{ 0, 0, 1 };
}
}

//------------------------------------------------------------------------------
bool TriangleOperations::accepts(const Corners& v, TriId origin) const
{
  const double q = this->Mesh.qualityOf(v);
  const auto x = [&](int k) -> const Vec3& { return this->Mesh.point(v[k]); };
  if (!(q > 0.0) ||
    (q * LeastRatio < this->leastMeanRatio &&
      measureTriangle(x(0), x(1), x(2), this->Input.planar).meanRatio < this->leastMeanRatio))
  {
    return false;
  }
  return this->Input.planar ||
    this->Input.surface.accepts(x(0), x(1), x(2), this->Input.patches[origin]);
}

void TriangleOperations::touch(const std::vector<TriId>& triangles)
{
  this->Stamps.resize(this->Mesh.pointSlots(), 0);
  ++this->Clock;
  for (TriId t : triangles)
  {
    for (VertexId v : this->Mesh.triangle(t).vertices)
    {
      this->Stamps[v] = this->Clock;
    }
  }
}

/// Compares the triangles of the transaction with the previous ones, in increasing order of
/// quality.
bool TriangleOperations::improves()
{
  const Index size = this->Mesh.size();
  this->Mesh.compare(this->Changed, this->Before);
  this->After.clear();
  for (TriId t : this->Changed)
  {
    this->After.push_back(this->Mesh.quality(t));
  }
  if (this->Before.empty() || this->After.empty() || size > this->largestSize ||
    size < this->smallestSize)
  {
    return false;
  }
  std::sort(this->Before.begin(), this->Before.end());
  std::sort(this->After.begin(), this->After.end());
  if (!(this->After.front() > this->Before.front() + this->leastGain))
  {
    return false;
  }
  return std::all_of(this->Changed.begin(), this->Changed.end(),
    [this](TriId t)
    { return this->accepts(this->Mesh.triangle(t).vertices, this->Mesh.triangle(t).origin); });
}

double TriangleOperations::squaredLengthOf(VertexId v, VertexId w) const
{
  if (this->field)
  {
    const double length = this->Mesh.length(v, w);
    return length * length;
  }
  return squaredLength(this->Mesh.point(v) - this->Mesh.point(w), this->Mesh.metric(v).tensor,
    this->Mesh.metric(w).tensor);
}

/// Whether the edges of the point of the operation are not too short (insertion) or too long
/// (contraction), after tidying up.
bool TriangleOperations::keepsLengths()
{
  if (!this->Mesh.hasMetrics())
  {
    return true;
  }
  const VertexId p = this->Centre;
  const double factor = this->edgeFactor * this->edgeFactor;
  this->Mesh.star(p, this->Near);
  for (TriId t : this->Near)
  {
    for (VertexId v : this->Mesh.triangle(t).vertices)
    {
      const double length = v == p ? 1.0 : this->squaredLengthOf(v, p);
      if (this->IsInsertion ? length * factor < 1.0 : length > factor)
      {
        return false;
      }
    }
  }
  return true;
}

/// Sets the freedom of a new point and, unless it has a metric, the mean of the surrounding
/// metrics.
void TriangleOperations::setPoint(
  VertexId p, const PointFreedom& freedom, const std::vector<VertexId>& around)
{
  this->freedoms.resize(this->Mesh.pointSlots());
  this->freedoms[p] = freedom;
  this->Centre = p;
  this->IsInsertion = true;
  if (!this->Mesh.hasMetrics() || this->field)
  {
    return;
  }
  PointMetric mean;
  for (VertexId v : around)
  {
    for (std::size_t k = 0; k < mean.tensor.size(); ++k)
    {
      mean.tensor[k] += this->Mesh.metric(v).tensor[k] / static_cast<double>(around.size());
    }
  }
  this->Mesh.setMetric(p, mean);
}

/// Carries out an operation, tidies up around it, and keeps it only if that is an improvement.
template <class Operation>
bool TriangleOperations::attempt(const Operation& operation, Index& counter)
{
  const Counts before = this->Count;
  this->Mesh.begin();
  if (operation())
  {
    this->tidy();
    if (this->keepsLengths() && this->improves())
    {
      this->Mesh.commit();
      ++counter;
      this->touch(this->Changed);
      return true;
    }
  }
  this->Mesh.undo();
  this->Count = before;
  return false;
}

//------------------------------------------------------------------------------
bool TriangleOperations::isBetterFlip(TriId t, int i)
{
  if (this->Mesh.isWall(t, i) || this->Mesh.triangle(t).region == OutsideRegion)
  {
    return false;
  }
  const Triangle& up = this->Mesh.triangle(t);
  const TriId n = up.neighbors[i] >> 2;
  const Triangle& down = this->Mesh.triangle(n);
  const VertexId a = up.vertices[i], b = up.vertices[Next[i]], c = up.vertices[Previous[i]];
  const VertexId d = down.vertices[up.neighbors[i] & 3];
  const Corners first = { a, b, d }, second = { a, d, c };
  const double before = std::min(up.quality, down.quality);
  const double after = std::min(this->Mesh.qualityOf(first), this->Mesh.qualityOf(second));
  return after > before * (1.0 + SameQuality) && this->accepts(first, up.origin) &&
    this->accepts(second, down.origin);
}

bool TriangleOperations::flip(TriId t, int i)
{
  if (!this->isBetterFlip(t, i))
  {
    return false;
  }
  const TriId n = this->Mesh.triangle(t).neighbors[i] >> 2;
  if (!this->Mesh.flip(t, i))
  {
    return false;
  }
  ++this->Count.flips;
  if (!this->Mesh.inTransaction())
  {
    this->Changed = { t, n };
    this->touch(this->Changed);
  }
  return true;
}

//------------------------------------------------------------------------------
TriangleStar::Directions TriangleOperations::directionsAt(
  VertexId v, const std::vector<TriId>& star) const
{
  TriangleStar::Directions directions;
  const Vec3 up = this->Input.planar ? Vec3{ 0, 0, 1 } : normalAround(this->Mesh, star);
  const PointFreedom& freedom = this->freedoms[v];
  if (freedom.kind == PointFreedom::OnLine)
  {
    directions.first = freedom.direction;
    directions.second = cross(up, freedom.direction);
    directions.count = 1;
  }
  else if (!this->Input.planar)
  {
    int least = 0;
    for (int k = 1; k < 3; ++k)
    {
      least = std::abs(up[k]) < std::abs(up[least]) ? k : least;
    }
    Vec3 axis = { 0, 0, 0 };
    axis[least] = 1.0;
    const Vec3 first = cross(up, axis);
    directions.first = (1.0 / norm(first)) * first;
    directions.second = cross(up, directions.first);
  }
  return directions;
}

/// Finds the position of a point that maximizes the smallest surrounding sine; `Around` is its
/// star.
bool TriangleOperations::maximizeAround(VertexId v, int steps, Vec3& x, double& before)
{
  this->Star.clear();
  for (TriId t : this->Around)
  {
    const Corners& c = this->Mesh.triangle(t).vertices;
    const int k = this->Mesh.indexOf(t, v);
    this->Star.addEdge(this->Mesh.point(c[Next[k]]), this->Mesh.point(c[Previous[k]]));
  }
  const TriangleStar::Directions directions = this->directionsAt(v, this->Around);
  std::function<Vec3(const Vec3&)> project;
  if (!this->Input.planar && this->freedoms[v].kind != PointFreedom::OnLine)
  {
    const int patch = this->patchOf(this->Around.front());
    project = [this, patch](const Vec3& y) { return this->Input.surface.closest(y, patch); };
  }
  before = this->Star.evaluate(x, directions.normal());
  return this->Star.maximize(x, steps, directions, project) > before + this->leastGain;
}

/// The same for the smallest mean ratio in the metrics, which are fixed: in coordinates of the
/// plane or tangent plane in which the metric of the point is the identity.
bool TriangleOperations::maximizeInMetrics(VertexId v, int steps, Vec3& x, double& before)
{
  const TriangleStar::Directions frame = this->directionsAt(v, this->Around);
  const UnitFrame unit(this->Mesh.metric(v).tensor, frame.first, frame.second);
  this->Star.clear();
  before = std::numeric_limits<double>::max();
  for (TriId t : this->Around)
  {
    const Triangle& triangle = this->Mesh.triangle(t);
    const Corners& c = triangle.vertices;
    const int k = this->Mesh.indexOf(t, v);
    MetricTensor mean = {};
    for (std::size_t i = 0; i < mean.size(); ++i)
    {
      for (VertexId w : c)
      {
        mean[i] += this->Mesh.metric(w).tensor[i] / 3.0;
      }
    }
    this->Star.addEdge(unit.leave(this->Mesh.point(c[Next[k]]) - x),
      unit.leave(this->Mesh.point(c[Previous[k]]) - x), unit.turned(mean));
    before = std::min(before, triangle.quality);
  }
  TriangleStar::Directions directions;
  directions.count = frame.count;
  if (frame.count == 1)
  {
    const Vec3 along = unit.leave(frame.first);
    directions.first = (1.0 / norm(along)) * along;
    directions.second = { -directions.first[1], directions.first[0], 0.0 };
  }
  Vec3 place = { 0, 0, 0 };
  const double start = this->Star.evaluate(place, directions.normal());
  if (!(this->Star.maximize(place, steps, directions) > start + this->leastGain))
  {
    return false;
  }
  const Vec3 step = unit.enter(place);
  x = frame.count == 1 ? x + dot(step, frame.first) * frame.first : x + step;
  if (!this->Input.planar && frame.count > 1)
  {
    x = this->Input.surface.closest(x, this->patchOf(this->Around.front()));
  }
  return true;
}

bool TriangleOperations::applyMotion(VertexId v, int steps)
{
  if (!this->Mesh.used(v) || this->freedoms[v].kind == PointFreedom::Fixed)
  {
    return false;
  }
  this->Mesh.star(v, this->Around);
  this->Star.leastGain = this->leastGain;
  const Vec3 start = this->Mesh.point(v);
  Vec3 x = start;
  double before = 0.0;
  if (!(this->field ? this->maximizeInMetrics(v, steps, x, before)
                    : this->maximizeAround(v, steps, x, before)))
  {
    return false;
  }
  PointMetric formerMetric, metric;
  if (this->field)
  {
    formerMetric = this->Mesh.metric(v);
    metric = this->field->at(x, formerMetric.place);
  }
  this->Mesh.movePoint(v, x, this->Around, this->field ? &metric : nullptr);
  // The triangles of a transaction are compared with the surface at its end.
  const bool open = this->Mesh.inTransaction() && !this->Input.planar;
  const bool valid = std::all_of(this->Around.begin(), this->Around.end(),
    [&](TriId t)
    {
      const Triangle& triangle = this->Mesh.triangle(t);
      return triangle.quality > before &&
        (open || this->accepts(triangle.vertices, triangle.origin));
    });
  if (!valid)
  {
    this->Mesh.movePoint(v, start, this->Around, this->field ? &formerMetric : nullptr);
  }
  this->Count.moves += valid;
  return valid;
}

bool TriangleOperations::smooth(VertexId v, int steps)
{
  if (!this->applyMotion(v, steps))
  {
    return false;
  }
  this->Changed = this->Around;
  this->touch(this->Changed);
  return true;
}

//------------------------------------------------------------------------------
/// Flips edges and moves points of the triangles of the transaction while that improves them.
void TriangleOperations::tidy()
{
  std::vector<VertexId> points;
  for (int round = 0; round < TidyRounds; ++round)
  {
    bool any = false, flipped = this->flips;
    for (int k = 0; flipped && k < FlipRounds; ++k)
    {
      flipped = false;
      this->Mesh.compare(this->Near, this->Before);
      for (TriId t : this->Near)
      {
        for (int i = 0; i < 3; ++i)
        {
          flipped = this->flip(t, i) || flipped;
        }
      }
      any = any || flipped;
    }
    if (this->moves)
    {
      points.clear();
      this->Mesh.compare(this->Near, this->Before);
      for (TriId t : this->Near)
      {
        const Corners& v = this->Mesh.triangle(t).vertices;
        points.insert(points.end(), v.begin(), v.end());
      }
      // New points first: they have the largest numbers.
      std::sort(points.begin(), points.end(), std::greater<>());
      points.erase(std::unique(points.begin(), points.end()), points.end());
      for (VertexId v : points)
      {
        any = this->applyMotion(v, TidySteps) || any;
      }
    }
    if (!any)
    {
      return;
    }
  }
}

//------------------------------------------------------------------------------
bool TriangleOperations::contract(TriId t, int i, int j)
{
  const Corners& c = this->Mesh.triangle(t).vertices;
  const PointFreedom& freedom = this->freedoms[c[i]];
  const bool wall = this->Mesh.isWall(t, 3 - i - j);
  if (freedom.kind == PointFreedom::Fixed || (freedom.kind == PointFreedom::OnLine && !wall) ||
    this->Mesh.size() <= this->smallestSize)
  {
    return false;
  }
  return this->attempt(
    [&]
    {
      const VertexId w = c[j];
      if (!this->Mesh.contract(t, i, j))
      {
        return false;
      }
      this->Centre = w;
      this->IsInsertion = false;
      // Inverted triangles cannot be repaired by flips that only consider two triangles.
      this->Mesh.star(w, this->Near);
      return std::all_of(this->Near.begin(), this->Near.end(),
        [this](TriId s) { return this->Mesh.quality(s) > 0.0; });
    },
    this->Count.contractions);
}

bool TriangleOperations::mayDivide(TriId t, int i) const
{
  const std::int32_t n = this->Mesh.triangle(t).neighbors[i];
  if (this->Mesh.triangle(t).region == OutsideRegion ||
    (n != NoNumber && this->Mesh.triangle(n >> 2).region == OutsideRegion))
  {
    return false;
  }
  if (!this->Mesh.isWall(t, i))
  {
    return true;
  }
  const Corners& v = this->Mesh.triangle(t).vertices;
  // Edges of three triangles have such ends; not all of their triangles would be divided.
  return this->dividesWalls &&
    !(this->Mesh.isNonManifold(v[Next[i]]) && this->Mesh.isNonManifold(v[Previous[i]]));
}

double TriangleOperations::middleOf(VertexId a, VertexId b) const
{
  if (!this->field)
  {
    return 0.5;
  }
  // The length varies geometrically from x to r x: the part s before the middle has r^s - 1 = (r -
  // 1) / 2.
  const Vec3 e = this->Mesh.point(b) - this->Mesh.point(a);
  const double r = std::sqrt(
    squaredLength(e, this->Mesh.metric(b).tensor) / squaredLength(e, this->Mesh.metric(a).tensor));
  return std::abs(r - 1.0) < NearlyConstant ? 0.5 : std::log(0.5 * (1.0 + r)) / std::log(r);
}

/// Divides an edge at its middle.
VertexId TriangleOperations::divide(TriId t, int i)
{
  const Corners v = this->Mesh.triangle(t).vertices;
  const VertexId first = v[Next[i]], last = v[Previous[i]];
  const Vec3 a = this->Mesh.point(first), b = this->Mesh.point(last);
  PointFreedom freedom;
  Vec3 x = this->field ? a + this->middleOf(first, last) * (b - a) : 0.5 * (a + b);
  if (this->Mesh.isWall(t, i))
  {
    freedom = { PointFreedom::OnLine, (1.0 / norm(b - a)) * (b - a) };
  }
  else if (!this->Input.planar)
  {
    x = this->Input.surface.closest(x, this->patchOf(t));
  }
  PointMetric metric;
  if (this->field)
  {
    metric = this->field->at(x, this->Mesh.metric(first).place);
  }
  const VertexId p = this->Mesh.splitEdge(t, i, x, this->field ? &metric : nullptr);
  this->setPoint(p, freedom, { first, last });
  return p;
}

/// Inserts a point at a position in the plane, located by walking from a triangle; if a wall is in
/// the way, on the wall.
bool TriangleOperations::insertAt(TriId t, const Vec3& x)
{
  for (int step = 0; step < MaxWalk; ++step)
  {
    const Corners& v = this->Mesh.triangle(t).vertices;
    int beyond = -1;
    double least = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const Vec3 &a = this->Mesh.point(v[Next[i]]), &b = this->Mesh.point(v[Previous[i]]);
      const double side = cross(b - a, x - a)[2] / norm(b - a);
      if (side < least)
      {
        least = side;
        beyond = i;
      }
    }
    if (beyond < 0)
    {
      const std::vector<VertexId> around(v.begin(), v.end());
      const VertexId p = this->Mesh.splitTriangle(t, x);
      this->setPoint(p, PointFreedom(), around);
      this->Mesh.star(p, this->Near);
      return std::all_of(this->Near.begin(), this->Near.end(),
        [this](TriId s) { return this->Mesh.quality(s) > 0.0; });
    }
    if (this->Mesh.isWall(t, beyond))
    {
      if (!this->mayDivide(t, beyond))
      {
        return false;
      }
      this->divide(t, beyond);
      return true;
    }
    t = this->Mesh.triangle(t).neighbors[beyond] >> 2;
  }
  return false;
}

bool TriangleOperations::insert(TriId t)
{
  if (this->Mesh.size() >= this->largestSize || this->Mesh.triangle(t).region == OutsideRegion)
  {
    return false;
  }
  const Corners v = this->Mesh.triangle(t).vertices;
  const Vec3 &a = this->Mesh.point(v[0]), &b = this->Mesh.point(v[1]), &c = this->Mesh.point(v[2]);
  const double lengths[3] = { norm(c - b), norm(a - c), norm(b - a) };
  const auto longest = static_cast<int>(std::max_element(lengths, lengths + 3) - lengths);
  const auto shortest = static_cast<int>(std::min_element(lengths, lengths + 3) - lengths);
  if (this->Input.planar && !this->field)
  {
    // Off-center: the apex over the shortest edge with the target angle (A. Ungor, 2004), or the
    // circumcenter if that is closer.
    const Vec3 e = this->Mesh.point(v[Previous[shortest]]) - this->Mesh.point(v[Next[shortest]]);
    const Vec3 middle =
      0.5 * (this->Mesh.point(v[Previous[shortest]]) + this->Mesh.point(v[Next[shortest]]));
    const Vec3 inwards = { -e[1], e[0], 0.0 };
    const double angle = std::asin(std::min(this->target, 0.99));
    const double sine = this->Mesh.quality(t);
    const double height = 0.5 / std::tan(0.5 * angle);
    // The height of the center: R cos(A) for the angle A opposite the edge, with length 1 = 2 R
    // sin(A).
    const double centre = 0.5 * std::sqrt(std::max(1.0 - sine * sine, 0.0)) / sine;
    for (double h : { std::min(height, centre), centre })
    {
      const Vec3 x = middle + h * inwards;
      if (std::isfinite(x[0] + x[1]) &&
        this->attempt([&] { return this->insertAt(t, x); }, this->Count.insertions))
      {
        return true;
      }
    }
  }
  for (int i : { longest, 3 - longest - shortest, shortest })
  {
    if (this->mayDivide(t, i) &&
      this->attempt(
        [&]
        {
          this->divide(t, i);
          return true;
        },
        this->Count.insertions))
    {
      return true;
    }
  }
  return false;
}
}
