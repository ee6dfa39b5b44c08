// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceGeometry.h
 * @brief Areas, centers and volumes as in finite-volume programs.
 *
 * A face is a fan of triangles about the mean of its points. Its area vector S is the sum of the
 * area vectors of the triangles. Its center is the weighted mean of their centers, with weights
 * according to the convention. A cell consists of pyramids over its faces with a common apex, the
 * mean of the face centers; its volume is the sum of their volumes, its center the volume-weighted
 * mean of their centers.
 *
 * Source: OpenFOAM v1912 and v8, primitiveMesh; stated in the notes of its Programmer's Guide.
 */
#ifndef tautline_FaceGeometry_h
#define tautline_FaceGeometry_h

#include "FaceConvention.h"
#include "FaceMesh.h"

namespace tautline
{
/// The motion from the other patch of a coupled pair to a patch: x becomes R x + t.
struct PatchMotion
{
  std::array<Vec3, 3> rows = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } }; ///< of R
  Vec3 shift = { 0, 0, 0 };
  Vec3 turn(const Vec3& v) const
  {
    return { dot(this->rows[0], v), dot(this->rows[1], v), dot(this->rows[2], v) };
  }
  Vec3 turnBack(const Vec3& v) const
  {
    return v[0] * this->rows[0] + v[1] * this->rows[1] + v[2] * this->rows[2];
  }
};

/// The geometry of a FaceMesh.
struct FaceGeometry
{
  std::vector<Vec3> area;       ///< per face: area vector, out of the owner
  std::vector<Vec3> center;     ///< per face
  std::vector<Vec3> cellCenter; ///< per cell
  std::vector<double> volume;   ///< per cell
  /// Per patch: for coupled patches, determined from the points of their faces, which correspond in
  /// opposite order.
  std::vector<PatchMotion> motions;
};

/// @param points 3 coordinates per point of the mesh
TAUTLINE_KERNEL_EXPORT FaceGeometry faceGeometry(
  const FaceMesh& mesh, const double* points, FaceConvention convention, int threads = 0);

/// Maps a position at the coupled face to the patch of a face.
TAUTLINE_KERNEL_EXPORT Vec3 acrossPatch(
  const FaceMesh& mesh, const FaceGeometry& geometry, Index face, const Vec3& place);

/// Rotates a vector in the opposite direction: to the other patch.
TAUTLINE_KERNEL_EXPORT Vec3 alongPatch(
  const FaceMesh& mesh, const FaceGeometry& geometry, Index face, const Vec3& vector);

/// The mean of the centers of the faces of a cell, the apex of its pyramids.
TAUTLINE_KERNEL_EXPORT Vec3 apexOf(const FaceMesh& mesh, const FaceGeometry& geometry, Index cell);

/// Computes center and volume of a cell from its faces.
TAUTLINE_KERNEL_EXPORT void measureCell(const FaceMesh& mesh, FaceGeometry& geometry, Index cell);

/// The center of the cell across a face with two cells, as seen from its owner; see acrossPatch().
TAUTLINE_KERNEL_EXPORT Vec3 centerAcross(
  const FaceMesh& mesh, const FaceGeometry& geometry, Index face);
}
#endif
