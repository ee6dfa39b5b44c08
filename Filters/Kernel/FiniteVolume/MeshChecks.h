// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshChecks.h
 * @brief The checks of OpenFOAM's checkMesh, with its limits and its verdict.
 *
 * Limits are those of OpenFOAM v1912. A check fails as a whole, however many faces or cells do.
 * Warnings do not count. With all checks, as checkMesh has them with -allTopology and -allGeometry,
 * a mesh may fail that passes without.
 */
#ifndef tautline_MeshChecks_h
#define tautline_MeshChecks_h

#include "FaceMeasures.h"

namespace tautline
{
/// Above this, in degrees, checkMesh warns of faces that are severely non-orthogonal.
constexpr double SevereAngle = 70;

/// What a check examines.
enum class CheckedItem
{
  Mesh,
  Points,
  Edges,
  Faces,
  Cells
};

/// The names are stable; the numbers are bits of MeshCheckReport::faces and cells.
enum class MeshCheckKind : int
{
  IllegalCells = 0,  ///< cells with fewer than four faces
  UnusedPoints = 1,  ///< points of no face
  FaceOrder = 2,     ///< internal faces not in the order of the cells
  OpenCells = 3,     ///< cells with an edge of one face only
  EdgeAlignment = 4, ///< of one layer or wedge: edges neither along nor across the layer
  BoundaryOpenness = 5,
  CellOpenness = 6,
  CellAspectRatio = 7, ///< counts together with CellOpenness
  FaceArea = 8,
  CellVolume = 9,
  NonOrthogonality = 10,
  PyramidVolume = 11,
  FaceSkewness = 12,
  CoupledPoints = 13, ///< faces of coupled patches whose points do not match
  FaceTets = 14,
  EdgeLength = 15,
  FaceConcavity = 16,
  FaceFlatness = 17,
  CellDeterminant = 18,
  CellConcavity = 19,
  FaceWeight = 20,
  VolumeRatio = 21,
  Number = 22
};

/// What a check finds.
struct MeshCheckValues
{
  double least = 0, most = 0, mean = 0; ///< as checkMesh prints them; 0 of counts
  double limit = 0;
  Index offending = 0; ///< as checkMesh counts them
  Index warned = 0;    ///< severely non-orthogonal faces
  double weight = 0;   ///< of the mean: how many items have a value
};

/// A check and its result.
struct MeshCheck : MeshCheckValues
{
  MeshCheckKind kind;
  const char* name;  ///< as "non_orthogonality"
  const char* label; ///< as "Non-orthogonality"
  CheckedItem item = CheckedItem::Faces;
  bool thorough = false;  ///< only with all checks
  bool onlyWarns = false; ///< does not count as failed
  bool failed() const { return this->offending > 0 && !this->onlyWarns; }
};

/// What is not in the faces themselves.
struct MeshCheckFacts
{
  Index facesOutOfOrder = 0; ///< internal faces that a file does not have in the order of FaceMesh
};

/// The area vectors of the boundary: of a closed one, their sum is 0.
struct BoundarySum
{
  Vec3 area = { 0, 0, 0 };
  double size = 0; ///< the sum of the areas
};

/// On the border of a piece, where other pieces have them, too: what offends, and is counted once.
struct BorderItems
{
  std::vector<Vec3> shortEdgePoints;
  std::vector<std::array<Vec3, 2>> askewEdges;
};

/// The results of all checks.
struct MeshCheckReport
{
  std::vector<MeshCheck> checks;           ///< in the order of MeshCheckKind
  std::vector<std::uint32_t> faces, cells; ///< per face and cell: 1 << kind of those that offend
  BoundarySum boundary;
  BorderItems border; ///< not in `checks`; see joinReports()

  const MeshCheck& operator[](MeshCheckKind kind) const
  {
    return this->checks[static_cast<std::size_t>(kind)];
  }
  /// The number of failed checks. @param all with those that checkMesh makes only on request
  TAUTLINE_KERNEL_EXPORT int failed(bool all) const;
  /// "Mesh OK." or "Failed 2 mesh checks."
  TAUTLINE_KERNEL_EXPORT std::string verdict(bool all) const;
};

/// The checks before they are made, with their limits.
TAUTLINE_KERNEL_EXPORT std::vector<MeshCheck> emptyMeshChecks();

/// The checks of several meshes as one: sums of counts, extremes and means of values.
TAUTLINE_KERNEL_EXPORT std::vector<MeshCheck> joinChecks(
  const std::vector<std::vector<MeshCheck>>& meshes);

/// Sets the check of the openness of the boundary.
TAUTLINE_KERNEL_EXPORT void setBoundaryOpenness(MeshCheck& check, const BoundarySum& boundary);

/// Makes the checks. Of a piece of a mesh they count what is of the piece. @param points as given
/// to the measures
TAUTLINE_KERNEL_EXPORT MeshCheckReport checkMesh(
  const FaceMeasures& measures, const double* points, const MeshCheckFacts& facts = {});
}
#endif
