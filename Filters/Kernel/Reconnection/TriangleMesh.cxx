// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleMesh.h"

#include <tuple>

namespace tautline
{
TriangleMesh::TriangleMesh(std::vector<Vec3> points, const std::vector<Corners>& cells,
  const std::vector<std::int32_t>& regions, const std::vector<std::array<Index, 2>>& walls,
  bool planar)
  : Planar(planar)
  , Triangles(cells.size())
  , Points(std::move(points))
  , PointTriangle(this->Points.size(), NoNumber)
  , InputPoints(static_cast<VertexId>(this->Points.size()))
  , Alive(static_cast<Index>(cells.size()))
  , TriangleSaved(cells.size(), 0)
  , PointSaved(this->Points.size(), 0)
{
  for (TriId t = 0; t < this->slots(); ++t)
  {
    Triangle& triangle = this->Triangles[t];
    triangle.vertices = cells[t];
    triangle.origin = t;
    triangle.region = regions.empty() ? 0 : regions[t];
    triangle.quality = this->qualityOf(cells[t]);
    this->attach(t);
  }
  this->connect(walls);
  this->findNonManifoldPoints();
}

/// Finds the neighbors by sorting the edges.
void TriangleMesh::connect(const std::vector<std::array<Index, 2>>& walls)
{
  struct Side
  {
    VertexId low, high;
    std::int32_t code;
    bool ascending;
  };
  std::vector<Side> sides;
  sides.reserve(3 * this->Triangles.size());
  for (TriId t = 0; t < this->slots(); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      const Corners& v = this->Triangles[t].vertices;
      const VertexId a = v[Next[i]], b = v[Previous[i]];
      sides.push_back({ std::min(a, b), std::max(a, b), 4 * t + i, a < b });
    }
  }
  const auto key = [](const Side& s) { return std::make_tuple(s.low, s.high, s.code); };
  std::sort(
    sides.begin(), sides.end(), [&](const Side& a, const Side& b) { return key(a) < key(b); });
  using Kept = std::pair<std::array<Index, 2>, std::int32_t>; // an edge and its number
  std::vector<Kept> kept;
  for (const std::array<Index, 2>& edge : walls)
  {
    kept.push_back({ { std::min(edge[0], edge[1]), std::max(edge[0], edge[1]) },
      static_cast<std::int32_t>(kept.size()) });
  }
  std::sort(kept.begin(), kept.end());
  for (std::size_t first = 0, end; first < sides.size(); first = end)
  {
    end = first + 1;
    while (end < sides.size() && sides[end].low == sides[first].low &&
      sides[end].high == sides[first].high)
    {
      ++end;
    }
    const std::size_t uses = end - first;
    const bool joined = uses == 2 && sides[first].ascending != sides[first + 1].ascending;
    const TriId t = sides[first].code >> 2, other = sides[end - 1].code >> 2;
    if (joined)
    {
      this->link(sides[first].code, sides[first + 1].code);
    }
    this->NonManifoldEdges += uses > 1 && !joined;
    const std::array<Index, 2> edge = { sides[first].low, sides[first].high };
    const auto found = std::lower_bound(kept.begin(), kept.end(), Kept(edge, NoNumber));
    const bool given = found != kept.end() && found->first == edge;
    if (!joined || given || this->Triangles[t].region != this->Triangles[other].region)
    {
      for (std::size_t k = first; k < end; ++k)
      {
        Triangle& side = this->Triangles[sides[k].code >> 2];
        side.walls |= 1 << (sides[k].code & 3);
        side.lines[sides[k].code & 3] = given ? found->second : NoNumber;
      }
    }
  }
}

void TriangleMesh::findNonManifoldPoints()
{
  std::vector<std::int32_t> uses(this->Points.size(), 0);
  for (const Triangle& triangle : this->Triangles)
  {
    for (VertexId v : triangle.vertices)
    {
      ++uses[v];
    }
  }
  this->NonManifold.assign(this->Points.size(), 0);
  std::vector<TriId> around;
  for (VertexId v = 0; v < this->pointSlots(); ++v)
  {
    if (this->used(v))
    {
      this->star(v, around);
      this->NonManifold[v] = static_cast<std::int32_t>(around.size()) != uses[v];
    }
  }
}

