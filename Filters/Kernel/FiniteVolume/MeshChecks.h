// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshChecks.h
 * @brief The checks of OpenFOAM's checkMesh, with its limits and its verdict.
 *
 * The limits are taken from OpenFOAM v1912. A check fails as a whole, for any number of failing
 * faces or cells. Warnings are not counted. With all checks, as with the checkMesh options
 * -allTopology and -allGeometry, a mesh may fail that otherwise passes.
 */
#ifndef tautline_MeshChecks_h
#define tautline_MeshChecks_h

#include "FaceMeasures.h"

namespace tautline
{
/// Above this, in degrees, checkMesh warns of faces that are severely non-orthogonal.
constexpr double SevereAngle = 70;

/// The items that a check examines.
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
  IllegalCells = 0, ///< cells with fewer than four faces
  UnusedPoints = 1, ///< points of no face
  FaceOrder = 2,    ///< internal faces not in the order of the cells
  OpenCells = 3,    ///< cells with an edge of one face only
  /// for one layer or wedge: edges neither parallel nor perpendicular to the layer
  EdgeAlignment = 4,
  BoundaryOpenness = 5,
  CellOpenness = 6,
  CellAspectRatio = 7, ///< counted together with CellOpenness
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

/// The findings of a check.
struct MeshCheckValues
{
  double least = 0, most = 0, mean = 0; ///< as printed by checkMesh; 0 for counts
  double limit = 0;
  Index offending = 0; ///< as counted by checkMesh
  Index warned = 0;    ///< severely non-orthogonal faces
  double weight = 0;   ///< of the mean: the number of items with a value
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

/// Facts that are not contained in the faces themselves.
struct MeshCheckFacts
{
  Index facesOutOfOrder = 0; ///< internal faces that are not in the order of FaceMesh in a file
};

/// The area vectors of the boundary; for a closed boundary, their sum is 0.
struct BoundarySum
{
  Vec3 area = { 0, 0, 0 };
  double size = 0; ///< the sum of the areas
};

/// Offending items on the border of a piece, which other pieces also have and which are counted
/// once.
struct BorderItems
{
  std::vector<Vec3> shortEdgePoints;
  std::vector<std::array<Vec3, 2>> askewEdges;
};

/// The results of all checks.
struct MeshCheckReport
{
  std::vector<MeshCheck> checks;           ///< in the order of MeshCheckKind
  std::vector<std::uint32_t> faces, cells; ///< per face and cell: 1 << kind for each failed check
  BoundarySum boundary;
  BorderItems border; ///< not in `checks`; see joinReports()

  const MeshCheck& operator[](MeshCheckKind kind) const
  {
    return this->checks[static_cast<std::size_t>(kind)];
  }
  /// The number of failed checks. @param all including checks that checkMesh only performs on
  /// request
  TAUTLINE_KERNEL_EXPORT int failed(bool all) const;
  /// "Mesh OK." or "Failed 2 mesh checks."
  TAUTLINE_KERNEL_EXPORT std::string verdict(bool all) const;
};

/// The checks with their limits, before they are performed.
TAUTLINE_KERNEL_EXPORT std::vector<MeshCheck> emptyMeshChecks();

/// Combines the checks of several meshes: sums of counts, extremes and means of values.
TAUTLINE_KERNEL_EXPORT std::vector<MeshCheck> joinChecks(
  const std::vector<std::vector<MeshCheck>>& meshes);

/// Sets the check of the openness of the boundary.
TAUTLINE_KERNEL_EXPORT void setBoundaryOpenness(MeshCheck& check, const BoundarySum& boundary);

/// Performs the checks. For a piece of a mesh, they only count items of the piece. @param points as
/// given to the measures
TAUTLINE_KERNEL_EXPORT MeshCheckReport checkMesh(
  const FaceMeasures& measures, const double* points, const MeshCheckFacts& facts = {});
}
#endif
