// SPDX-License-Identifier: BSD-3-Clause
#include "FaceEnergy.h"

#include "tautline/Core/Parallel.h"
#include "tautline/FiniteVolume/FaceShape.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
constexpr Index Grain = 512;

/// For faces steeper than this cosine relative to the line of the centers, the skewness is
/// evaluated at this cosine.
constexpr double LeastCosine = 0.1;
/// The minimum widths relative to which skewness is measured, see FaceMeasures.
constexpr double InternalWidth = 0.2, BoundaryWidth = 0.4;
/// The minimum reference volume of a tetrahedron, as a fraction of the mean tetrahedron size of its
/// cell.
constexpr double LeastPart = 0.25;

double widthOf(
  const FaceMesh& mesh, Index face, const double* points, const Vec3& center, const Vec3& direction)
{
  double widest = 0;
  for (Index i = mesh.offsets[face]; i < mesh.offsets[face + 1]; ++i)
  {
    widest = std::max(widest, std::abs(dot(direction, pointAt(points, mesh.nodes[i]) - center)));
  }
  return widest;
}

Vec3 unitOf(const Vec3& v)
{
  const double size = norm(v);
  return size > 0 ? (1 / size) * v : v;
}
}

//------------------------------------------------------------------------------
FaceEnergy::FaceEnergy(const FaceMesh& mesh, const double* points, const std::vector<char>& free,
  const FaceEnergyOptions& options)
  : Mesh(mesh)
  , Options(options)
  , Places(mesh.faces(), -1)
  , Moves(mesh.cells, 0)
  , CellBars(mesh.cells, Vec3{ 0, 0, 0 })
  , ApexBars(mesh.cells, Vec3{ 0, 0, 0 })
{
  const auto moves = [&](Index face)
  {
    return std::any_of(mesh.nodes.begin() + mesh.offsets[face],
      mesh.nodes.begin() + mesh.offsets[face + 1], [&](Index node) { return free[node] != 0; });
  };
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    if (moves(face))
    {
      this->Moves[mesh.owner[face]] = 1;
      if (mesh.internal(face))
      {
        this->Moves[mesh.neighbor[face]] = 1;
      }
    }
  }
  std::vector<char> counts(mesh.faces(), 0);
  for (Index cell = 0; cell < mesh.cells; ++cell)
  {
    if (!this->Moves[cell])
    {
      continue;
    }
    this->Cells.push_back(cell);
    for (Index i = mesh.cellOffsets[cell]; i < mesh.cellOffsets[cell + 1]; ++i)
    {
      const Index face = mesh.cellFaces[i];
      counts[face] = 1;
      if (!mesh.internal(face) && mesh.coupled(face) >= 0)
      {
        counts[mesh.coupled(face)] = 1;
      }
    }
  }
  this->NodeStarts.push_back(0);
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    if (counts[face])
    {
      this->Places[face] = static_cast<Index>(this->Faces.size());
      this->Faces.push_back(face);
      this->NodeStarts.push_back(this->NodeStarts.back() + mesh.size(face));
    }
  }
  this->NodeBars.resize(this->NodeStarts.back());

  // The uses of the free points.
  std::vector<Index> number(mesh.points, -1);
  for (Index point = 0; point < mesh.points; ++point)
  {
    if (free[point])
    {
      number[point] = static_cast<Index>(this->Points.size());
      this->Points.push_back(point);
    }
  }
  const auto forEachUse = [&](const auto& use)
  {
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      const Index first = mesh.offsets[this->Faces[f]];
      for (Index k = 0; k < mesh.size(this->Faces[f]); ++k)
      {
        const Index point = number[mesh.nodes[first + k]];
        if (point >= 0)
        {
          use(point, this->NodeStarts[f] + k);
        }
      }
    }
  };
  this->UseStarts.assign(this->Points.size() + 1, 0);
  forEachUse([&](Index point, Index) { ++this->UseStarts[point + 1]; });
  std::partial_sum(this->UseStarts.begin(), this->UseStarts.end(), this->UseStarts.begin());
  this->Uses.resize(this->UseStarts.back());
  std::vector<Index> next(this->UseStarts.begin(), this->UseStarts.end() - 1);
  forEachUse([&](Index point, Index place) { this->Uses[next[point]++] = place; });
  this->findVolumes(points);
}

