// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceMeasures.h
 * @brief The metrics of MetricFamily::Faces: what finite-volume programs measure.
 *
 * Each value depends on the cells on both sides of a face. The value of a cell is the worst of its
 * faces, as seen from the cell. Faces of coupled patches ("cyclic") count as internal ones.
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
  /// By "empty" patches: the directions that the solution depends on.
  std::array<bool, 3> solution = { true, true, true };
  /// By these and "wedge" patches.
  std::array<bool, 3> geometric = { true, true, true };
  int count() const { return this->geometric[0] + this->geometric[1] + this->geometric[2]; }
};

/// What decides the directions of a mesh: of "empty" and of "wedge" patches, the sums of the
/// magnitudes of their normals.
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
 * @brief Evaluates the metrics on a mesh, which must outlive it, and so must the points.
 *
 * Faces without a cell on the other side have the ideal value of metrics that compare two cells. A
 * face or cell of no size has the value of the metric that is the worst or 0; values are finite for
 * finite points.
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
  /// For a piece of a mesh: extent and directions of the whole, see joinMeasures().
  void setWhole(const FaceExtent& extent, const DirectionSums& sums);

  /// Throws Error for a metric of another family.
  FaceValues evaluate(Metric metric) const;

  /**
   * @brief The weight of the owner in linear interpolation to each face, OpenFOAM's `weights`: the
   * distance of the neighbor from the face over the sum of both. 1 on uncoupled boundaries.
   */
  std::vector<double> ownerWeights() const;

  /// The values of Metric::CenterTetQuality as seen from the owner and from the neighbor of each
  /// face; of boundary faces both are the owner's.
  std::vector<std::array<double, 2>> centerTetQualities() const;

  /**
   * @brief One Validity per cell: inverted where its volume or that of a pyramid over one of its
   * faces is negative, degenerate where one is 0, not finite where a point is.
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
