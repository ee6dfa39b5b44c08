#include "Peridynamics.h"

#include "PeridynamicsCommon.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <limits>
#include <map>

namespace tautline
{
namespace
{
/// Squared distance of a point to a segment.
double squaredDistance(Vec2 p, Vec2 a, Vec2 b)
{
  const Vec2 e = b - a;
  const double length = dot(e, e);
  const double t = length > 0.0 ? std::clamp(dot(p - a, e) / length, 0.0, 1.0) : 0.0;
  const Vec2 d = p - (a + t * e);
  return dot(d, d);
}

/// Where the segment from a (inside) to b (outside) leaves the circle, as a part of its length.
double exitParameter(Vec2 a, Vec2 b, double radius)
{
  const Vec2 e = b - a;
  const double alpha = dot(e, e), beta = dot(e, a), gamma = dot(a, a) - radius * radius;
  return (-beta + std::sqrt(std::max(0.0, beta * beta - alpha * gamma))) / alpha;
}

/// Area between the disc around 0 and the triangle of 0 and the directed segment from a to b.
double sectorArea(Vec2 a, Vec2 b, double radius)
{
  const auto arc = [&](Vec2 p, Vec2 q)
  { return 0.5 * radius * radius * std::atan2(cross(p, q), dot(p, q)); };
  const Vec2 e = b - a;
  const double alpha = dot(e, e), beta = dot(e, a), gamma = dot(a, a) - radius * radius;
  const double root = beta * beta - alpha * gamma;
  if (!(alpha > 0.0) || root <= 0.0)
  {
    return arc(a, b);
  }
  const double t0 = (-beta - std::sqrt(root)) / alpha, t1 = (-beta + std::sqrt(root)) / alpha;
  if (t1 <= 0.0 || t0 >= 1.0)
  {
    return arc(a, b);
  }
  const Vec2 p = t0 > 0.0 ? a + t0 * e : a, q = t1 < 1.0 ? a + t1 * e : b;
  return (t0 > 0.0 ? arc(a, p) : 0.0) + 0.5 * cross(p, q) + (t1 < 1.0 ? arc(q, b) : 0.0);
}

std::string triangleName(Index t)
{
  return "triangle " + std::to_string(t);
}
}

//------------------------------------------------------------------------------
double squaredSegmentDistance(Vec2 a, Vec2 b, Vec2 c, Vec2 d)
{
  const double c1 = cross(b - a, c - a), c2 = cross(b - a, d - a);
  const double c3 = cross(d - c, a - c), c4 = cross(d - c, b - c);
  if (c1 * c2 < 0.0 && c3 * c4 < 0.0)
  {
    return 0.0;
  }
  return std::min({ squaredDistance(a, c, d), squaredDistance(b, c, d), squaredDistance(c, a, b),
    squaredDistance(d, a, b) });
}

//------------------------------------------------------------------------------
PlanarTriangles::PlanarTriangles(const HorizonMesh& mesh)
{
  const Index points = mesh.numberOfPoints(), count = mesh.numberOfTriangles();
  if (mesh.points.size() % 2 != 0 || mesh.triangles.size() % 3 != 0 ||
    static_cast<Index>(mesh.layer.size()) != count)
  {
    throw Error("a mesh has two coordinates per point, and three points and an interaction layer "
                "flag per triangle");
  }
  if (!mesh.givenPoints.empty() && static_cast<Index>(mesh.givenPoints.size()) != points)
  {
    throw Error("givenPoints has one flag per point, or is empty");
  }
  if (count == 0)
  {
    throw Error("the mesh has no triangle");
  }
  if (points > std::numeric_limits<std::int32_t>::max() / 4 ||
    count > std::numeric_limits<std::int32_t>::max() / 8)
  {
    throw Error("the mesh has too many elements for a nonlocal matrix");
  }
  this->points.resize(points);
  for (Index i = 0; i < points; ++i)
  {
    this->points[i] = { mesh.points[2 * i], mesh.points[2 * i + 1] };
  }
  this->triangles.resize(count);
  this->areas.resize(count);
  this->low.resize(count);
  this->high.resize(count);
  Index positive = 0, negative = 0, firstNegative = -1, firstPositive = -1;
  double shortest = std::numeric_limits<double>::max();
  for (Index t = 0; t < count; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index id = mesh.triangles[3 * t + k];
      if (id < 0 || id >= points)
      {
        throw Error(triangleName(t) + " has point " + std::to_string(id) + "; there are " +
          std::to_string(points));
      }
      this->triangles[t][k] = static_cast<std::int32_t>(id);
    }
    const Vec2 a = this->corner(t, 0), b = this->corner(t, 1), c = this->corner(t, 2);
    const double area = 0.5 * cross(b - a, c - a);
    const double squares = dot(b - a, b - a) + dot(c - a, c - a) + dot(c - b, c - b);
    if (!std::isfinite(squares) || squares > 1e200)
    {
      throw Error(triangleName(t) + " has coordinates that are not finite, or beyond 1e100");
    }
    if (std::abs(area) <= 1e-12 * squares)
    {
      throw Error(triangleName(t) + " is degenerate: it has no area. Clean the mesh first");
    }
    shortest = std::min({ shortest, dot(b - a, b - a), dot(c - a, c - a), dot(c - b, c - b) });
    area > 0.0 ? ++positive : ++negative;
    (area > 0.0 ? firstPositive : firstNegative) = (area > 0.0 ? firstPositive : firstNegative) < 0
      ? t
      : (area > 0.0 ? firstPositive : firstNegative);
    this->areas[t] = std::abs(area);
    this->low[t] = { std::min({ a[0], b[0], c[0] }), std::min({ a[1], b[1], c[1] }) };
    this->high[t] = { std::max({ a[0], b[0], c[0] }), std::max({ a[1], b[1], c[1] }) };
  }
  if (positive > 0 && negative > 0)
  {
    const bool few = negative <= positive;
    throw Error(std::to_string(few ? negative : positive) + " of " + std::to_string(count) +
      " triangles are inverted (the first is " + triangleName(few ? firstNegative : firstPositive) +
      "): untangle or orient the mesh first");
  }
  this->flipped = negative > 0;
  for (auto& triangle : this->triangles)
  {
    if (this->flipped)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
  this->shortestEdge = std::sqrt(shortest);
}

//------------------------------------------------------------------------------
BoxGrid::BoxGrid(const std::vector<Vec2>& low, const std::vector<Vec2>& high)
  : Low(low)
  , High(high)
{
  const auto count = static_cast<Index>(low.size());
  Vec2 first = { 1e300, 1e300 }, last = { -1e300, -1e300 }, half = {};
  for (Index i = 0; i < count; ++i)
  {
    const Vec2 c = 0.5 * (low[i] + high[i]);
    first = { std::min(first[0], c[0]), std::min(first[1], c[1]) };
    last = { std::max(last[0], c[0]), std::max(last[1], c[1]) };
    this->LargestHalf[0] = std::max(this->LargestHalf[0], 0.5 * (high[i][0] - low[i][0]));
    this->LargestHalf[1] = std::max(this->LargestHalf[1], 0.5 * (high[i][1] - low[i][1]));
    half = half + 0.5 / static_cast<double>(count) * (high[i] - low[i]);
  }
  // Cells about as large as the mean box, and not many more of them than boxes.
  const auto cells = [&](double extent, double size)
  { return std::clamp<Index>(static_cast<Index>(extent / std::max(size, 1e-300)), 1, 4096); };
  this->Columns = cells(last[0] - first[0], 2.0 * half[0]);
  this->Rows = cells(last[1] - first[1], 2.0 * half[1]);
  while (this->Columns * this->Rows > 4 * count + 16)
  {
    (this->Columns > this->Rows ? this->Columns : this->Rows) /= 2;
  }
  this->Origin = first;
  this->Cell = { std::max((last[0] - first[0]) / static_cast<double>(this->Columns), 1e-300),
    std::max((last[1] - first[1]) / static_cast<double>(this->Rows), 1e-300) };
  std::vector<std::int32_t> cellOf(count);
  this->Starts.assign(this->Columns * this->Rows + 1, 0);
  for (Index i = 0; i < count; ++i)
  {
    const Vec2 c = 0.5 * (low[i] + high[i]);
    cellOf[i] = static_cast<std::int32_t>(this->row(c[1]) * this->Columns + this->column(c[0]));
    ++this->Starts[cellOf[i] + 1];
  }
  for (std::size_t i = 1; i < this->Starts.size(); ++i)
  {
    this->Starts[i] += this->Starts[i - 1];
  }
  std::vector<std::int32_t> cursor(this->Starts.begin(), this->Starts.end() - 1);
  this->Boxes.resize(count);
  for (Index i = 0; i < count; ++i)
  {
    this->Boxes[cursor[cellOf[i]]++] = static_cast<std::int32_t>(i);
  }
}

Index BoxGrid::column(double x) const
{
  const double c = (x - this->Origin[0]) / this->Cell[0];
  return c <= 0.0                             ? 0
    : c >= static_cast<double>(this->Columns) ? this->Columns - 1
                                              : static_cast<Index>(c);
}

Index BoxGrid::row(double y) const
{
  const double r = (y - this->Origin[1]) / this->Cell[1];
  return r <= 0.0                          ? 0
    : r >= static_cast<double>(this->Rows) ? this->Rows - 1
                                           : static_cast<Index>(r);
}

//------------------------------------------------------------------------------
void BoxGrid::near(Vec2 low, Vec2 high, double reach, std::vector<std::int32_t>& found) const
{
  found.clear();
  const Vec2 slack = { 1.000001 * (reach + this->LargestHalf[0]),
    1.000001 * (reach + this->LargestHalf[1]) };
  const Index firstRow = this->row(low[1] - slack[1]), lastRow = this->row(high[1] + slack[1]);
  const Index firstColumn = this->column(low[0] - slack[0]),
              lastColumn = this->column(high[0] + slack[0]);
  for (Index r = firstRow; r <= lastRow; ++r)
  {
    const std::int32_t begin = this->Starts[r * this->Columns + firstColumn];
    const std::int32_t end = this->Starts[r * this->Columns + lastColumn + 1];
    for (std::int32_t k = begin; k < end; ++k)
    {
      const std::int32_t i = this->Boxes[k];
      const double dx = std::max({ 0.0, this->Low[i][0] - high[0], low[0] - this->High[i][0] });
      const double dy = std::max({ 0.0, this->Low[i][1] - high[1], low[1] - this->High[i][1] });
      if (dx * dx + dy * dy <= reach * reach)
      {
        found.push_back(i);
      }
    }
  }
}

//------------------------------------------------------------------------------
double layerDeficit(const HorizonMesh& mesh, double horizon, int threads)
{
  // Edges by their two points: how many triangles and how many of the domain use them.
  struct Use
  {
    int all = 0, domain = 0;
  };
  std::map<std::pair<Index, Index>, Use> edges;
  for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index a = mesh.triangles[3 * t + k], b = mesh.triangles[3 * t + (k + 1) % 3];
      Use& use = edges[{ std::min(a, b), std::max(a, b) }];
      ++use.all;
      use.domain += mesh.layer[t] == 0;
    }
  }
  const auto point = [&](Index i) { return Vec2{ mesh.points[2 * i], mesh.points[2 * i + 1] }; };
  std::vector<std::array<Vec2, 2>> outer, domain;
  for (const auto& [ends, use] : edges)
  {
    const std::array<Vec2, 2> edge = { point(ends.first), point(ends.second) };
    if (use.all == 1)
    {
      outer.push_back(edge);
    }
    if (use.domain == 1)
    {
      domain.push_back(edge);
    }
  }
  std::vector<double> nearest(domain.size(), horizon * horizon);
