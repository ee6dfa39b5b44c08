// SPDX-License-Identifier: BSD-3-Clause
#include "TransferMesh.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Geometry/Polygon.h"

#include <algorithm>
#include <numeric>

namespace tautline
{
namespace
{
/// Simplices below this fraction of the largest size for their longest edge are degenerate.
constexpr double FlatSimplex = 1e-14;

int dimensionOfType(int type)
{
  if (type == PolygonType)
  {
    return 2;
  }
  const CellType known = cornerType(type);
  return known == CellType::Unsupported ? 0 : topology(known).dimension;
}

double sizeOfSimplex(const std::vector<Vec3>& points, const TransferMesh::Simplex& s)
{
  const Vec3 &a = points[s[0]], u = points[s[1]] - a, v = points[s[2]] - a;
  const Vec3 n = cross(u, v);
  return s[3] < 0 ? 0.5 * norm(n) : std::abs(dot(n, points[s[3]] - a)) / 6.0;
}

/// The triangles of a polygon in space, as positions of its corners in the list.
std::vector<std::array<Index, 3>> trianglesOf(const std::vector<Vec3>& corners)
{
  Vec3 normal = { 0, 0, 0 };
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
  {
    normal += cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
  }
  if (!(norm(normal) > 0.0))
  {
    return {};
  }
  const auto largest = std::max_element(
    normal.begin(), normal.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto axis = static_cast<std::size_t>(largest - normal.begin());
  // Project along the axis nearest to the normal, counterclockwise.
  std::size_t first = (axis + 1) % 3, second = (axis + 2) % 3;
  if (normal[axis] < 0.0)
  {
    std::swap(first, second);
  }
  std::vector<Vec2> flat;
  for (const Vec3& p : corners)
  {
    flat.push_back({ p[first], p[second] });
  }
  if (isSimple(flat) && signedArea(flat) > 0.0)
  {
    return triangulatePolygon(flat).triangles;
  }
  // A polygon whose projection intersects itself is divided into a fan.
  std::vector<std::array<Index, 3>> fan;
  for (Index k = 1; k + 1 < static_cast<Index>(corners.size()); ++k)
  {
    fan.push_back({ 0, k, k + 1 });
  }
  return fan;
}
}

//------------------------------------------------------------------------------
int elementDimension(const MeshView& view)
{
  int dimension = 0;
  for (Index cell = 0; cell < view.numberOfCells && dimension < 3; ++cell)
  {
    pollInterruption(cell);
    dimension = std::max(dimension, dimensionOfType(view.cellTypes[cell]));
  }
  return dimension;
}

//------------------------------------------------------------------------------
TransferMesh::TransferMesh(int dimension)
  : Dim(dimension)
{
}

//------------------------------------------------------------------------------
void TransferMesh::add(const MeshView& view, const unsigned char* skip)
{
  const Index first = this->numberOfPoints();
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    pollInterruption(p);
    this->Points.push_back(pointOf(view, p));
  }
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const Index number = this->numberOfCells();
    const Index *begin = view.connectivity + view.offsets[cell],
                *end = view.connectivity + view.offsets[cell + 1];
    Vec3 sum = { 0, 0, 0 };
    const bool inRange =
      std::all_of(begin, end, [&](Index node) { return node >= 0 && node < view.numberOfPoints; });
    for (const Index* node = begin; inRange && node != end; ++node)
    {
      sum += pointOf(view, *node);
    }
    const bool element =
      dimensionOfType(view.cellTypes[cell]) == this->Dim && !(skip && skip[cell] != 0);
    const bool usable = inRange && std::isfinite(sum[0] + sum[1] + sum[2]);
    if (element && !usable)
    {
      throw Error("Cell " + std::to_string(cell) +
        " has a point that is not finite or not in the mesh: remove it first (Threshold).");
    }
    // A cell without simplices keeps the mean of its points as its center.
    this->Centers.push_back(
      begin == end || !usable ? Vec3{ 0, 0, 0 } : (1.0 / static_cast<double>(end - begin)) * sum);
    if (element)
    {
      this->divide(view, cell, first);
    }
    // The center of mass of its simplices.
    Vec3 moment = { 0, 0, 0 };
    double size = 0.0;
    for (std::size_t s = this->Starts.back(); s < this->Simplices.size(); ++s)
    {
      this->Cells[s] = number;
      size += this->Sizes[s];
      for (int k = 0; k < this->corners(); ++k)
      {
        moment += (this->Sizes[s] / this->corners()) * this->Points[this->Simplices[s][k]];
      }
    }
    if (size > 0.0)
    {
      this->Centers.back() = (1.0 / size) * moment;
    }
    this->Starts.push_back(this->numberOfSimplices());
  }
}

