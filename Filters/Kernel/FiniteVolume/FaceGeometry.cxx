// SPDX-License-Identifier: BSD-3-Clause
#include "FaceGeometry.h"

#include "FaceShape.h"
#include "tautline/Core/Parallel.h"

namespace tautline
{
namespace
{
/// Cells of smaller volume have their center at the mean of those of their faces.
constexpr double NoVolume = 1e-300;

/// Moves a point as the least rotation that takes `from` to `to`, both of length 1, moves it about
/// the origin.
Vec3 rotated(const Vec3& point, const Vec3& from, const Vec3& to)
{
  // Rodrigues' formula with the axis from x to, whose length is the sine of the angle.
  const Vec3 axis = cross(from, to);
  const double cosine = dot(from, to);
  return cosine * point + cross(axis, point) + (dot(axis, point) / (1 + cosine)) * axis;
}
}

//------------------------------------------------------------------------------
Vec3 apexOf(const FaceMesh& mesh, const FaceGeometry& geometry, Index cell)
{
  const Index begin = mesh.cellOffsets[cell], end = mesh.cellOffsets[cell + 1];
  Vec3 sum = { 0, 0, 0 };
  for (Index i = begin; i < end; ++i)
  {
    sum += geometry.center[mesh.cellFaces[i]];
  }
  return (1.0 / static_cast<double>(end - begin)) * sum;
}

//------------------------------------------------------------------------------
void measureCell(const FaceMesh& mesh, FaceGeometry& geometry, Index cell)
{
  const Index begin = mesh.cellOffsets[cell], end = mesh.cellOffsets[cell + 1];
  const Vec3 apex = apexOf(mesh, geometry, cell);
  double volume = 0;
  Vec3 moment = { 0, 0, 0 };
  for (Index i = begin; i < end; ++i)
  {
    const Index face = mesh.cellFaces[i];
    const double out = mesh.owner[face] == cell ? 1 : -1;
    // Three times the volume of the pyramid.
    const double pyramid = out * dot(geometry.area[face], geometry.center[face] - apex);
    volume += pyramid;
    moment += pyramid * (0.75 * geometry.center[face] + 0.25 * apex);
  }
  geometry.cellCenter[cell] = std::abs(volume) > NoVolume ? (1 / volume) * moment : apex;
  geometry.volume[cell] = volume / 3;
}

//------------------------------------------------------------------------------
FaceGeometry faceGeometry(
  const FaceMesh& mesh, const double* points, FaceConvention convention, int threads)
{
  FaceGeometry geometry;
  geometry.area.resize(mesh.faces());
  geometry.center.resize(mesh.faces());
  parallelFor(mesh.faces(), ChunkSize, threads,
    [&](Index face)
    {
      const FaceShape shape =
        faceShape(mesh.nodes.data() + mesh.offsets[face], mesh.size(face), points, convention);
      geometry.area[face] = shape.area;
      geometry.center[face] = shape.center;
    });
  geometry.cellCenter.resize(mesh.cells);
  geometry.volume.resize(mesh.cells);
  parallelFor(
    mesh.cells, ChunkSize, threads, [&](Index cell) { measureCell(mesh, geometry, cell); });
  return geometry;
}

namespace
{
/// The unit normals of a face and of its coupled one, the latter into its cell; false if a face has
/// no area, or if both are parallel up to the accuracy of written points: there is no rotation.
bool isTurned(
  const FaceMesh& mesh, const FaceGeometry& geometry, Index face, Vec3& normal, Vec3& back)
{
  const Index other = mesh.coupled(face);
  const double size = norm(geometry.area[face]), otherSize = norm(geometry.area[other]);
  constexpr double parallel = 1e-8;
  if (!(size > 0 && otherSize > 0))
  {
    return false;
  }
  normal = (1 / size) * geometry.area[face];
  back = (-1 / otherSize) * geometry.area[other];
  return norm(cross(normal, back)) >= parallel;
}
}

//------------------------------------------------------------------------------
Vec3 acrossPatch(const FaceMesh& mesh, const FaceGeometry& geometry, Index face, const Vec3& place)
{
  const Vec3 from = place - geometry.center[mesh.coupled(face)];
  Vec3 normal, back;
  return geometry.center[face] +
    (isTurned(mesh, geometry, face, normal, back) ? rotated(from, back, normal) : from);
}

//------------------------------------------------------------------------------
Vec3 alongPatch(const FaceMesh& mesh, const FaceGeometry& geometry, Index face, const Vec3& vector)
{
  Vec3 normal, back;
  return isTurned(mesh, geometry, face, normal, back) ? rotated(vector, normal, back) : vector;
}

//------------------------------------------------------------------------------
Vec3 centerAcross(const FaceMesh& mesh, const FaceGeometry& geometry, Index face)
{
  return mesh.internal(face)
    ? geometry.cellCenter[mesh.neighbor[face]]
    : acrossPatch(mesh, geometry, face, geometry.cellCenter[mesh.owner[mesh.coupled(face)]]);
}
}
