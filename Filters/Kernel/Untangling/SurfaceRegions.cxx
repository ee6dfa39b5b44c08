// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRegions.h"

#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace tautline
{
namespace
{
/// Numbers of rings of elements around the invalid ones, tried in this order.
constexpr int RingCounts[] = { 1, 2, 4 };
/// The minimum cosine of the angle between the normals of a valid element and its region.
constexpr double LeastCosine = 0.3;
/// The maximum cosine of the angle between the normals of valid neighbors whose common edge is a
/// feature to keep.
constexpr double FeatureCosine = 0.77;

/// An input triangle in the plane of a region, with the heights of its corners above the plane.
struct Piece
{
  Vec3 corners[3]; ///< u, v and the height
};

/// A region of elements around invalid ones.
struct SurfaceRegion
{
  std::vector<Index> cells, points;
  Vec3 normal = { 0, 0, 0 }, origin = { 0, 0, 0 };
  Vec3 axes[2] = { { 1, 0, 0 }, { 0, 1, 0 } };
};

class SurfaceUntangler
{
public:
  SurfaceUntangler(const Mesh& mesh, const UntangleOptions& options, UntangleProgress& progress,
    const PlanarUntangling& inPlane, std::vector<signed char>& validity, UntangleResult& result);
  /// Processes all invalid elements with this number of rings; returns whether to continue.
  bool run(int rings);

private:
  const CellTopology& topologyOf(Index cell) const
  {
    return topology(cornerType(this->View.cellTypes[cell]));
  }
  bool isElement(Index cell) const
  {
    return cornerType(this->View.cellTypes[cell]) != CellType::Unsupported;
  }
  Vec3 at(Index point) const
  {
    const double* x = &this->Result.points[3 * point];
    return { x[0], x[1], x[2] };
  }
  Vec3 normalOf(Index cell, const double* points) const;
  std::vector<std::vector<Index>> clusters() const;
  SurfaceRegion regionOf(const std::vector<Index>& cluster, int rings) const;
  std::vector<Index> withRing(const std::vector<Index>& cells) const;
  void flagFeatures(const SurfaceRegion& region, std::map<Index, unsigned char>& held) const;
  std::vector<unsigned char> heldPoints(const SurfaceRegion& region) const;
  std::vector<Piece> piecesOf(const SurfaceRegion& region) const;
  Vec3 inPlane(const SurfaceRegion& region, const Vec3& x) const;
  bool untangleRegion(const SurfaceRegion& region);
  bool accept(const SurfaceRegion& region, const std::vector<Vec3>& moved);

  const Mesh& TheMesh;
  const MeshView& View;
  const UntangleOptions& Options;
  UntangleProgress& Progress;
  const PlanarUntangling& InPlane;
  std::vector<signed char>& Validity;
  UntangleResult& Result;
  VertexCells Cells;
  std::vector<char> Border;
};

SurfaceUntangler::SurfaceUntangler(const Mesh& mesh, const UntangleOptions& options,
  UntangleProgress& progress, const PlanarUntangling& inPlane, std::vector<signed char>& validity,
  UntangleResult& result)
  : TheMesh(mesh)
  , View(mesh.view())
  , Options(options)
  , Progress(progress)
  , InPlane(inPlane)
  , Validity(validity)
  , Result(result)
  , Cells(mesh.vertexCells())
  , Border(options.fixed ? std::vector<char>() : mesh.boundary().isBoundaryPoint)
{
}

/// Its length is twice the area.
Vec3 SurfaceUntangler::normalOf(Index cell, const double* points) const
{
  const CellTopology& t = this->topologyOf(cell);
  Vec3 p[MaxNodes];
  for (int k = 0; k < t.nodes; ++k)
  {
    const double* x = points + 3 * this->View.connectivity[this->View.offsets[cell] + k];
    p[k] = { x[0], x[1], x[2] };
  }
  return vectorArea(t, p);
}

/// The invalid elements, grouped by common points.
std::vector<std::vector<Index>> SurfaceUntangler::clusters() const
{
  UnionFind sets(this->View.numberOfPoints);
  const auto forEachInvalid = [this](const auto& visit)
  {
    for (Index cell = 0; cell < this->View.numberOfCells; ++cell)
    {
      if (this->isElement(cell) && isInvalid(this->Validity[cell]))
      {
        visit(cell, this->View.connectivity + this->View.offsets[cell]);
      }
    }
  };
  forEachInvalid(
    [&](Index cell, const Index* node)
    {
      for (int k = 1; k < this->topologyOf(cell).nodes; ++k)
      {
        sets.join(node[0], node[k]);
      }
    });
  std::map<Index, std::vector<Index>> bySet;
  forEachInvalid([&](Index cell, const Index* node) { bySet[sets.find(node[0])].push_back(cell); });
  std::vector<std::vector<Index>> result;
  for (auto& [set, cells] : bySet)
  {
    result.push_back(std::move(cells));
  }
  return result;
}

/// The cells and the cells that share points with them, in increasing order.
std::vector<Index> SurfaceUntangler::withRing(const std::vector<Index>& cells) const
{
  std::vector<Index> result = cells;
  for (const Index cell : cells)
  {
    const Index* node = this->View.connectivity + this->View.offsets[cell];
    for (int k = 0; k < this->topologyOf(cell).nodes; ++k)
    {
      result.insert(result.end(), this->Cells.cells.begin() + this->Cells.offsets[node[k]],
        this->Cells.cells.begin() + this->Cells.offsets[node[k] + 1]);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// The region around invalid elements, without valid elements that are steep relative to it; empty
/// if it has no normal.
SurfaceRegion SurfaceUntangler::regionOf(const std::vector<Index>& cluster, int rings) const
{
  SurfaceRegion region;
  std::vector<Index> cells = cluster;
  for (int ring = 0; ring < rings; ++ring)
  {
    cells = this->withRing(cells);
  }
  for (const Index cell : cells)
  {
    region.normal += this->normalOf(cell, this->Result.points.data());
  }
  const double length = norm(region.normal);
  if (!(length > 0) || !std::isfinite(length))
  {
    return region;
  }
  region.normal = (1 / length) * region.normal;
  for (const Index cell : cells)
  {
    const Vec3 own = this->normalOf(cell, this->Result.points.data());
    if (this->Validity[cell] != Valid || dot(own, region.normal) >= LeastCosine * norm(own))
    {
      region.cells.push_back(cell);
      const Index* node = this->View.connectivity + this->View.offsets[cell];
      region.points.insert(region.points.end(), node, node + this->topologyOf(cell).nodes);
    }
  }
  std::sort(region.points.begin(), region.points.end());
  region.points.erase(std::unique(region.points.begin(), region.points.end()), region.points.end());
  region.origin = this->at(region.points[0]);
  const Vec3& n = region.normal;
  const int least =
    static_cast<int>(std::min_element(n.begin(), n.end(),
                       [](double a, double b) { return std::abs(a) < std::abs(b); }) -
      n.begin());
  Vec3 axis = { 0, 0, 0 };
  axis[least] = 1;
  axis = axis - dot(axis, n) * n;
  region.axes[0] = (1 / norm(axis)) * axis;
  region.axes[1] = cross(n, region.axes[0]);
  return region;
}

/// The coordinates along both axes, and the height.
Vec3 SurfaceUntangler::inPlane(const SurfaceRegion& region, const Vec3& x) const
{
  const Vec3 d = x - region.origin;
  return { dot(d, region.axes[0]), dot(d, region.axes[1]), dot(d, region.normal) };
}

/// Fixes the ends of sharp edges between valid elements.
void SurfaceUntangler::flagFeatures(
  const SurfaceRegion& region, std::map<Index, unsigned char>& held) const
{
  std::map<std::pair<Index, Index>, Vec3> normals;
  for (const Index cell : region.cells)
  {
    const CellTopology& t = this->topologyOf(cell);
    const Index* node = this->View.connectivity + this->View.offsets[cell];
    const Vec3 normal = this->normalOf(cell, this->View.points);
    for (int k = 0; this->Validity[cell] == Valid && k < t.nodes; ++k)
    {
      const Index a = node[k], b = node[(k + 1) % t.nodes];
      const auto [at, fresh] = normals.emplace(std::minmax(a, b), normal);
      if (!fresh && dot(normal, at->second) < FeatureCosine * norm(normal) * norm(at->second))
      {
        held[a] = held[b] = 1;
      }
    }
  }
}

/// One flag per point of the region: fixed, at elements outside, or on a feature.
std::vector<unsigned char> SurfaceUntangler::heldPoints(const SurfaceRegion& region) const
{
  std::map<Index, unsigned char> held;
  for (const Index point : region.points)
  {
    const auto begin = this->Cells.cells.begin() + this->Cells.offsets[point],
               end = this->Cells.cells.begin() + this->Cells.offsets[point + 1];
    const bool outside = std::any_of(begin, end,
      [&](Index cell)
      { return !std::binary_search(region.cells.begin(), region.cells.end(), cell); });
    held[point] =
      outside || (this->Options.fixed ? this->Options.fixed[point] : this->Border[point]) != 0;
  }
  this->flagFeatures(region, held);
  std::vector<unsigned char> flags;
  for (const auto& [point, flag] : held)
  {
    flags.push_back(flag);
  }
  return flags;
}

/// The elements of the input in the plane of the region, as triangles that face up.
std::vector<Piece> SurfaceUntangler::piecesOf(const SurfaceRegion& region) const
{
  std::vector<Piece> pieces;
  for (const Index cell : region.cells)
  {
    const CellTopology& t = this->topologyOf(cell);
    const Index* node = this->View.connectivity + this->View.offsets[cell];
    for (int k = 0; k < (t.nodes == 3 ? 1 : 4); ++k)
    {
      Piece piece;
      for (int c = 0; c < 3; ++c)
      {
        piece.corners[c] = this->inPlane(
          region, pointOf(this->View, node[(k + (c == 2 ? t.nodes - 1 : c)) % t.nodes]));
      }
      const Vec3 u = piece.corners[1] - piece.corners[0], v = piece.corners[2] - piece.corners[0];
      if (u[0] * v[1] - u[1] * v[0] > 0)
      {
        pieces.push_back(piece);
      }
    }
  }
  return pieces;
}

/// The height of the surface above a position in the plane: from the triangle that contains the
/// position, or is closest to containing it.
double heightAt(const std::vector<Piece>& pieces, double u, double v, double none)
{
  double best = -HUGE_VAL, height = none;
  for (const Piece& piece : pieces)
  {
    const Vec3 &a = piece.corners[0], &b = piece.corners[1], &c = piece.corners[2];
    const auto area = [](double ux, double uy, double vx, double vy) { return ux * vy - uy * vx; };
    const double whole = area(b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]);
    std::array<double, 3> w = { area(b[0] - u, b[1] - v, c[0] - u, c[1] - v) / whole,
      area(c[0] - u, c[1] - v, a[0] - u, a[1] - v) / whole, 0 };
    w[2] = 1 - w[0] - w[1];
    const double least = std::min({ w[0], w[1], w[2] });
    if (least > best)
    {
      best = least;
      double sum = 0;
      for (double& weight : w)
      {
        weight = std::max(0.0, weight);
        sum += weight;
      }
      height = (w[0] * a[2] + w[1] * b[2] + w[2] * c[2]) / sum;
    }
  }
  return height;
}

/// Accepts the points of a region if they make fewer elements invalid, and no element invalid that
/// was valid before.
bool SurfaceUntangler::accept(const SurfaceRegion& region, const std::vector<Vec3>& moved)
{
  const std::vector<double> before = this->Result.points;
  for (std::size_t i = 0; i < moved.size(); ++i)
  {
    std::copy(moved[i].begin(), moved[i].end(), &this->Result.points[3 * region.points[i]]);
  }
  std::vector<signed char> now;
  Index was = 0, is = 0;
  bool lost = false;
  for (const Index cell : region.cells)
  {
    const CellTopology& t = this->topologyOf(cell);
    Vec3 p[MaxNodes];
    for (int k = 0; k < t.nodes; ++k)
    {
      p[k] = this->at(this->View.connectivity[this->View.offsets[cell] + k]);
    }
    tautline::Validity validity = this->TheMesh.classifyCell(t, p);
    validity =
      validity == Valid && !(dot(vectorArea(t, p), region.normal) > 0) ? Inverted : validity;
    now.push_back(validity);
    was += this->Validity[cell] != Valid;
    is += validity != Valid;
    lost = lost || (this->Validity[cell] == Valid && validity != Valid);
  }
  if (lost || is >= was)
  {
    this->Result.points = before;
    return false;
  }
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    this->Validity[region.cells[i]] = now[i];
  }
  return true;
}

bool SurfaceUntangler::untangleRegion(const SurfaceRegion& region)
{
  const std::vector<unsigned char> held = this->heldPoints(region);
  if (std::find(held.begin(), held.end(), 0) == held.end())
  {
    return false;
  }
  std::vector<double> points;
  for (const Index point : region.points)
  {
    const Vec3 x = this->inPlane(region, this->at(point));
    points.insert(points.end(), { x[0], x[1], 0.0 });
  }
  std::vector<unsigned char> types;
  std::vector<Index> offsets = { 0 }, connectivity;
  for (const Index cell : region.cells)
  {
    const CellTopology& t = this->topologyOf(cell);
    const Index* node = this->View.connectivity + this->View.offsets[cell];
    for (int k = 0; k < t.nodes; ++k)
    {
      connectivity.push_back(std::lower_bound(region.points.begin(), region.points.end(), node[k]) -
        region.points.begin());
    }
    types.push_back(static_cast<unsigned char>(t.type));
    offsets.push_back(static_cast<Index>(connectivity.size()));
  }
  MeshView view;
  view.numberOfPoints = static_cast<Index>(region.points.size());
  view.points = points.data();
  view.numberOfCells = static_cast<Index>(types.size());
  view.cellTypes = types.data();
  view.offsets = offsets.data();
  view.connectivity = connectivity.data();
  const Mesh flat(view, 1);
  if (flat.dimension() != Dimension::Planar)
  {
    return false;
  }
  UntangleOptions options;
  options.effort = this->Options.effort;
  options.maximumSeconds = this->Progress.secondsLeft();
  options.fixed = held.data();
  options.threads = 1;
  const UntangleResult untangled = this->InPlane(flat, options);
  const std::vector<Piece> pieces = this->piecesOf(region);
  std::vector<Vec3> moved;
  for (std::size_t i = 0; i < region.points.size(); ++i)
  {
    const Vec3 x = this->at(region.points[i]);
    const double u = untangled.points[3 * i], v = untangled.points[3 * i + 1];
    const bool stays = held[i] || (u == points[3 * i] && v == points[3 * i + 1]);
    const double height = stays ? 0.0 : heightAt(pieces, u, v, this->inPlane(region, x)[2]);
    moved.push_back(
      stays ? x : region.origin + u * region.axes[0] + v * region.axes[1] + height * region.normal);
  }
  return this->accept(region, moved);
}

bool SurfaceUntangler::run(int rings)
{
  for (const std::vector<Index>& cluster : this->clusters())
  {
    if (this->Progress.late())
    {
      this->Progress.stop(StopReason::TimeLimit);
      return false;
    }
    const SurfaceRegion region = this->regionOf(cluster, rings);
    if (!region.cells.empty())
    {
      this->untangleRegion(region);
    }
  }
  this->Result.invertedAfter = countInvalid(this->TheMesh, this->Validity);
  return this->Result.invertedAfter > 0;
}
}

//------------------------------------------------------------------------------
void untangleSurface(const Mesh& mesh, const UntangleOptions& options, UntangleProgress& progress,
  const PlanarUntangling& inPlane, std::vector<signed char>& validity, UntangleResult& result)
{
  SurfaceUntangler untangler(mesh, options, progress, inPlane, validity, result);
  const auto write = [&result](double* to)
  { std::copy(result.points.begin(), result.points.end(), to); };
  bool going = progress.record(result.invertedBefore, 0.0, 0.0, write);
  double done = 0;
  for (const int rings : RingCounts)
  {
    done += 1;
    going = going && untangler.run(rings);
    if (!progress.stopped())
    {
      going =
        progress.record(result.invertedAfter, 0.0, done / std::size(RingCounts), write) && going;
    }
    if (!going)
    {
      break;
    }
  }
  for (std::size_t cell = 0; cell < validity.size(); ++cell)
  {
    if (isInvalid(validity[cell]))
    {
      result.obstacles[cell] = static_cast<signed char>(Obstacle::Unknown);
    }
  }
}
}