//------------------------------------------------------------------------------
void FaceEnergy::findVolumes(const double* points)
{
  this->freeze(points);
  const FaceGeometry& g = this->Geometry;
  // Six times the volume of the tetrahedron at an edge of a face.
  const auto volume = [&](Index face, Index edge, Index cell)
  {
    const double sign = this->Mesh.owner[face] == cell ? 1 : -1;
    const Index first = this->Mesh.offsets[face], size = this->Mesh.size(face);
    const Vec3 a = pointAt(points, this->Mesh.nodes[first + edge]);
    const Vec3 b = pointAt(points, this->Mesh.nodes[first + (edge + 1) % size]);
    return sign * dot(cross(b - a, g.center[face] - a), g.center[face] - g.cellCenter[cell]);
  };
  std::vector<double>& means = this->MeanVolumes;
  means.assign(this->Mesh.cells, 0.0);
  for (Index cell : this->Cells)
  {
    Index count = 0;
    for (Index i = this->Mesh.cellOffsets[cell]; i < this->Mesh.cellOffsets[cell + 1]; ++i)
    {
      const Index face = this->Mesh.cellFaces[i];
      for (Index edge = 0; edge < this->Mesh.size(face); ++edge)
      {
        means[cell] += std::abs(volume(face, edge, cell));
        ++count;
      }
    }
    means[cell] /= static_cast<double>(std::max<Index>(count, 1));
  }
  this->Volumes.resize(this->NodeStarts.back());
  this->FanVolumes.assign(this->NodeStarts.back(), { 0, 0 });
  this->Bases.resize(this->Faces.size());
  this->Start.assign(points, points + 3 * this->Mesh.points);
  this->StartCenters = g.cellCenter;
  for (std::size_t i = 0; i < this->Faces.size(); ++i)
  {
    const Index face = this->Faces[i];
    const Index own = this->Mesh.owner[face];
    const Index other = this->Mesh.internal(face) ? this->Mesh.neighbor[face] : own;
    for (Index edge = 0; edge < this->Mesh.size(face); ++edge)
    {
      // Inverted or flat tetrahedra get a fraction of the mean as reference volume.
      this->Volumes[this->NodeStarts[i] + edge] = { std::max(volume(face, edge, own),
                                                      LeastPart * means[own]),
        std::max(volume(face, edge, other), LeastPart * means[other]) };
    }
  }
}

//------------------------------------------------------------------------------
void FaceEnergy::freeze(const double* points)
{
  this->Geometry = faceGeometry(this->Mesh, points, FaceConvention::Esi, this->Options.threads);
  const auto& g = this->Geometry;
  this->Widths.resize(this->Faces.size());
  parallelFor(static_cast<Index>(this->Faces.size()), Grain, this->Options.threads,
    [&](Index i)
    {
      const Index face = this->Faces[i];
      const Vec3& own = g.cellCenter[this->Mesh.owner[face]];
      const Vec3 toFace = g.center[face] - own;
      const Vec3& area = g.area[face];
      Vec3 off;
      double least;
      if (this->Mesh.hasTwoCells(face))
      {
        const Vec3 d = centerAcross(this->Mesh, g, face) - own;
        // The offset of the face center from the intersection of the face plane with the line
        // between the cell centers.
        const double along = std::max(dot(area, d), LeastCosine * norm(area) * norm(d));
        off = toFace - (along > 0 ? dot(area, toFace) / along : 0) * d;
        least = InternalWidth * norm(d);
      }
      else
      {
        const Vec3 normal = unitOf(area);
        off = toFace - dot(normal, toFace) * normal;
        least = BoundaryWidth * std::abs(dot(normal, toFace));
      }
      // For a face of zero size, use any width: it then has no skewness.
      const double wide = widthOf(this->Mesh, face, points, g.center[face], unitOf(off));
      this->Widths[i] = std::max({ least, wide, std::numeric_limits<double>::min() });
    });
  this->findFans(points);
}