//------------------------------------------------------------------------------
void TriangleMesh::star(VertexId v, std::vector<TriId>& triangles) const
{
  triangles.clear();
  const TriId start = this->PointTriangle[v];
  TriId t = start;
  // Walk once around, ending at the first one, or back to the end of a border.
  while (t != NoNumber)
  {
    const std::int32_t n = this->Triangles[t].neighbors[Next[this->indexOf(t, v)]];
    t = n == NoNumber ? NoNumber : n >> 2;
    if (t == NoNumber || t == start)
    {
      break;
    }
    triangles.push_back(t);
  }
  if (t == start)
  {
    if (start != NoNumber)
    {
      triangles.push_back(start);
    }
    return;
  }
  triangles.clear();
  // Border vertex: walk back to the first triangle, then collect the triangles from there.
  for (t = start;;)
  {
    const std::int32_t n = this->Triangles[t].neighbors[Previous[this->indexOf(t, v)]];
    if (n == NoNumber)
    {
      break;
    }
    t = n >> 2;
  }
  while (t != NoNumber)
  {
    triangles.push_back(t);
    const std::int32_t n = this->Triangles[t].neighbors[Next[this->indexOf(t, v)]];
    t = n == NoNumber ? NoNumber : n >> 2;
  }
}

bool TriangleMesh::areNeighbors(VertexId v, VertexId w) const
{
  std::vector<TriId>& around = this->Scratch;
  this->star(v, around);
  return std::any_of(around.begin(), around.end(),
    [&](TriId t)
    {
      const Corners& c = this->Triangles[t].vertices;
      return std::find(c.begin(), c.end(), w) != c.end();
    });
}

//------------------------------------------------------------------------------
void TriangleMesh::begin()
{
  this->Open = true;
  ++this->Transaction;
  this->OldTriangles.clear();
  this->OldPoints.clear();
  this->TakenTriangles.clear();
  this->TakenPoints.clear();
  this->OldSlots = this->slots();
  this->OldPointSlots = this->pointSlots();
  this->OldAlive = this->Alive;
}

void TriangleMesh::commit()
{
  this->Open = false;
  const auto release = [](auto& from, auto& to)
  {
    to.insert(to.end(), from.begin(), from.end());
    from.clear();
  };
  release(this->ReleasedTriangles, this->FreeTriangles);
  release(this->ReleasedPoints, this->FreePoints);
}

void TriangleMesh::undo()
{
  for (const SavedTriangle& saved : this->OldTriangles)
  {
    this->Triangles[saved.id] = saved.before;
  }
  for (const SavedPoint& saved : this->OldPoints)
  {
    this->Points[saved.id] = saved.position;
    this->PointTriangle[saved.id] = saved.triangle;
    if (this->hasMetrics())
    {
      this->Metrics[saved.id] = saved.metric;
    }
  }
  this->Triangles.resize(this->OldSlots);
  this->TriangleSaved.resize(this->OldSlots);
  this->Points.resize(this->OldPointSlots);
  this->PointTriangle.resize(this->OldPointSlots);
  this->PointSaved.resize(this->OldPointSlots);
  this->Metrics.resize(this->hasMetrics() ? this->OldPointSlots : 0);
  this->FreeTriangles.insert(
    this->FreeTriangles.end(), this->TakenTriangles.rbegin(), this->TakenTriangles.rend());
  this->FreePoints.insert(
    this->FreePoints.end(), this->TakenPoints.rbegin(), this->TakenPoints.rend());
  this->ReleasedTriangles.clear();
  this->ReleasedPoints.clear();
  this->Alive = this->OldAlive;
  this->Open = false;
}

void TriangleMesh::compare(
  std::vector<TriId>& triangles, std::vector<double>& qualitiesBefore) const
{
  triangles.clear();
  qualitiesBefore.clear();
  for (const SavedTriangle& saved : this->OldTriangles)
  {
    const Triangle& now = this->Triangles[saved.id];
    if (now.vertices == saved.before.vertices && now.quality == saved.before.quality)
    {
      continue;
    }
    if (saved.before.vertices[0] != NoNumber)
    {
      qualitiesBefore.push_back(saved.before.quality);
    }
    if (now.vertices[0] != NoNumber)
    {
      triangles.push_back(saved.id);
    }
  }
  for (TriId t = this->OldSlots; t < this->slots(); ++t)
  {
    if (this->alive(t))
    {
      triangles.push_back(t);
    }
  }
}

