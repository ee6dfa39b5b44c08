// SPDX-License-Identifier: BSD-3-Clause
#include "PeridynamicsGeometry.h"

#include "tautline/Mesh/CoordinateFrame.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
std::string triangleName(Index t)
{
  return "triangle " + std::to_string(t);
}

void checkSizes(const HorizonMesh& mesh)
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
}
}

//------------------------------------------------------------------------------
PlanarTriangles::PlanarTriangles(const HorizonMesh& mesh)
{
  const Index points = mesh.numberOfPoints(), count = mesh.numberOfTriangles();
  checkSizes(mesh);
  this->points.resize(points);
  for (Index i = 0; i < points; ++i)
  {
    this->points[i] = { mesh.points[2 * i], mesh.points[2 * i + 1] };
  }
  this->triangles.resize(count);
  this->sources.resize(count);
  this->areas.resize(count);
  this->low.resize(count);
  this->high.resize(count);
  Index positive = 0, negative = 0, firstNegative = 0, firstPositive = 0;
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
      this->sources[t][k] = static_cast<std::int32_t>(3 * t + k);
    }
    const Vec2 a = this->corner(t, 0), b = this->corner(t, 1), c = this->corner(t, 2);
    const double area = 0.5 * cross(b - a, c - a);
    const double squares = dot(b - a, b - a) + dot(c - a, c - a) + dot(c - b, c - b);
    if (!std::isfinite(squares))
    {
      throw Error(triangleName(t) + " has coordinates that are not finite, or too large");
    }
    if (squares > 0.0 && unitOfExtent(std::sqrt(squares)) != 1.0)
    {
      throw Error(triangleName(t) +
        " is of extreme size: nonlocal models support triangles between 5e-20 and 2e19 long. "
        "Scale the mesh first (filter Transform)");
    }
    if (std::abs(area) <= 1e-12 * squares)
    {
      throw Error(triangleName(t) + " is degenerate: it has no area. Clean the mesh first");
    }
    shortest = std::min({ shortest, dot(b - a, b - a), dot(c - a, c - a), dot(c - b, c - b) });
    if (area > 0.0)
    {
      firstPositive = positive++ == 0 ? t : firstPositive;
    }
    else
    {
      firstNegative = negative++ == 0 ? t : firstNegative;
    }
    this->areas[t] = std::abs(area);
    this->low[t] = { std::min({ a[0], b[0], c[0] }), std::min({ a[1], b[1], c[1] }) };
    this->high[t] = { std::max({ a[0], b[0], c[0] }), std::max({ a[1], b[1], c[1] }) };
  }
  if (positive > 0 && negative > 0)
  {
    const bool few = negative <= positive; // triangles of the rarer orientation are inverted
    throw Error(std::to_string(few ? negative : positive) + " of " + std::to_string(count) +
      " triangles are inverted (the first is " + triangleName(few ? firstNegative : firstPositive) +
      "): untangle or orient the mesh first");
  }
  this->flipped = negative > 0;
  for (Index t = 0; t < count && this->flipped; ++t)
  {
    std::swap(this->triangles[t][1], this->triangles[t][2]);
    std::swap(this->sources[t][1], this->sources[t][2]);
  }
  this->shortestEdge = std::sqrt(shortest);
}

//------------------------------------------------------------------------------
void PlanarTriangles::sortByPlace()
{
  // A power of two, so that the rounding of exact coordinates is exact.
  constexpr double fineness = 1e-10;
  this->unit = std::exp2(std::floor(std::log2(fineness * this->shortestEdge)));
  Vec2 least = this->low[0];
  for (const Vec2& l : this->low)
  {
    least = { std::min(least[0], l[0]), std::min(least[1], l[1]) };
  }
  this->lattice.assign(this->points.size(), { 0, 0 }); // unused points may be anywhere
  for (std::size_t t = 0; t < this->triangles.size(); ++t)
  {
    auto &ids = this->triangles[t], &from = this->sources[t];
    for (const std::int32_t id : ids)
    {
      const Vec2 p = this->points[id] - least;
      this->lattice[id] = { std::llround(p[0] / this->unit), std::llround(p[1] / this->unit) };
    }
    // Start each triangle at its smallest lattice position and sort the triangles, so that results
    // do not depend on the input order.
    const auto first = std::min_element(ids.begin(), ids.end(),
      [this](std::int32_t a, std::int32_t b) { return this->lattice[a] < this->lattice[b]; });
    const auto turn = first - ids.begin();
    std::rotate(ids.begin(), ids.begin() + turn, ids.end());
    std::rotate(from.begin(), from.begin() + turn, from.end());
  }
  std::vector<std::int32_t> order(this->triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [this](std::int32_t one, std::int32_t other)
    {
      const auto &a = this->triangles[one], &b = this->triangles[other];
      int k = 0;
      while (k < 2 && this->lattice[a[k]] == this->lattice[b[k]])
      {
        ++k;
      }
      return this->lattice[a[k]] < this->lattice[b[k]];
    });
  const auto arrange = [&order](auto& values)
  {
    auto sorted = values;
    std::transform(
      order.begin(), order.end(), sorted.begin(), [&values](std::int32_t t) { return values[t]; });
    values = std::move(sorted);
  };
  arrange(this->triangles);
  arrange(this->sources);
  arrange(this->areas);
  arrange(this->low);
  arrange(this->high);
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
  // Cells about as large as the mean box, with not many more cells than boxes.
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
  // Sort the boxes by the cells of their centers (counting sort).
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
  // Centers may be up to half of the largest box beyond the reach.
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
}