//------------------------------------------------------------------------------
/// Chooses the fans of the faces, and their reference volumes.
void FaceEnergy::findFans(const double* points)
{
  const auto volume = [&](const Index* nodes, Index base, Index a, Index b, const Vec3& apex)
  {
    const double* at = this->Start.data();
    return dot(pointAt(at, nodes[base]) - apex,
      cross(pointAt(at, nodes[a]) - apex, pointAt(at, nodes[b]) - apex));
  };
  for (std::size_t i = 0; i < this->Bases.size(); ++i)
  {
    const Index face = this->Faces[i], size = this->Mesh.size(face);
    const Index base = this->bestBase(face, points);
    this->Bases[i] = base;
    const Index* nodes = this->Mesh.nodes.data() + this->Mesh.offsets[face];
    const Index own = this->Mesh.owner[face];
    const Index other = this->Mesh.internal(face) ? this->Mesh.neighbor[face] : own;
    for (Index k = 1; k + 1 < size; ++k)
    {
      const Index a = (base + k) % size, b = (base + k + 1) % size;
      this->FanVolumes[this->NodeStarts[i] + a] = {
        std::max(
          volume(nodes, base, a, b, this->StartCenters[own]), LeastPart * this->MeanVolumes[own]),
        std::max(-volume(nodes, base, a, b, this->StartCenters[other]),
          LeastPart * this->MeanVolumes[other])
      };
    }
  }
}

//------------------------------------------------------------------------------
/// Updates the faces and centers of the moving cells.
void FaceEnergy::measure(const double* points)
{
  parallelFor(static_cast<Index>(this->Faces.size()), Grain, this->Options.threads,
    [&](Index i)
    {
      const Index face = this->Faces[i];
      const FaceShape shape = faceShape(this->Mesh.nodes.data() + this->Mesh.offsets[face],
        this->Mesh.size(face), points, FaceConvention::Esi);
      this->Geometry.area[face] = shape.area;
      this->Geometry.center[face] = shape.center;
    });
  parallelFor(static_cast<Index>(this->Cells.size()), Grain, this->Options.threads,
    [&](Index i) { measureCell(this->Mesh, this->Geometry, this->Cells[i]); });
}

//------------------------------------------------------------------------------
void FaceEnergy::addAngle(FaceCost& cost, Index face, const Vec3& d) const
{
  const Vec3& area = this->Geometry.area[face];
  const double size = norm(area), length = norm(d);
  if (!(size > 0 && length > 0))
  {
    return;
  }
  const Vec3 s = (1 / size) * area, e = (1 / length) * d;
  const double cosine = dot(s, e);
  const double limit = 1 - std::cos(this->Options.angle / DegreesPerRadian);
  const double base = std::max(0.0, (1 - cosine) / limit);
  cost.value += std::pow(base, this->Options.power);
  // Derivatives by the cosine, then by the area vector and the line between the centers.
  const double byCosine = -this->Options.power * std::pow(base, this->Options.power - 1) / limit;
  cost.area += (byCosine / size) * (e - cosine * s);
  const Vec3 byD = (byCosine / length) * (s - cosine * e);
  cost.other += byD;
  cost.own -= byD;
}

