// SPDX-License-Identifier: BSD-3-Clause
#include "FaceGeometry.h"

#include "FaceShape.h"
#include "tautline/Core/Parallel.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>

namespace tautline
{
namespace
{
/// Cells of smaller volume have their center at the mean of the face centers.
constexpr double NoVolume = 1e-300;

/// Calls visit(p, q) for corresponding points of a coupled patch and the other one.
template <class Visit>
void forEachPair(
  const FaceMesh& mesh, const FacePatch& patch, const double* points, const Visit& visit)
{
  for (Index face = patch.first; face < patch.first + patch.count; ++face)
  {
    const Index other = mesh.coupled(face), size = mesh.size(face);
    if (other < 0)
    {
      continue;
    }
    const Index* nodes = mesh.nodes.data() + mesh.offsets[face];
    const Index* otherNodes = mesh.nodes.data() + mesh.offsets[other];
    for (Index k = 0; size == mesh.size(other) && k < size; ++k)
    {
      visit(pointAt(points, nodes[k]), pointAt(points, otherNodes[(size - k) % size]));
    }
  }
}

/// The rigid motion that best maps the points of the other patch to the points of a patch (Kabsch,
/// Acta Cryst. A32 (1976)); a translation if that suffices within the matching tolerance of
/// patches.
PatchMotion motionOf(const FaceMesh& mesh, const FacePatch& patch, const double* points)
{
  PatchMotion motion;
  Vec3 mean = { 0, 0, 0 }, otherMean = { 0, 0, 0 };
  double count = 0;
  forEachPair(mesh, patch, points,
    [&](const Vec3& p, const Vec3& q)
    {
      mean += p;
      otherMean += q;
      ++count;
    });
  if (count == 0)
  {
    return motion;
  }
  mean = (1 / count) * mean;
  otherMean = (1 / count) * otherMean;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double farthest = 0, size = 0;
  forEachPair(mesh, patch, points,
    [&](const Vec3& p, const Vec3& q)
    {
      const Vec3 a = p - mean, b = q - otherMean;
      farthest = std::max(farthest, norm(a - b));
      size = std::max(size, norm(a));
      moments += Eigen::Vector3d(a[0], a[1], a[2]) * Eigen::RowVector3d(b[0], b[1], b[2]);
    });
  constexpr double matching = 1e-3;
  if (farthest > matching * size && moments.allFinite())
  {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d turn = svd.matrixU() * svd.matrixV().transpose();
    if (turn.determinant() < 0)
    {
      Eigen::Matrix3d u = svd.matrixU();
      u.col(2) *= -1;
      turn = u * svd.matrixV().transpose();
    }
    for (int i = 0; i < 3; ++i)
    {
      motion.rows[i] = { turn(i, 0), turn(i, 1), turn(i, 2) };
    }
  }
  motion.shift = mean - motion.turn(otherMean);
  return motion;
}

/// Halves the area between two coincident faces, one of a partly coupled patch and one of the patch
/// for the rest. OpenFOAM assigns the overlapping and the remaining area; the sum is the same, and
/// so are all cell metrics.
void shareAreas(const FaceMesh& mesh, std::vector<Vec3>& areas)
{
  const auto samePoints = [&mesh](Index a, Index b)
  {
    const auto begin = mesh.nodes.begin();
    return mesh.size(a) == mesh.size(b) &&
      std::is_permutation(
        begin + mesh.offsets[a], begin + mesh.offsets[a + 1], begin + mesh.offsets[b]);
  };
  for (const FacePatch& patch : mesh.patches)
  {
    for (Index face = patch.first; patch.isPartly() && face < patch.first + patch.count; ++face)
    {
      const Index cell = mesh.owner[face];
      for (Index i = mesh.cellOffsets[cell]; i < mesh.cellOffsets[cell + 1]; ++i)
      {
        const Index other = mesh.cellFaces[i];
        if (other != face && !mesh.internal(other) && samePoints(face, other))
        {
          areas[face] = 0.5 * areas[face];
          areas[other] = 0.5 * areas[other];
        }
      }
    }
  }
}

/// The motion of the patch of a coupled face.
const PatchMotion& motionAt(const FaceMesh& mesh, const FaceGeometry& geometry, Index face)
{
  const auto after = std::upper_bound(mesh.patches.begin(), mesh.patches.end(), face,
    [](Index f, const FacePatch& patch) { return f < patch.first; });
  return geometry.motions[after - mesh.patches.begin() - 1];
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
  shareAreas(mesh, geometry.area);
  for (const FacePatch& patch : mesh.patches)
  {
    geometry.motions.push_back(patch.partner >= 0 ? motionOf(mesh, patch, points) : PatchMotion());
  }
  geometry.cellCenter.resize(mesh.cells);
  geometry.volume.resize(mesh.cells);
  parallelFor(
    mesh.cells, ChunkSize, threads, [&](Index cell) { measureCell(mesh, geometry, cell); });
  return geometry;
}

//------------------------------------------------------------------------------
Vec3 acrossPatch(const FaceMesh& mesh, const FaceGeometry& geometry, Index face, const Vec3& place)
{
  const PatchMotion& motion = motionAt(mesh, geometry, face);
  return motion.turn(place) + motion.shift;
}

//------------------------------------------------------------------------------
Vec3 alongPatch(const FaceMesh& mesh, const FaceGeometry& geometry, Index face, const Vec3& vector)
{
  return motionAt(mesh, geometry, face).turnBack(vector);
}

//------------------------------------------------------------------------------
Vec3 centerAcross(const FaceMesh& mesh, const FaceGeometry& geometry, Index face)
{
  return mesh.internal(face)
    ? geometry.cellCenter[mesh.neighbor[face]]
    : acrossPatch(mesh, geometry, face, geometry.cellCenter[mesh.owner[mesh.coupled(face)]]);
}
}
