// SPDX-License-Identifier: BSD-3-Clause
#include "TransferLocator.h"

#include "TransferOverlaps.h"

#include "tautline/Boundary/SurfaceProjection.h"

#include <algorithm>

namespace tautline
{
namespace
{
std::vector<BoundingBox> boxesOfSimplices(const TransferMesh& mesh)
{
  std::vector<BoundingBox> boxes;
  for (Index s = 0; s < mesh.numberOfSimplices(); ++s)
  {
    pollInterruption(s);
    boxes.push_back(boxOf(mesh, s));
    if (mesh.dimension() == 2)
    {
      boxes.back().widen(0.25 * longestEdge(mesh, s)); // for nearby surfaces
    }
  }
  return boxes;
}

std::vector<Index> usedPoints(const TransferMesh& mesh)
{
  std::vector<unsigned char> used(mesh.points().size(), 0);
  for (const TransferMesh::Simplex& s : mesh.simplices())
  {
    for (int k = 0; k < mesh.corners(); ++k)
    {
      used[s[k]] = 1;
    }
  }
  std::vector<Index> points;
  for (Index p = 0; p < mesh.numberOfPoints(); ++p)
  {
    if (used[p])
    {
      points.push_back(p);
    }
  }
  return points;
}

std::vector<BoundingBox> boxesOfPoints(const TransferMesh& mesh, const std::vector<Index>& points)
{
  std::vector<BoundingBox> boxes(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    boxes[i].add(mesh.points()[points[i]]);
  }
  return boxes;
}

/// Barycentric coordinates as weights: at least 0, their sum is 1.
template <class Coordinates>
std::array<double, 4> weightsOf(const Coordinates& coordinates)
{
  std::array<double, 4> weights = { 0, 0, 0, 0 };
  double sum = 0.0;
  for (std::size_t k = 0; k < coordinates.size(); ++k)
  {
    weights[k] = std::max(0.0, coordinates[k]);
    sum += weights[k];
  }
  for (std::size_t k = 0; k < coordinates.size(); ++k)
  {
    weights[k] = sum > 0.0 ? weights[k] / sum : 1.0 / static_cast<double>(coordinates.size());
  }
  return weights;
}

/// Limits a position so that its distances from the simplices are finite.
Vec3 limited(Vec3 x)
{
  constexpr double farthest = TransferMesh::FarthestCoordinate;
  for (double& coordinate : x)
  {
    coordinate = std::clamp(coordinate, -farthest, farthest);
  }
  return x;
}

SimplexCorners<4> tetrahedronAt(const TransferMesh& mesh, Index simplex)
{
  SimplexCorners<4> x;
  for (int k = 0; k < 4; ++k)
  {
    x[k] = mesh.points()[mesh.simplices()[simplex][k]];
  }
  return x;
}
}

//------------------------------------------------------------------------------
TransferLocator::TransferLocator(const TransferMesh& mesh)
  : Mesh(mesh)
  , Tree(boxesOfSimplices(mesh))
  , Used(usedPoints(mesh))
  , Points(boxesOfPoints(mesh, this->Used))
{
}

//------------------------------------------------------------------------------
double TransferLocator::squaredDistance(Index simplex, const Vec3& x, Vec3& place) const
{
  const TransferMesh::Simplex& s = this->Mesh.simplices()[simplex];
  const std::vector<Vec3>& points = this->Mesh.points();
  if (s[3] < 0)
  {
    place = closestOnTriangle({ points[s[0]], points[s[1]], points[s[2]] }, x);
    return dot(place - x, place - x);
  }
  const SimplexCorners<4> corners = tetrahedronAt(this->Mesh, simplex);
  const auto inside = BarycentricFunctions<4>(corners, simplexSize(corners)).at(x);
  place = x;
  double least = std::numeric_limits<double>::infinity();
  bool outside = false;
  for (int k = 0; k < 4; ++k)
  {
    if (inside[k] < 0.0) // the nearest position is on a face that x is beyond
    {
      const Vec3 on =
        closestOnTriangle({ corners[(k + 1) % 4], corners[(k + 2) % 4], corners[(k + 3) % 4] }, x);
      const double distance = dot(on - x, on - x);
      place = distance < least ? on : place;
      least = std::min(least, distance);
      outside = true;
    }
  }
  return outside ? least : 0.0;
}

//------------------------------------------------------------------------------
TransferPlace TransferLocator::nearest(const Vec3& given) const
{
  TransferPlace result;
  const Vec3 x = limited(given);
  Vec3 place = x;
  result.simplex =
    this->Tree.nearest(x, [&](Index s) { return this->squaredDistance(s, x, place); });
  // The search leaves the position of its last candidate, so the nearest one is computed again.
  this->squaredDistance(result.simplex, x, place);
  const TransferMesh::Simplex& s = this->Mesh.simplices()[result.simplex];
  if (s[3] >= 0)
  {
    const SimplexCorners<4> corners = tetrahedronAt(this->Mesh, result.simplex);
    result.weights = weightsOf(BarycentricFunctions<4>(corners, simplexSize(corners)).at(place));
    return result;
  }
  const Vec3 &a = this->Mesh.points()[s[0]], &b = this->Mesh.points()[s[1]],
             &c = this->Mesh.points()[s[2]];
  const Vec3 normal = cross(b - a, c - a);
  // Barycentric coordinates are proportional to the signed areas of the three partial triangles.
  result.weights = weightsOf(std::array<double, 3>{ dot(normal, cross(c - b, place - b)),
    dot(normal, cross(a - c, place - c)), dot(normal, cross(b - a, place - a)) });
  return result;
}

//------------------------------------------------------------------------------
Index TransferLocator::nearestPoint(const Vec3& given) const
{
  const Vec3 x = limited(given);
  const Index found = this->Points.nearest(x,
    [&](Index i)
    {
      const Vec3 d = this->Mesh.points()[this->Used[i]] - x;
      return dot(d, d);
    });
  return this->Used[found];
}
}