/// Returns the triangle for modification; its old state is kept for undo().
Triangle& TriangleMesh::change(TriId t)
{
  if (this->Open && t < this->OldSlots && this->TriangleSaved[t] != this->Transaction)
  {
    this->TriangleSaved[t] = this->Transaction;
    this->OldTriangles.push_back({ t, this->Triangles[t] });
  }
  return this->Triangles[t];
}

void TriangleMesh::savePoint(VertexId v)
{
  if (this->Open && v < this->OldPointSlots && this->PointSaved[v] != this->Transaction)
  {
    this->PointSaved[v] = this->Transaction;
    this->OldPoints.push_back({ v, this->Points[v], this->PointTriangle[v],
      this->hasMetrics() ? this->Metrics[v] : PointMetric() });
  }
}

TriId TriangleMesh::addTriangle(const Triangle& triangle)
{
  TriId t = this->slots();
  if (this->FreeTriangles.empty())
  {
    this->Triangles.emplace_back();
    this->TriangleSaved.push_back(0);
  }
  else
  {
    t = this->FreeTriangles.back();
    this->FreeTriangles.pop_back();
    if (this->Open)
    {
      this->TakenTriangles.push_back(t);
    }
  }
  this->change(t) = triangle;
  ++this->Alive;
  return t;
}

VertexId TriangleMesh::addPoint(const Vec3& x, const PointMetric* metric)
{
  VertexId v = this->pointSlots();
  if (this->FreePoints.empty())
  {
    this->Points.push_back(x);
    this->PointTriangle.push_back(NoNumber);
    this->PointSaved.push_back(0);
    if (this->hasMetrics())
    {
      this->Metrics.push_back(metric ? *metric : PointMetric());
    }
    return v;
  }
  v = this->FreePoints.back();
  this->FreePoints.pop_back();
  if (this->Open)
  {
    this->TakenPoints.push_back(v);
  }
  this->savePoint(v);
  this->Points[v] = x;
  if (this->hasMetrics())
  {
    this->Metrics[v] = metric ? *metric : PointMetric();
  }
  return v;
}

void TriangleMesh::removeTriangle(TriId t)
{
  this->change(t) = Triangle();
  --this->Alive;
  (this->Open ? this->ReleasedTriangles : this->FreeTriangles).push_back(t);
}

void TriangleMesh::removePoint(VertexId v)
{
  this->savePoint(v);
  this->PointTriangle[v] = NoNumber;
  if (v >= this->InputPoints)
  {
    (this->Open ? this->ReleasedPoints : this->FreePoints).push_back(v);
  }
}

/// Links the points of the triangle to it.
void TriangleMesh::attach(TriId t)
{
  for (VertexId v : this->Triangles[t].vertices)
  {
    this->savePoint(v);
    this->PointTriangle[v] = t;
  }
}

/// Joins two sides, 4 times the triangle plus the edge; the second may be -1.
void TriangleMesh::link(std::int32_t side, std::int32_t other)
{
  if (side != NoNumber)
  {
    this->change(side >> 2).neighbors[side & 3] = other;
  }
  if (other != NoNumber)
  {
    this->change(other >> 2).neighbors[other & 3] = side;
  }
}

void TriangleMesh::setVertices(TriId t, const Corners& v)
{
  Triangle& triangle = this->change(t);
  triangle.vertices = v;
  triangle.quality = this->qualityOf(v);
  this->attach(t);
}