//------------------------------------------------------------------------------
void FaceEnergy::addSkewness(FaceCost& cost, Index face, const Vec3& d) const
{
  const FaceGeometry& g = this->Geometry;
  const Vec3& area = g.area[face];
  const Vec3 toFace = g.center[face] - g.cellCenter[this->Mesh.owner[face]];
  const double size = norm(area), length = norm(d);
  if (!(size > 0 && length > 0))
  {
    return;
  }
  const double along = dot(area, d), floor = LeastCosine * size * length;
  const bool steep = along < floor;
  const double scale = steep ? floor : along;
  const double fraction = dot(area, toFace) / scale;
  const Vec3 off = toFace - fraction * d;
  const double limit = this->Options.skewness * this->Widths[this->Places[face]];
  const double square = dot(off, off) / (limit * limit);
  const double half = 0.5 * this->Options.skewPower;
  cost.value += this->Options.skewWeight * std::pow(square, half);
  const double bySquare =
    this->Options.skewWeight * half * std::pow(square, half - 1) * 2 / (limit * limit);
  const Vec3 byOff = bySquare * off;
  const double k = dot(d, byOff) / scale;
  const Vec3 byToFace = byOff - k * area;
  Vec3 byD = -fraction * byOff;
  cost.area -= k * toFace;
  // The scale is the component of d, but at least a fraction of its length.
  const double byScale = k * fraction;
  cost.area += steep ? (byScale * LeastCosine * length / size) * area : byScale * d;
  byD += steep ? (byScale * LeastCosine * size / length) * d : byScale * area;
  cost.center += byToFace;
  cost.own -= byToFace;
  cost.other += byD;
  cost.own -= byD;
}

//------------------------------------------------------------------------------
void FaceEnergy::addBoundarySkewness(FaceCost& cost, Index face) const
{
  const FaceGeometry& g = this->Geometry;
  const double size = norm(g.area[face]);
  if (!(size > 0))
  {
    return;
  }
  const Vec3 normal = (1 / size) * g.area[face];
  const Vec3 toFace = g.center[face] - g.cellCenter[this->Mesh.owner[face]];
  const double height = dot(normal, toFace);
  const Vec3 off = toFace - height * normal;
  const double limit = this->Options.skewness * this->Widths[this->Places[face]];
  const double square = dot(off, off) / (limit * limit);
  const double half = 0.5 * this->Options.skewPower;
  cost.value += this->Options.skewWeight * std::pow(square, half);
  const double bySquare =
    this->Options.skewWeight * half * std::pow(square, half - 1) * 2 / (limit * limit);
  const Vec3 byOff = bySquare * off;
  cost.center += byOff;
  cost.own -= byOff;
  cost.area -= (height / size) * byOff;
}

//------------------------------------------------------------------------------
/// psi of a tetrahedron as a function of its relative size, with its derivative; adds the value.
double FaceEnergy::addShrinking(FaceCost& cost, double t) const
{
  cost.least = std::min(cost.least, t);
  const double delta = this->Options.delta, below = this->Options.shrinking - t;
  if (below <= 0)
  {
    return 0;
  }
  if (!(t > 0) && !(delta > 0))
  {
    cost.value = std::numeric_limits<double>::infinity();
    return 0;
  }
  const double root = std::sqrt(t * t + delta * delta);
  const double chi = 0.5 * (t + root), byT = 0.5 * (1 + t / root);
  cost.value += this->Options.weight * below * below / chi;
  return this->Options.weight * (-2 * below / chi - below * below * byT / (chi * chi));
}

