// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceMeasures.h
 * @brief The metrics of MetricFamily::Faces, as measured by finite-volume programs.
 *
 * Each value depends on the cells on both sides of a face. The value of a cell is the worst of its
 * faces, as seen from the cell. Faces of coupled patches ("cyclic") are treated as internal faces.
 *
 * Example: the largest non-orthogonality.
 *
 *     const tautline::FaceMeasures measures(faces, points, tautline::FaceConvention::Esi);
 *     const tautline::FaceValues angles = measures.evaluate(tautline::Metric::NonOrthogonality);
 *     double largest = *std::max_element(angles.cells.begin(), angles.cells.end());
 */
#ifndef tautline_FaceMeasures_h
#define tautline_FaceMeasures_h

#include "FaceGeometry.h"
#include "tautline/Quality/Metrics.h"

namespace tautline
{
/// The axes along which a mesh has more than one cell.
struct FaceDirections
{
  /// Determined by "empty" patches: the directions that the solution depends on.
  std::array<bool, 3> solution = { true, true, true };
  /// Determined by "empty" and "wedge" patches.
  std::array<bool, 3> geometric = { true, true, true };
  int count() const { return this->geometric[0] + this->geometric[1] + this->geometric[2]; }
};

/// The data that determine the directions of a mesh: the sums of the magnitudes of the normals of
/// "empty" and "wedge" patches.
struct DirectionSums
{
  Vec3 empty = { 0, 0, 0 }, wedge = { 0, 0, 0 };
};

/// A metric on a mesh.
struct FaceValues
{
  std::vector<double> cells; ///< one per cell: the worst of its faces
  /// One per face: the worst of its sides; empty for a metric of whole cells.
  std::vector<double> faces;
};

/**
 * @class FaceMeasures
 * @brief Evaluates the metrics on a mesh. The mesh and the points must outlive this object.
 *
 * For metrics that compare two cells, faces without a cell on the other side have the ideal value.
 * A face or cell of zero size has the worst value of the metric or 0; values are finite for finite
 * points.
 */
class TAUTLINE_KERNEL_EXPORT FaceMeasures
{
public:
  FaceMeasures(
    const FaceMesh& mesh, const double* points, FaceConvention convention, int threads = 0);

  const FaceMesh& mesh() const { return this->Mesh; }
  const FaceGeometry& geometry() const { return this->Geometry; }
  const FaceDirections& directions() const { return this->Directions; }
  const FaceExtent& extent() const { return this->Extent; } ///< of all points
  DirectionSums directionSums() const;
  /// For a piece of a mesh: sets the extent and directions of the whole mesh, see joinMeasures().
  void setWhole(const FaceExtent& extent, const DirectionSums& sums);

  /// Throws Error for a metric of another family.
  FaceValues evaluate(Metric metric) const;

  /**
   * @brief The weight of the owner in linear interpolation to each face, OpenFOAM's `weights`: the
   * distance of the neighbor from the face over the sum of both. 1 on uncoupled boundaries.
   */
  std::vector<double> ownerWeights() const;

  /// The values of Metric::CenterTetQuality as seen from the owner and from the neighbor of each
  /// face; for boundary faces, both are the value from the owner.
  std::vector<std::array<double, 2>> centerTetQualities() const;

  /**
   * @brief One Validity per cell: inverted if its volume or the volume of a pyramid over one of its
   * faces is negative, degenerate if one is 0, not finite if a point is not finite.
   */
  std::vector<signed char> validity() const;

private:
  std::vector<std::array<double, 2>> allSides(Metric metric) const;
  FaceValues ofFaces(Metric metric) const;
  template <class Value>
  FaceValues ofCells(const Value& value) const;
  template <class Visit>
  void forEachFaceOf(Index cell, const Visit& visit) const;

  std::array<double, 2> sidesOf(Metric metric, Index face) const;
  double cosineAcross(Index face) const;
  double skewness(Index face) const;
  double boundarySkewness(Index face) const;
  double width(Index face, const Vec3& direction) const;
  std::array<double, 2> distances(Index face) const;
  std::array<double, 2> signedDistances(Index face) const;
  double flatness(Index face) const;
  double concavity(Index face) const;
  double twist(Index face) const;
  double centerTetQuality(Index face, const Vec3& center, double sign) const;
  double fanTetQuality(Index face) const;
  double orthogonality(Index face, Index cell, double sign) const;
  double openness(Index cell) const;
  double aspectRatio(Index cell) const;
  double determinant(Index cell) const;
  double areaDeterminant(Index cell) const;
  double cellConcavity(Index cell) const;

  const FaceMesh& Mesh;
  const double* Points;
  FaceGeometry Geometry;
  FaceDirections Directions;
  FaceExtent Extent;
  int Threads;
};
}
#endif