//------------------------------------------------------------------------------
bool TriangleMesh::flip(TriId t, int i)
{
  if (this->isWall(t, i))
  {
    return false;
  }
  const std::int32_t code = this->Triangles[t].neighbors[i];
  const TriId n = code >> 2;
  const int j = code & 3;
  const Triangle up = this->Triangles[t], down = this->Triangles[n];
  const VertexId a = up.vertices[i], b = up.vertices[Next[i]], c = up.vertices[Previous[i]];
  const VertexId d = down.vertices[j];
  // A second edge a-d in addition to the first one would have four triangles.
  if (a == d || (this->isNonManifold(a) && this->isNonManifold(d)) || this->areNeighbors(a, d))
  {
    return false;
  }
  const auto bit = [](const Triangle& from, int edge, int to)
  { return static_cast<std::uint8_t>((from.walls >> edge & 1) << to); };
  const std::int32_t ab = up.lines[Previous[i]], ca = up.lines[Next[i]];
  const std::int32_t bd = down.lines[Next[j]], dc = down.lines[Previous[j]];
  // (a, b, c) and (d, c, b) become (a, b, d) and (a, d, c).
  this->setVertices(t, { a, b, d });
  this->setVertices(n, { a, d, c });
  this->change(t).walls = bit(down, Next[j], 0) | bit(up, Previous[i], 2);
  this->change(n).walls = bit(down, Previous[j], 0) | bit(up, Next[i], 1);
  this->change(t).lines = { bd, NoNumber, ab };
  this->change(n).lines = { dc, ca, NoNumber };
  this->link(4 * t + 0, down.neighbors[Next[j]]);
  this->link(4 * t + 2, up.neighbors[Previous[i]]);
  this->link(4 * n + 0, down.neighbors[Previous[j]]);
  this->link(4 * n + 1, up.neighbors[Next[i]]);
  this->link(4 * t + 1, 4 * n + 2);
  return true;
}

VertexId TriangleMesh::splitEdge(TriId t, int i, const Vec3& x, const PointMetric* metric)
{
  const std::int32_t code = this->Triangles[t].neighbors[i];
  const bool wall = this->isWall(t, i);
  const VertexId p = this->addPoint(x, metric);
  // Each side (a, b, c) becomes (a, b, p) and (a, p, c), with p on its edge b-c.
  const auto divide = [&](TriId s, int k)
  {
    const Triangle old = this->Triangles[s];
    const VertexId a = old.vertices[k], b = old.vertices[Next[k]], c = old.vertices[Previous[k]];
    Triangle first = old, second = old;
    const std::uint8_t ab = old.walls >> Previous[k] & 1, ca = old.walls >> Next[k] & 1;
    first.neighbors = second.neighbors = { NoNumber, NoNumber, NoNumber };
    first.walls = static_cast<std::uint8_t>((wall ? 1 : 0) | ab << 2);
    second.walls = static_cast<std::uint8_t>((wall ? 1 : 0) | ca << 1);
    first.lines = { old.lines[k], NoNumber, old.lines[Previous[k]] };
    second.lines = { old.lines[k], old.lines[Next[k]], NoNumber };
    this->change(s) = first;
    const TriId added = this->addTriangle(second);
    this->setVertices(s, { a, b, p });
    this->setVertices(added, { a, p, c });
    this->link(4 * s + 2, old.neighbors[Previous[k]]);
    this->link(4 * added + 1, old.neighbors[Next[k]]);
    this->link(4 * s + 1, 4 * added + 2);
    return added;
  };
  const TriId added = divide(t, i);
  if (code != NoNumber)
  {
    const TriId n = code >> 2;
    const TriId other = divide(n, code & 3);
    this->link(4 * t + 0, 4 * other + 0);
    this->link(4 * added + 0, 4 * n + 0);
  }
  return p;
}

VertexId TriangleMesh::splitTriangle(TriId t, const Vec3& x)
{
  const VertexId p = this->addPoint(x);
  const Triangle old = this->Triangles[t];
  TriId parts[3] = { t, NoNumber, NoNumber };
  for (int k = 0; k < 3; ++k)
  {
    Triangle part = old;
    part.neighbors = { NoNumber, NoNumber, NoNumber };
    part.walls = old.walls >> k & 1;
    part.lines = { old.lines[k], NoNumber, NoNumber };
    if (k == 0)
    {
      this->change(t) = part;
    }
    else
    {
      parts[k] = this->addTriangle(part);
    }
    this->setVertices(parts[k], { p, old.vertices[Next[k]], old.vertices[Previous[k]] });
    this->link(4 * parts[k] + 0, old.neighbors[k]);
  }
  for (int k = 0; k < 3; ++k)
  {
    // The part at edge k has v[k + 1], v[k + 2]; it meets the next one along p - v[k + 2].
    this->link(4 * parts[k] + 1, 4 * parts[Next[k]] + 2);
  }
  return p;
}

bool TriangleMesh::isOpen(VertexId v, const std::vector<TriId>& around) const
{
  return this->isBorder(around.front(), Previous[this->indexOf(around.front(), v)]);
}