#pragma omp parallel for schedule(static) num_threads(resolveThreads(threads))
  for (std::size_t i = 0; i < domain.size(); ++i)
  {
    for (const auto& edge : outer)
    {
      nearest[i] =
        std::min(nearest[i], squaredSegmentDistance(domain[i][0], domain[i][1], edge[0], edge[1]));
    }
  }
  const double least =
    domain.empty() ? horizon : std::sqrt(*std::min_element(nearest.begin(), nearest.end()));
  const double deficit = horizon - least;
  return deficit > 1e-9 * horizon ? deficit : 0.0;
}

//------------------------------------------------------------------------------
HorizonMesh horizonSquare(double h, double aspectRatio, double delta, Index extraLayers)
{
  if (!(h > 0.0) || !(aspectRatio > 0.0) || !(delta >= 0.0) ||
    !std::isfinite(h + delta + aspectRatio))
  {
    throw Error(
      "the square needs an element size and an aspect ratio above 0 and an interaction layer of "
      "width 0 or more");
  }
  const double steps[] = { h * std::sqrt(aspectRatio), h / std::sqrt(aspectRatio) };
  Index cells[2];
  for (int c = 0; c < 2; ++c)
  {
    const double count = (1.0 + 2.0 * delta) / steps[c];
    if (std::abs(count - std::round(count)) > 1e-6 || count > 1e5)
    {
      throw Error("from -delta to 1 + delta, " + std::to_string(count) +
        (c == 0 ? " elements fit side by side" : " elements fit one above the other") +
        "; choose the element size, the aspect ratio and delta so that this is a whole number");
    }
    cells[c] = std::llround(count) + 2 * extraLayers;
  }
  HorizonMesh mesh;
  const auto inside = [](double x) { return x > 1e-9 && x < 1.0 - 1e-9; };
  for (Index j = 0; j <= cells[1]; ++j)
  {
    for (Index i = 0; i <= cells[0]; ++i)
    {
      const double x = -delta + static_cast<double>(i - extraLayers) * steps[0];
      const double y = -delta + static_cast<double>(j - extraLayers) * steps[1];
      mesh.points.push_back(x);
      mesh.points.push_back(y);
      mesh.givenPoints.push_back(!(inside(x) && inside(y)));
    }
  }
  for (Index j = 0; j < cells[1]; ++j)
  {
    for (Index i = 0; i < cells[0]; ++i)
    {
      const Index a = j * (cells[0] + 1) + i, d = a + cells[0] + 1;
      const Index both[2][3] = { { a, a + 1, d + 1 }, { a, d + 1, d } };
      for (const auto& t : both)
      {
        double x = 0.0, y = 0.0;
        for (const Index id : t)
        {
          mesh.triangles.push_back(id);
          x += mesh.points[2 * id] / 3.0;
          y += mesh.points[2 * id + 1] / 3.0;
        }
        mesh.layer.push_back(!(inside(x) && inside(y)));
      }
    }
  }
  return mesh;
}