//------------------------------------------------------------------------------
/// Adds the tetrahedra of a face and the center of a cell: one for each edge with the center of the
/// face, and for the triangles of a fan.
/// @param side 0: owner, 1: neighbor
void FaceEnergy::addTetrahedra(FaceCost& cost, Index face, int side, const double* points,
  const Vec3& apex, Vec3& byApex, Vec3* nodeBars) const
{
  const double sign = side == 0 ? 1 : -1;
  const Vec3& center = this->Geometry.center[face];
  const Vec3 height = center - apex;
  const Index* nodes = this->Mesh.nodes.data() + this->Mesh.offsets[face];
  const Index size = this->Mesh.size(face);
  const Index first = this->NodeStarts[this->Places[face]];
  for (Index i = 0; i < size; ++i)
  {
    const double reference = this->Volumes[first + i][side];
    if (!(reference > 0))
    {
      continue;
    }
    const Index next = (i + 1) % size;
    const Vec3 a = pointAt(points, nodes[i]);
    const Vec3 edge = pointAt(points, nodes[next]) - a, toCenter = center - a;
    const Vec3 normal = cross(edge, toCenter);
    const double slope = this->addShrinking(cost, sign * dot(normal, height) / reference);
    if (slope != 0)
    {
      const double factor = slope * sign / reference;
      const Vec3 byEdge = factor * cross(toCenter, height);
      const Vec3 byToCenter = factor * cross(height, edge);
      nodeBars[next] += byEdge;
      nodeBars[i] -= byEdge + byToCenter;
      cost.center += byToCenter + factor * normal;
      byApex -= factor * normal;
    }
  }
  const Index base = this->Bases[this->Places[face]];
  const Vec3 p = pointAt(points, nodes[base]) - apex;
  for (Index i = 1; size > 3 && i + 1 < size; ++i)
  {
    const Index k = (base + i) % size, next = (base + i + 1) % size;
    const double reference = this->FanVolumes[first + k][side];
    if (!(reference > 0))
    {
      continue;
    }
    const Vec3 q = pointAt(points, nodes[k]) - apex, r = pointAt(points, nodes[next]) - apex;
    const Vec3 qr = cross(q, r), rp = cross(r, p), pq = cross(p, q);
    const double slope = this->addShrinking(cost, sign * dot(p, qr) / reference);
    if (slope != 0)
    {
      const double factor = slope * sign / reference;
      nodeBars[base] += factor * qr;
      nodeBars[k] += factor * rp;
      nodeBars[next] += factor * pq;
      byApex -= factor * (qr + rp + pq);
    }
  }
}

//------------------------------------------------------------------------------
/// The point of a face that maximizes the smallest tetrahedron of its fan.
Index FaceEnergy::bestBase(Index face, const double* points) const
{
  const FaceGeometry& g = this->Geometry;
  const Index* nodes = this->Mesh.nodes.data() + this->Mesh.offsets[face];
  const Index size = this->Mesh.size(face);
  const Vec3& own = g.cellCenter[this->Mesh.owner[face]];
  const bool internal = this->Mesh.internal(face);
  const Vec3& other = internal ? g.cellCenter[this->Mesh.neighbor[face]] : own;
  double best = -std::numeric_limits<double>::infinity();
  Index found = 0;
  for (Index base = 0; base < size; ++base)
  {
    double least = std::numeric_limits<double>::infinity();
    const Vec3 p = pointAt(points, nodes[base]);
    for (Index i = 1; i + 1 < size && least > best; ++i)
    {
      const Vec3 u = pointAt(points, nodes[(base + i) % size]) - p;
      const Vec3 v = pointAt(points, nodes[(base + i + 1) % size]) - p;
      const Vec3 normal = cross(u, v);
      least = std::min(least, dot(normal, p - own));
      least = internal ? std::min(least, dot(normal, other - p)) : least;
    }
    if (least > best)
    {
      best = least;
      found = base;
    }
  }
  return found;
}

//------------------------------------------------------------------------------
FaceEnergy::FaceCost FaceEnergy::costOf(Index face, const double* points, Vec3* nodeBars) const
{
  const FaceGeometry& g = this->Geometry;
  FaceCost cost;
  std::fill(nodeBars, nodeBars + this->Mesh.size(face), Vec3{ 0, 0, 0 });
  const Vec3& own = g.cellCenter[this->Mesh.owner[face]];
  if (this->Mesh.hasTwoCells(face))
  {
    const Vec3 d = centerAcross(this->Mesh, g, face) - own;
    this->addAngle(cost, face, d);
    this->addSkewness(cost, face, d);
  }
  else
  {
    this->addBoundarySkewness(cost, face);
  }
  this->addTetrahedra(cost, face, 0, points, own, cost.own, nodeBars);
  if (this->Mesh.internal(face) && std::isfinite(cost.value))
  {
    const Vec3& other = g.cellCenter[this->Mesh.neighbor[face]];
    this->addTetrahedra(cost, face, 1, points, other, cost.other, nodeBars);
  }
  return cost;
}