//------------------------------------------------------------------------------
void TransferMesh::addSimplex(const Simplex& simplex, Index cell)
{
  const double size = sizeOfSimplex(this->Points, simplex);
  double longest = 0.0;
  for (int i = 0; i < this->corners(); ++i)
  {
    for (const double coordinate : this->Points[simplex[i]])
    {
      if (std::abs(coordinate) > FarthestCoordinate)
      {
        return;
      }
    }
    for (int k = 0; k < i; ++k)
    {
      longest = std::max(longest, norm(this->Points[simplex[i]] - this->Points[simplex[k]]));
    }
  }
  if (size > FlatSimplex * std::pow(longest, this->Dim))
  {
    this->Simplices.push_back(simplex);
    this->Sizes.push_back(size);
    this->Cells.push_back(cell);
  }
}

//------------------------------------------------------------------------------
void TransferMesh::divide(const MeshView& view, Index cell, Index firstPoint)
{
  const Index* nodes = view.connectivity + view.offsets[cell];
  const auto count = view.offsets[cell + 1] - view.offsets[cell];
  const auto add = [&](Index a, Index b, Index c, Index d)
  {
    this->addSimplex(
      { firstPoint + a, firstPoint + b, firstPoint + c, d < 0 ? -1 : firstPoint + d }, cell);
  };
  if (view.cellTypes[cell] == PolygonType)
  {
    std::vector<Vec3> corners;
    for (Index k = 0; k < count; ++k)
    {
      corners.push_back(pointOf(view, nodes[k]));
    }
    for (const std::array<Index, 3>& t : trianglesOf(corners))
    {
      add(nodes[t[0]], nodes[t[1]], nodes[t[2]], -1);
    }
    return;
  }
  const CellTopology& t = topology(cornerType(view.cellTypes[cell]));
  if (this->Dim == 2)
  {
    // The division starts at the point with the lowest number, so that it does not depend on the
    // first corner.
    const auto lowest = std::min_element(nodes, nodes + t.nodes) - nodes;
    for (int k = 1; k + 1 < t.nodes; ++k)
    {
      add(nodes[lowest], nodes[(lowest + k) % t.nodes], nodes[(lowest + k + 1) % t.nodes], -1);
    }
    return;
  }
  if (t.type == CellType::Tetrahedron)
  {
    add(nodes[0], nodes[1], nodes[2], nodes[3]);
    return;
  }
  // Build tetrahedra from the lowest point to the triangles of the faces that do not contain it.
  const Index apex = *std::min_element(nodes, nodes + t.nodes);
  for (int f = 0; f < t.faces; ++f)
  {
    const int size = t.faceSizes[f];
    const auto node = [&](int k) { return nodes[t.faceNodes[f][k % size]]; };
    int lowest = 0;
    bool hasApex = false;
    for (int k = 0; k < size; ++k)
    {
      hasApex = hasApex || node(k) == apex;
      lowest = node(k) < node(lowest) ? k : lowest;
    }
    for (int k = 1; !hasApex && k + 1 < size; ++k)
    {
      add(apex, node(lowest), node(lowest + k), node(lowest + k + 1));
    }
  }
}

//------------------------------------------------------------------------------
double TransferMesh::sizeOfCell(Index cell) const
{
  return std::accumulate(
    this->Sizes.begin() + this->Starts[cell], this->Sizes.begin() + this->Starts[cell + 1], 0.0);
}

//------------------------------------------------------------------------------
double TransferMesh::size() const
{
  return std::accumulate(this->Sizes.begin(), this->Sizes.end(), 0.0);
}

//------------------------------------------------------------------------------
void TransferMesh::flatten(const Vec3& origin, const Vec3& first, const Vec3& second)
{
  for (std::vector<Vec3>* places : { &this->Points, &this->Centers })
  {
    for (Vec3& x : *places)
    {
      const Vec3 d = x - origin;
      x = { dot(d, first), dot(d, second), 0.0 };
    }
  }
}
}