//------------------------------------------------------------------------------
DiscIntersection intersectDisc(const double* corners, double x, double y, double radius)
{
  DiscIntersection result;
  Vec2 p[3] = {};
  bool in[3];
  for (int k = 0; k < 3; ++k)
  {
    p[k] = { corners[2 * k] - x, corners[2 * k + 1] - y };
    in[k] = dot(p[k], p[k]) <= radius * radius;
    result.corners += in[k];
  }
  for (int k = 0; k < 3; ++k)
  {
    result.exactArea += sectorArea(p[k], p[(k + 1) % 3], radius);
  }
  result.exactArea = std::abs(result.exactArea);
  const auto add = [&](Vec2 a, Vec2 b, Vec2 c)
  {
    result.chordArea += 0.5 * std::abs(cross(b - a, c - a));
    for (const Vec2 v : { a, b, c })
    {
      result.chords.push_back(v[0] + x);
      result.chords.push_back(v[1] + y);
    }
  };
  if (result.corners == 3)
  {
    add(p[0], p[1], p[2]);
  }
  else if (result.corners > 0)
  {
    // Turned so that the odd corner is last (two inside) or first (one inside).
    int first = 0;
    while (result.corners == 1 ? !in[first] : in[(first + 2) % 3])
    {
      ++first;
    }
    const Vec2 a = p[first], b = p[(first + 1) % 3], c = p[(first + 2) % 3];
    const Vec2 onAC = a + exitParameter(a, c, radius) * (c - a);
    if (result.corners == 1)
    {
      add(a, a + exitParameter(a, b, radius) * (b - a), onAC);
    }
    else
    {
      add(a, b, onAC);
      add(b, b + exitParameter(b, c, radius) * (c - b), onAC);
    }
  }
  return result;
}
}
