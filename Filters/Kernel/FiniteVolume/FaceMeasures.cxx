// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceMeasures.cxx
 * @brief The formulas. Their sources are in MetricRegistry.cxx; the small numbers below are
 * OpenFOAM's, whose values are reproduced to rounding.
 */
#include "FaceMeasures.h"

#include "FaceShape.h"
#include "TetQuality.h"
#include "tautline/Core/Parallel.h"

#include <limits>

namespace tautline
{
namespace
{
/// Added to denominators that may vanish.
constexpr double Least = 1e-150;
constexpr double LeastVolume = 1e-300;
constexpr double LeastLength = 1e-15;

/// A component of a mean normal below this does not remove a direction.
constexpr double DirectionTolerance = 1e-6;

/// The sine of the smallest angle between two edges of a face that forms a corner: 10 degrees.
const double LeastTurn = std::sin(10 / DegreesPerRadian);

/// The minimum width as a fraction of the mean distance from the face.
constexpr double InternalWidth = 0.2, BoundaryWidth = 0.4;

/// The determinants of a cube: for six internal faces, and for all faces weighted by area.
constexpr double CubeDeterminant = 8, CubeAreaDeterminant = 1.0 / 27;

/// A coordinate-axis normal has one component above this.
constexpr double HalfComponent = 0.5;

Vec3 unit(const Vec3& v)
{
  const double size = norm(v);
  return size > 0 ? (1 / size) * v : v;
}

void removeDirections(std::array<bool, 3>& directions, const Vec3& sum, bool resetOthers)
{
  const Vec3 mean = unit(sum);
  for (int c = 0; c < 3; ++c)
  {
    const bool removed = std::abs(mean[c]) > DirectionTolerance;
    directions[c] = !removed && (resetOthers || directions[c]);
  }
}

Vec3 magnitudes(const Vec3& v)
{
  return { std::abs(v[0]), std::abs(v[1]), std::abs(v[2]) };
}

/// Unit normal of the coordinate plane about which a wedge is symmetric.
Vec3 centerNormal(const Vec3& normal)
{
  Vec3 axis;
  for (int c = 0; c < 3; ++c)
  {
    axis[c] =
      std::copysign(std::max(std::abs(normal[c]), HalfComponent) - HalfComponent, normal[c]);
  }
  return unit(axis);
}

FaceDirections directionsOf(const DirectionSums& sums)
{
  FaceDirections directions;
  if (norm(sums.empty) > 0)
  {
    removeDirections(directions.solution, sums.empty, false);
  }
  directions.geometric = directions.solution;
  if (norm(sums.wedge) > 0)
  {
    removeDirections(directions.geometric, sums.wedge, true);
  }
  return directions;
}

double determinant3(const std::array<Vec3, 3>& rows)
{
  return dot(rows[0], cross(rows[1], rows[2]));
}

void addSquare(std::array<Vec3, 3>& tensor, const Vec3& v, double weight)
{
  for (int i = 0; i < 3; ++i)
  {
    tensor[i] += weight * v[i] * v;
  }
}
}

//------------------------------------------------------------------------------
FaceMeasures::FaceMeasures(
  const FaceMesh& mesh, const double* points, FaceConvention convention, int threads)
  : Mesh(mesh)
  , Points(points)
  , Geometry(faceGeometry(mesh, points, convention, threads))
  , Threads(threads)
{
  FaceExtent extent;
  for (Index point = 0; point < mesh.points; ++point)
  {
    extent.add(pointAt(points, point));
  }
  this->setWhole(extent, this->directionSums());
}

//------------------------------------------------------------------------------
DirectionSums FaceMeasures::directionSums() const
{
  DirectionSums sums;
  for (const FacePatch& patch : this->Mesh.patches)
  {
    Vec3 sum = { 0, 0, 0 };
    for (Index face = patch.first; face < patch.first + patch.count; ++face)
    {
      const Vec3& area = this->Geometry.area[face];
      const bool own = this->Mesh.ownsFace(face);
      sum += own ? area : Vec3{ 0, 0, 0 };
      sums.empty += own && patch.isEmpty() ? magnitudes(area) : Vec3{ 0, 0, 0 };
    }
    sums.wedge += patch.isWedge() ? magnitudes(centerNormal(unit(sum))) : Vec3{ 0, 0, 0 };
  }
  return sums;
}

//------------------------------------------------------------------------------
void FaceMeasures::setWhole(const FaceExtent& extent, const DirectionSums& sums)
{
  this->Extent = extent;
  this->Directions = directionsOf(sums);
}

//------------------------------------------------------------------------------
template <class Visit>
void FaceMeasures::forEachFaceOf(Index cell, const Visit& visit) const
{
  for (Index i = this->Mesh.cellOffsets[cell]; i < this->Mesh.cellOffsets[cell + 1]; ++i)
  {
    const Index face = this->Mesh.cellFaces[i];
    visit(face, this->Mesh.owner[face] == cell ? 1.0 : -1.0);
  }
}

//------------------------------------------------------------------------------
std::vector<std::array<double, 2>> FaceMeasures::allSides(Metric metric) const
{
  std::vector<std::array<double, 2>> both(this->Mesh.faces());
  parallelFor(this->Mesh.faces(), ChunkSize, this->Threads,
    [&](Index face) { both[face] = this->sidesOf(metric, face); });
  return both;
}

//------------------------------------------------------------------------------
std::vector<std::array<double, 2>> FaceMeasures::centerTetQualities() const
{
  return this->allSides(Metric::CenterTetQuality);
}

//------------------------------------------------------------------------------
FaceValues FaceMeasures::ofFaces(Metric metric) const
{
  const bool smaller = metricInfo(metric).direction == Direction::SmallerIsBetter;
  const auto worse = [smaller](double a, double b)
  { return smaller ? std::max(a, b) : std::min(a, b); };
  const std::vector<std::array<double, 2>> both = this->allSides(metric);
  FaceValues values;
  values.cells.resize(this->Mesh.cells);
  parallelFor(this->Mesh.cells, ChunkSize, this->Threads,
    [&](Index cell)
    {
      constexpr double infinity = std::numeric_limits<double>::infinity();
      double worst = smaller ? -infinity : infinity;
      this->forEachFaceOf(
        cell, [&](Index face, double sign) { worst = worse(worst, both[face][sign > 0 ? 0 : 1]); });
      values.cells[cell] = worst;
    });
  values.faces.resize(this->Mesh.faces());
  parallelFor(this->Mesh.faces(), ChunkSize, this->Threads,
    [&](Index face) { values.faces[face] = worse(both[face][0], both[face][1]); });
  return values;
}

//------------------------------------------------------------------------------
template <class Value>
FaceValues FaceMeasures::ofCells(const Value& value) const
{
  FaceValues values;
  values.cells.resize(this->Mesh.cells);
  parallelFor(this->Mesh.cells, ChunkSize, this->Threads,
    [&](Index cell) { values.cells[cell] = value(cell); });
  return values;
}

//------------------------------------------------------------------------------
FaceValues FaceMeasures::evaluate(Metric metric) const
{
  switch (metric)
  {
    case Metric::CellVolume:
      return { this->Geometry.volume, {} };
    case Metric::Openness:
      return this->ofCells([this](Index cell) { return this->openness(cell); });
    case Metric::CellAspectRatio:
      return this->ofCells([this](Index cell) { return this->aspectRatio(cell); });
    case Metric::CellDeterminant:
      return this->ofCells([this](Index cell) { return this->determinant(cell); });
    case Metric::AreaDeterminant:
      return this->ofCells([this](Index cell) { return this->areaDeterminant(cell); });
    case Metric::CellConcavity:
      return this->ofCells([this](Index cell) { return this->cellConcavity(cell); });
    default:
      if (metricInfo(metric).family != MetricFamily::Faces)
      {
        throw Error(std::string("The metric ") + metricInfo(metric).name +
          " is defined for elements, not for faces between cells.");
      }
      return this->ofFaces(metric);
  }
}

//------------------------------------------------------------------------------
/// The values of a face as seen from its owner and from its neighbor.
std::array<double, 2> FaceMeasures::sidesOf(Metric metric, Index face) const
{
  const FaceGeometry& g = this->Geometry;
  const bool internal = this->Mesh.internal(face), two = this->Mesh.hasTwoCells(face);
  const auto both = [](double value) { return std::array<double, 2>{ value, value }; };
  const auto sided = [&](const auto& value)
  {
    const double own = value(this->Mesh.owner[face], 1.0);
    return std::array<double, 2>{ own, internal ? value(this->Mesh.neighbor[face], -1.0) : own };
  };
  switch (metric)
  {
    case Metric::NonOrthogonality:
      return both(two ? std::acos(std::min(1.0, this->cosineAcross(face))) * DegreesPerRadian : 0);
    case Metric::FaceSkewness:
      return both(two ? this->skewness(face) : this->boundarySkewness(face));
    case Metric::InternalSkewness:
      return both(two ? this->skewness(face) : 0);
    case Metric::BoundarySkewness:
      return both(two ? 0 : this->boundarySkewness(face));
    case Metric::PyramidVolume:
      return sided([&](Index cell, double sign)
        { return sign / 3 * dot(g.area[face], g.center[face] - g.cellCenter[cell]); });
    case Metric::FaceArea:
      return both(norm(g.area[face]));
    case Metric::FaceFlatness:
      return both(this->flatness(face));
    case Metric::FaceConcavity:
      return both(std::asin(std::min(1.0, this->concavity(face))) * DegreesPerRadian);
    case Metric::FaceTwist:
      return both(this->twist(face));
    case Metric::FaceWeight:
    {
      const auto [own, other] = this->distances(face);
      return both(two ? std::min(own, other) / (own + other + LeastVolume) : 0.5);
    }
    case Metric::VolumeRatio:
    {
      const double own = g.volume[this->Mesh.owner[face]];
      const double other = !two ? own
        : internal              ? g.volume[this->Mesh.neighbor[face]]
                                : g.volume[this->Mesh.owner[this->Mesh.coupled(face)]];
      return both(two ? std::min(own, other) / (std::max(own, other) + LeastVolume) : 1);
    }
    case Metric::CenterTetQuality:
      return sided([&](Index cell, double sign)
        { return this->centerTetQuality(face, g.cellCenter[cell], sign); });
    case Metric::FanTetQuality:
      return both(this->fanTetQuality(face));
    case Metric::OrthogonalQuality:
      return sided([&](Index cell, double sign) { return this->orthogonality(face, cell, sign); });
    default:
      return both(0);
  }
}

//------------------------------------------------------------------------------
double FaceMeasures::cosineAcross(Index face) const
{
  const Vec3& area = this->Geometry.area[face];
  const Vec3 d = centerAcross(this->Mesh, this->Geometry, face) -
    this->Geometry.cellCenter[this->Mesh.owner[face]];
  return dot(d, area) / (norm(d) * norm(area) + Least);
}

//------------------------------------------------------------------------------
/// The extent of a face from its center along a direction.
double FaceMeasures::width(Index face, const Vec3& direction) const
{
  double widest = 0;
  for (Index i = this->Mesh.offsets[face]; i < this->Mesh.offsets[face + 1]; ++i)
  {
    const Vec3 p = pointAt(this->Points, this->Mesh.nodes[i]);
    widest = std::max(widest, std::abs(dot(direction, p - this->Geometry.center[face])));
  }
  return widest;
}

//------------------------------------------------------------------------------
/// The distance of the line between the cell centers from the face center, over the width of the
/// face.
double FaceMeasures::skewness(Index face) const
{
  const FaceGeometry& g = this->Geometry;
  const Vec3& own = g.cellCenter[this->Mesh.owner[face]];
  const Vec3 toFace = g.center[face] - own;
  const Vec3 d = centerAcross(this->Mesh, g, face) - own;
  const Vec3 off = toFace - (dot(g.area[face], toFace) / (dot(g.area[face], d) + Least)) * d;
  const double size = norm(off);
  const double wide = this->width(face, (1 / (size + Least)) * off);
  return size / std::max(InternalWidth * norm(d) + Least, wide);
}

//------------------------------------------------------------------------------
double FaceMeasures::boundarySkewness(Index face) const
{
  const FaceGeometry& g = this->Geometry;
  const Vec3 toFace = g.center[face] - g.cellCenter[this->Mesh.owner[face]];
  const Vec3 normal = unit(g.area[face]);
  const Vec3 d = dot(normal, toFace) * normal;
  const Vec3 off = toFace - (dot(g.area[face], toFace) / (dot(g.area[face], d) + Least)) * d;
  const double size = norm(off);
  const double wide = this->width(face, (1 / (size + Least)) * off);
  return size / std::max(BoundaryWidth * norm(d) + Least, wide);
}

//------------------------------------------------------------------------------
/// The distances of the owner and of the cell across from the face, times its area; negative if the
/// cell center is beyond the face.
std::array<double, 2> FaceMeasures::signedDistances(Index face) const
{
  if (!this->Mesh.hasTwoCells(face))
  {
    return { 0, 0 };
  }
  const FaceGeometry& g = this->Geometry;
  const Vec3& own = g.cellCenter[this->Mesh.owner[face]];
  return { dot(g.area[face], g.center[face] - own),
    dot(g.area[face], centerAcross(this->Mesh, g, face) - g.center[face]) };
}

//------------------------------------------------------------------------------
std::array<double, 2> FaceMeasures::distances(Index face) const
{
  const auto [own, other] = this->signedDistances(face);
  return { std::abs(own), std::abs(other) };
}

//------------------------------------------------------------------------------
std::vector<double> FaceMeasures::ownerWeights() const
{
  std::vector<double> weights(this->Mesh.faces(), 1.0);
  parallelFor(this->Mesh.faces(), ChunkSize, this->Threads,
    [&](Index face)
    {
      // As in OpenFOAM, distances are signed at coupled patches and unsigned at internal faces.
      const bool inside = this->Mesh.internal(face) || this->Mesh.has(face, OnBorder);
      const auto [own, other] = inside ? this->distances(face) : this->signedDistances(face);
      weights[face] = own + other != 0 ? other / (own + other) : 1.0;
    });
  return weights;
}

//------------------------------------------------------------------------------
double FaceMeasures::flatness(Index face) const
{
  if (this->Mesh.size(face) == 3)
  {
    return 1;
  }
  double sum = 0;
  forEachEdge(this->Mesh.nodes.data() + this->Mesh.offsets[face], this->Mesh.size(face),
    this->Points,
    [&](const Vec3& a, const Vec3& b)
    { sum += 0.5 * norm(cross(b - a, this->Geometry.center[face] - a)); });
  const double size = norm(this->Geometry.area[face]);
  return size > LeastVolume ? size / (sum + Least) : 0;
}

//------------------------------------------------------------------------------
/// The largest sine of a reversed turn of the edges; 0 for a convex face.
double FaceMeasures::concavity(Index face) const
{
  const Index size = this->Mesh.size(face), first = this->Mesh.offsets[face];
  const auto point = [&](Index i)
  { return pointAt(this->Points, this->Mesh.nodes[first + i % size]); };
  const Vec3 normal = unit(this->Geometry.area[face]);
  double largest = 0;
  for (Index i = 0; i < size; ++i)
  {
    const Vec3 before = point(i) - point(i + size - 1), after = point(i + 1) - point(i);
    const double lengths[] = { norm(before), norm(after) };
    if (!(lengths[0] > LeastLength && lengths[1] > LeastLength))
    {
      continue;
    }
    const Vec3 turn = cross((1 / lengths[0]) * before, (1 / lengths[1]) * after);
    const double sine = norm(turn);
    if (sine >= LeastTurn && dot((1 / sine) * turn, normal) < LeastLength)
    {
      largest = std::max(largest, sine);
    }
  }
  return largest;
}

//------------------------------------------------------------------------------
/// The smallest cosine between the normal of a triangle of the face and the direction across it.
double FaceMeasures::twist(Index face) const
{
  if (this->Mesh.size(face) == 3)
  {
    return 1;
  }
  const FaceGeometry& g = this->Geometry;
  const Vec3& own = g.cellCenter[this->Mesh.owner[face]];
  const Vec3 across =
    unit((this->Mesh.hasTwoCells(face) ? centerAcross(this->Mesh, g, face) : g.center[face]) - own);
  double least = 1;
  forEachEdge(this->Mesh.nodes.data() + this->Mesh.offsets[face], this->Mesh.size(face),
    this->Points,
    [&](const Vec3& a, const Vec3& b)
    {
      const Vec3 triangle = 0.5 * cross(b - a, g.center[face] - a);
      const double size = norm(triangle);
      least = size > LeastVolume ? std::min(least, dot(triangle, across) / size) : least;
    });
  return least;
}

//------------------------------------------------------------------------------
double FaceMeasures::centerTetQuality(Index face, const Vec3& center, double sign) const
{
  double least = std::numeric_limits<double>::infinity();
  forEachEdge(this->Mesh.nodes.data() + this->Mesh.offsets[face], this->Mesh.size(face),
    this->Points,
    [&](const Vec3& a, const Vec3& b)
    {
      const double q = sign * tetQuality(a, b, center, this->Geometry.center[face]);
      least = std::min(least, q);
    });
  return least;
}

//------------------------------------------------------------------------------
/// The smallest quality of the tetrahedra over a fan of triangles from a point of the face,
/// maximized over the point.
double FaceMeasures::fanTetQuality(Index face) const
{
  const Index size = this->Mesh.size(face), first = this->Mesh.offsets[face];
  const auto point = [&](Index i)
  { return pointAt(this->Points, this->Mesh.nodes[first + i % size]); };
  const Vec3& own = this->Geometry.cellCenter[this->Mesh.owner[face]];
  const bool two = this->Mesh.hasTwoCells(face);
  const Vec3 other = two ? centerAcross(this->Mesh, this->Geometry, face) : own;
  double best = -std::numeric_limits<double>::infinity();
  for (Index base = 0; base < size; ++base)
  {
    const Vec3 p = point(base);
    double least = std::numeric_limits<double>::infinity();
    for (Index i = 1; i + 1 < size && least > best; ++i)
    {
      const Vec3 a = point(base + i), b = point(base + i + 1);
      least = std::min(least, tetQuality(own, p, a, b));
      least = two ? std::min(least, tetQuality(other, p, b, a)) : least;
    }
    best = std::max(best, least);
  }
  return best;
}

//------------------------------------------------------------------------------
double FaceMeasures::orthogonality(Index face, Index cell, double sign) const
{
  const FaceGeometry& g = this->Geometry;
  const Vec3 normal = sign * unit(g.area[face]);
  const double toFace = dot(normal, unit(g.center[face] - g.cellCenter[cell]));
  return this->Mesh.hasTwoCells(face) ? std::min(toFace, this->cosineAcross(face)) : toFace;
}

//------------------------------------------------------------------------------
double FaceMeasures::openness(Index cell) const
{
  Vec3 sum = { 0, 0, 0 }, size = { 0, 0, 0 };
  this->forEachFaceOf(cell,
    [&](Index face, double sign)
    {
      sum += sign * this->Geometry.area[face];
      size += magnitudes(this->Geometry.area[face]);
    });
  double open = 0;
  for (int c = 0; c < 3; ++c)
  {
    open = std::max(open, std::abs(sum[c]) / (size[c] + Least));
  }
  return open;
}

//------------------------------------------------------------------------------
double FaceMeasures::aspectRatio(Index cell) const
{
  Vec3 size = { 0, 0, 0 };
  this->forEachFaceOf(
    cell, [&](Index face, double) { size += magnitudes(this->Geometry.area[face]); });
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (int c = 0; c < 3; ++c)
  {
    if (this->Directions.geometric[c])
    {
      least = std::min(least, size[c]);
      most = std::max(most, size[c]);
    }
  }
  const double ratio = most / (least + Least);
  if (this->Directions.count() < 3)
  {
    return this->Directions.count() < 2 ? 1 : ratio;
  }
  const double volume = std::max(Least, this->Geometry.volume[cell]);
  return std::max(ratio, (size[0] + size[1] + size[2]) / 6 / std::pow(volume, 2.0 / 3));
}

//------------------------------------------------------------------------------
double FaceMeasures::determinant(Index cell) const
{
  const int directions = this->Directions.count();
  if (directions == 1)
  {
    return 1;
  }
  double sum = 0;
  Index count = 0;
  this->forEachFaceOf(cell,
    [&](Index face, double)
    {
      sum += this->Mesh.hasTwoCells(face) ? norm(this->Geometry.area[face]) : 0;
      count += this->Mesh.hasTwoCells(face);
    });
  if (count == 0 || sum < Least)
  {
    return 0;
  }
  const double mean = sum / static_cast<double>(count);
  std::array<Vec3, 3> tensor = {};
  this->forEachFaceOf(cell,
    [&](Index face, double)
    {
      if (this->Mesh.hasTwoCells(face))
      {
        addSquare(tensor, (1 / mean) * this->Geometry.area[face], 1);
      }
    });
  if (directions == 2)
  {
    for (int c = 0; c < 3; ++c)
    {
      tensor[c][c] = this->Directions.geometric[c] ? tensor[c][c] : 1;
    }
  }
  return std::abs(determinant3(tensor)) / CubeDeterminant;
}

//------------------------------------------------------------------------------
double FaceMeasures::areaDeterminant(Index cell) const
{
  std::array<Vec3, 3> tensor = {};
  double sum = 0;
  this->forEachFaceOf(cell,
    [&](Index face, double)
    {
      const double size = norm(this->Geometry.area[face]);
      addSquare(tensor, this->Geometry.area[face], 1 / (size + LeastVolume));
      sum += size;
    });
  for (Vec3& row : tensor)
  {
    row = (1 / (sum + LeastVolume)) * row;
  }
  return determinant3(tensor) / CubeAreaDeterminant;
}

//------------------------------------------------------------------------------
/// The largest sine of the angle by which a face center lies outside the plane of another face.
double FaceMeasures::cellConcavity(Index cell) const
{
  double largest = -1;
  this->forEachFaceOf(cell,
    [&](Index face, double sign)
    {
      const Vec3 normal = sign * unit(this->Geometry.area[face]);
      this->forEachFaceOf(cell,
        [&](Index other, double)
        {
          const Vec3 to = this->Geometry.center[other] - this->Geometry.center[face];
          largest = other == face
            ? largest
            : std::max(largest, dot(to, normal) / std::max(norm(to), LeastVolume));
        });
    });
  return largest;
}

//------------------------------------------------------------------------------
std::vector<signed char> FaceMeasures::validity() const
{
  const std::vector<double> pyramids = this->evaluate(Metric::PyramidVolume).cells;
  std::vector<signed char> validity(this->Mesh.cells);
  for (Index cell = 0; cell < this->Mesh.cells; ++cell)
  {
    const double least = std::min(pyramids[cell], this->Geometry.volume[cell]);
    validity[cell] = !std::isfinite(least) ? NonFinite
      : least > 0                          ? Valid
      : least < 0                          ? Inverted
                                           : Degenerate;
  }
  return validity;
}
}