/// Whether the triangles at v can be attached to w: the link condition.
bool TriangleMesh::canContract(TriId t, int edge, VertexId v, VertexId w) const
{
  const std::int32_t code = this->Triangles[t].neighbors[edge];
  const bool border = code == NoNumber;
  const std::vector<TriId>&around = this->Around, &others = this->Others;
  const std::size_t least = border ? 2 : 3;
  if (this->isNonManifold(v) || this->isNonManifold(w) || around.size() < least ||
    (!border && this->isOpen(v, around) && this->isOpen(w, others)))
  {
    return false;
  }
  // Points adjacent to both: only those opposite the edge.
  std::vector<VertexId> apexes = { this->Triangles[t].vertices[edge] };
  if (!border)
  {
    apexes.push_back(this->Triangles[code >> 2].vertices[code & 3]);
  }
  const auto has = [this](TriId s, VertexId u)
  {
    const Corners& c = this->Triangles[s].vertices;
    return std::find(c.begin(), c.end(), u) != c.end();
  };
  for (TriId s : around)
  {
    for (VertexId u : this->Triangles[s].vertices)
    {
      const bool apex =
        u == v || u == w || std::find(apexes.begin(), apexes.end(), u) != apexes.end();
      if (!apex &&
        std::any_of(others.begin(), others.end(), [&](TriId other) { return has(other, u); }))
      {
        return false;
      }
    }
  }
  // The last triangles of a tetrahedron, or a triangle that is the only one of its apex.
  if (!border && around.size() == least &&
    std::any_of(others.begin(), others.end(),
      [&](TriId s) { return has(s, apexes[0]) && has(s, apexes[1]) && !has(s, v); }))
  {
    return false;
  }
  const auto isolates = [&](TriId s)
  { return this->isBorder(s, this->indexOf(s, v)) && this->isBorder(s, this->indexOf(s, w)); };
  return !isolates(t) && (border || !isolates(code >> 2));
}

/// Joins the neighbors at the edges other than v-w of a vanishing triangle.
void TriangleMesh::close(TriId t, VertexId v, VertexId w)
{
  const Triangle old = this->Triangles[t];
  const int kv = this->indexOf(t, v), kw = this->indexOf(t, w);
  const std::int32_t sides[2] = { old.neighbors[kw], old.neighbors[kv] };
  const bool wall = ((old.walls >> kv | old.walls >> kw) & 1) != 0;
  const std::int32_t line = std::max(old.lines[kv], old.lines[kw]);
  this->link(sides[0], sides[1]);
  this->link(sides[1], sides[0]);
  for (const std::int32_t side : sides)
  {
    if (side != NoNumber && wall)
    {
      this->change(side >> 2).walls |= 1 << (side & 3);
      this->change(side >> 2).lines[side & 3] = line;
    }
  }
  this->removeTriangle(t);
}

bool TriangleMesh::contract(TriId t, int i, int j)
{
  const VertexId v = this->Triangles[t].vertices[i], w = this->Triangles[t].vertices[j];
  const int edge = 3 - i - j;
  this->star(v, this->Around);
  this->star(w, this->Others);
  if (!this->canContract(t, edge, v, w))
  {
    return false;
  }
  const std::int32_t code = this->Triangles[t].neighbors[edge];
  this->close(t, v, w);
  if (code != NoNumber)
  {
    this->close(code >> 2, v, w);
  }
  this->removePoint(v);
  for (TriId s : this->Around)
  {
    if (this->alive(s))
    {
      Corners c = this->Triangles[s].vertices;
      std::replace(c.begin(), c.end(), v, w);
      this->setVertices(s, c);
    }
  }
  // Points of the removed triangles may have been linked to them.
  for (TriId s : this->Others)
  {
    if (this->alive(s))
    {
      this->attach(s);
    }
  }
  return true;
}

void TriangleMesh::movePoint(
  VertexId v, const Vec3& x, const std::vector<TriId>& triangles, const PointMetric* metric)
{
  this->savePoint(v);
  this->Points[v] = x;
  if (metric)
  {
    this->Metrics[v] = *metric;
  }
  for (TriId t : triangles)
  {
    this->change(t).quality = this->qualityOf(this->Triangles[t].vertices);
  }
}