//------------------------------------------------------------------------------
/// The derivative with respect to the center of a cell.
Vec3 FaceEnergy::centerBar(Index cell, const std::vector<FaceCost>& costs) const
{
  Vec3 bar = { 0, 0, 0 };
  for (Index i = this->Mesh.cellOffsets[cell]; i < this->Mesh.cellOffsets[cell + 1]; ++i)
  {
    const Index face = this->Mesh.cellFaces[i];
    const FaceCost& cost = costs[this->Places[face]];
    bar += this->Mesh.owner[face] == cell ? cost.own : cost.other;
    if (!this->Mesh.internal(face) && this->Mesh.coupled(face) >= 0)
    {
      const Index other = this->Mesh.coupled(face);
      bar += alongPatch(this->Mesh, this->Geometry, other, costs[this->Places[other]].other);
    }
  }
  return bar;
}

//------------------------------------------------------------------------------
/// Adds the derivatives with respect to a face that arise through the center of a cell.
void FaceEnergy::addFromCell(Index cell, Index face, FaceBar& bar) const
{
  if (!this->Moves[cell])
  {
    return;
  }
  const FaceGeometry& g = this->Geometry;
  const Index begin = this->Mesh.cellOffsets[cell], end = this->Mesh.cellOffsets[cell + 1];
  const double count = static_cast<double>(end - begin);
  const double volume = 3 * g.volume[cell];
  if (std::abs(volume) < std::numeric_limits<double>::min())
  {
    bar.center += (1 / count) * this->CellBars[cell];
    return;
  }
  const Vec3 apex = apexOf(this->Mesh, g, cell);
  const Vec3& center = g.cellCenter[cell];
  const Vec3 byMoment = (1 / volume) * this->CellBars[cell];
  const double sign = this->Mesh.owner[face] == cell ? 1 : -1;
  const Vec3 height = g.center[face] - apex;
  const double pyramid = sign * dot(g.area[face], height);
  const double byPyramid = dot(byMoment, 0.75 * g.center[face] + 0.25 * apex - center);
  bar.area += (sign * byPyramid) * height;
  bar.center += (sign * byPyramid) * g.area[face] + (0.75 * pyramid) * byMoment;
  bar.center += this->ApexBars[cell];
}

//------------------------------------------------------------------------------
/// The derivatives with respect to the points of a face.
void FaceEnergy::addToNodes(
  Index face, const FaceBar& bar, const double* points, Vec3* nodeBars) const
{
  const Index* nodes = this->Mesh.nodes.data() + this->Mesh.offsets[face];
  const Index size = this->Mesh.size(face);
  if (size == 3)
  {
    const Vec3 a = pointAt(points, nodes[0]);
    const Vec3 u = pointAt(points, nodes[1]) - a, v = pointAt(points, nodes[2]) - a;
    const Vec3 byU = 0.5 * cross(v, bar.area), byV = 0.5 * cross(bar.area, u);
    const Vec3 third = (1.0 / 3) * bar.center;
    nodeBars[0] += third - byU - byV;
    nodeBars[1] += third + byU;
    nodeBars[2] += third + byV;
    return;
  }
  const Vec3 mean = meanOf(nodes, size, points);
  const Vec3& center = this->Geometry.center[face];
  double sum = 0;
  for (Index i = 0; i < size; ++i)
  {
    const Vec3 a = pointAt(points, nodes[i]), b = pointAt(points, nodes[(i + 1) % size]);
    sum += norm(cross(b - a, mean - a));
  }
  if (!(sum > 0))
  {
    for (Index i = 0; i < size; ++i)
    {
      nodeBars[i] += (1.0 / static_cast<double>(size)) * bar.center;
    }
    return;
  }
  Vec3 byMean = { 0, 0, 0 };
  for (Index i = 0; i < size; ++i)
  {
    const Index next = (i + 1) % size;
    const Vec3 a = pointAt(points, nodes[i]), b = pointAt(points, nodes[next]);
    const Vec3 edge = b - a, height = mean - a, triangle = cross(edge, height);
    const double weight = norm(triangle);
    Vec3 byTriangle = 0.5 * bar.area;
    if (weight > 0)
    {
      const double byWeight = dot(bar.center, (1.0 / 3) * (a + b + mean) - center) / sum;
      byTriangle += (byWeight / weight) * triangle;
    }
    const Vec3 byEdge = cross(height, byTriangle), byHeight = cross(byTriangle, edge);
    const Vec3 share = (weight / (3 * sum)) * bar.center;
    nodeBars[next] += byEdge + share;
    nodeBars[i] += share - byEdge - byHeight;
    byMean += byHeight + share;
  }
  const Vec3 each = (1.0 / static_cast<double>(size)) * byMean;
  for (Index i = 0; i < size; ++i)
  {
    nodeBars[i] += each;
  }
}

//------------------------------------------------------------------------------
double FaceEnergy::evaluate(const double* points, double* gradient)
{
  this->measure(points);
  const Index faces = static_cast<Index>(this->Faces.size());
  std::vector<FaceCost> costs(faces);
  parallelFor(faces, Grain, this->Options.threads,
    [&](Index i) {
      costs[i] = this->costOf(this->Faces[i], points, this->NodeBars.data() + this->NodeStarts[i]);
    });
  double value = 0;
  this->Least = 1;
  for (const FaceCost& cost : costs)
  {
    value += cost.value;
    this->Least = std::min(this->Least, cost.least);
  }
  if (!gradient || !std::isfinite(value))
  {
    return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
  }

  // Propagate derivatives from the centers of the cells to the apexes of their pyramids.
  const FaceGeometry& g = this->Geometry;
  parallelFor(static_cast<Index>(this->Cells.size()), Grain, this->Options.threads,
    [&](Index i)
    {
      const Index cell = this->Cells[i];
      const Vec3 bar = this->centerBar(cell, costs);
      this->CellBars[cell] = bar;
      const double volume = 3 * g.volume[cell];
      const Vec3 apex = apexOf(this->Mesh, g, cell);
      const Index begin = this->Mesh.cellOffsets[cell], end = this->Mesh.cellOffsets[cell + 1];
      Vec3 byApex = 0.25 * bar;
      for (Index k = begin; k < end; ++k)
      {
        const Index face = this->Mesh.cellFaces[k];
        const double sign = this->Mesh.owner[face] == cell ? 1 : -1;
        const double byPyramid =
          dot(bar, 0.75 * g.center[face] + 0.25 * apex - g.cellCenter[cell]) / volume;
        byApex -= (sign * byPyramid) * g.area[face];
      }
      this->ApexBars[cell] = (1.0 / static_cast<double>(end - begin)) * byApex;
    });

  // Propagate derivatives from the centers and the faces to the points.
  parallelFor(faces, Grain, this->Options.threads,
    [&](Index i)
    {
      const Index face = this->Faces[i];
      FaceBar bar = { costs[i].area, costs[i].center };
      this->addFromCell(this->Mesh.owner[face], face, bar);
      if (this->Mesh.internal(face))
      {
        this->addFromCell(this->Mesh.neighbor[face], face, bar);
      }
      this->addToNodes(face, bar, points, this->NodeBars.data() + this->NodeStarts[i]);
    });
  parallelFor(static_cast<Index>(this->Points.size()), Grain, this->Options.threads,
    [&](Index i)
    {
      Vec3 sum = { 0, 0, 0 };
      for (Index k = this->UseStarts[i]; k < this->UseStarts[i + 1]; ++k)
      {
        sum += this->NodeBars[this->Uses[k]];
      }
      std::copy(sum.begin(), sum.end(), gradient + 3 * i);
    });
  return value;
}
}