//------------------------------------------------------------------------------
void TriangleMesh::setMetrics(std::vector<PointMetric> metrics, bool measure)
{
  this->Metrics = std::move(metrics);
  this->InMetrics = measure && this->hasMetrics();
  for (Triangle& triangle : this->Triangles)
  {
    if (triangle.vertices[0] != NoNumber)
    {
      triangle.quality = this->qualityOf(triangle.vertices);
    }
  }
}

void TriangleMesh::setMetric(VertexId v, const PointMetric& metric)
{
  this->savePoint(v);
  this->Metrics[v] = metric;
}

// Not inlined: with fused multiply-add, the last digit would depend on the call site.
__attribute__((noinline)) double TriangleMesh::qualityOf(
  const std::array<Vec3, 3>& x, const std::array<const MetricTensor*, 3>& metrics) const
{
  return this->InMetrics
    ? metricQuality(x[0], x[1], x[2], *metrics[0], *metrics[1], *metrics[2], this->Planar)
    : triangleQuality(x[0], x[1], x[2], this->Planar);
}

double TriangleMesh::qualityOf(const Corners& v) const
{
  const std::vector<Vec3>& x = this->Points;
  std::array<const MetricTensor*, 3> metrics = { nullptr, nullptr, nullptr };
  for (int k = 0; this->InMetrics && k < 3; ++k)
  {
    metrics[k] = &this->Metrics[v[k]].tensor;
  }
  return this->qualityOf({ x[v[0]], x[v[1]], x[v[2]] }, metrics);
}

//------------------------------------------------------------------------------
std::string TriangleMesh::violationOf(TriId t) const
{
  const Triangle& triangle = this->Triangles[t];
  const auto text = [t](const char* what) { return "triangle " + std::to_string(t) + ": " + what; };
  if (triangle.quality != this->qualityOf(triangle.vertices))
  {
    return text("its quality is not up to date");
  }
  if (!(triangle.quality > 0.0))
  {
    return text("it is degenerate or inverted");
  }
  for (int i = 0; i < 3; ++i)
  {
    const VertexId v = triangle.vertices[i];
    const TriId of = this->PointTriangle[v];
    if (of == NoNumber || !this->alive(of) ||
      this->Triangles[of].vertices[this->indexOf(of, v)] != v)
    {
      return text("a point of it has no triangle");
    }
    const std::int32_t code = triangle.neighbors[i];
    if (code == NoNumber)
    {
      if (!this->isWall(t, i))
      {
        return text("a border is not a wall");
      }
      continue;
    }
    const TriId n = code >> 2;
    const int j = code & 3;
    if (n >= this->slots() || !this->alive(n) || this->Triangles[n].neighbors[j] != 4 * t + i)
    {
      return text("a neighbor is not linked back to it");
    }
    const Corners& other = this->Triangles[n].vertices;
    if (other[Next[j]] != triangle.vertices[Previous[i]] ||
      other[Previous[j]] != triangle.vertices[Next[i]])
    {
      return text("a neighbor has another edge");
    }
    if (this->isWall(t, i) != this->isWall(n, j))
    {
      return text("an edge is a wall on one side only");
    }
    if (!this->isWall(t, i) && triangle.region != this->Triangles[n].region)
    {
      return text("an edge between regions is not a wall");
    }
  }
  return "";
}

std::string TriangleMesh::findViolation(const std::vector<TriId>& triangles) const
{
  for (TriId t : triangles)
  {
    std::string violation = this->alive(t) ? this->violationOf(t) : "";
    if (!violation.empty())
    {
      return violation;
    }
  }
  return "";
}

std::string TriangleMesh::findViolation() const
{
  Index count = 0;
  std::vector<TriId> all;
  std::vector<char> used(this->Points.size(), 0);
  for (TriId t = 0; t < this->slots(); ++t)
  {
    if (this->alive(t))
    {
      ++count;
      all.push_back(t);
      for (VertexId v : this->Triangles[t].vertices)
      {
        used[v] = 1;
      }
    }
  }
  for (VertexId v = 0; v < this->pointSlots(); ++v)
  {
    if (this->used(v) != (used[v] != 0))
    {
      return "point " + std::to_string(v) + ": it is linked with a triangle that does not use it";
    }
  }
  return count != this->Alive ? "the number of triangles is wrong" : this->findViolation(all);
}
}
