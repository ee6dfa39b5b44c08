// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceEnergy.h
 * @brief The energy of the faces of a finite-volume mesh, with its gradient.
 *
 * With the area vector S and center f of a face, the centers C and C' of its cells, and d = C' - C:
 *
 *     sum over faces ((1 - cos(S, d)) / a)^p + s (|v| / (w b))^q
 *     + sum over tetrahedra psi(V / V0)
 *
 * v is the skewness vector, see FaceMeasures.h, and w the reference width at the points of
 * freeze(). In each of its cells, each face has a tetrahedron per edge, with f and C, and the
 * tetrahedra of C with a fan of triangles from the best point of the face at freeze(). V0 is the
 * volume of a tetrahedron at the points of the constructor, but at least a fourth of the mean size
 * in its cell. psi(t) = (e - t)^2 / chi(t) below e, otherwise 0; chi(t) = (t + sqrt(t^2 + delta^2))
 * / 2, so that negative volumes also have a value (Garanzha et al., Foldover-free maps in 50 lines
 * of code, ACM Trans. Graph. 40 (2021)).
 *
 * The gradient is computed by reverse accumulation: from cell centers to faces, and from faces to
 * points; it costs about as much as the value.
 * Internal: not installed.
 */
#ifndef tautline_FaceEnergy_h
#define tautline_FaceEnergy_h

#include "tautline/FiniteVolume/FaceGeometry.h"

namespace tautline
{
/// The limits and exponents of the energy.
struct FaceEnergyOptions
{
  double angle = 65;      ///< degrees: the non-orthogonality with cost 1
  double skewness = 3;    ///< the skewness with cost 1
  double power = 4;       ///< of 1 - cos, above 0.5
  double skewPower = 6;   ///< of the skewness, above 1
  double shrinking = 0.1; ///< e
  double weight = 1;      ///< of the tetrahedra
  double skewWeight = 1;  ///< of the skewness
  double delta = 0;       ///< delta of chi; 0: negative volumes are not allowed
  int threads = 0;
};

/**
 * @class tautline::FaceEnergy
 * @brief The energy of some cells and faces of a mesh, which must outlive it.
 */
class TAUTLINE_KERNEL_EXPORT FaceEnergy
{
public:
  /**
   * @brief The faces of cells with a free point.
   * @param points 3 coordinates per point of the mesh
   * @param free one flag per point: nonzero if it moves
   */
  FaceEnergy(const FaceMesh& mesh, const double* points, const std::vector<char>& free,
    const FaceEnergyOptions& options);

  void setOptions(const FaceEnergyOptions& options) { this->Options = options; }
  const FaceEnergyOptions& options() const { return this->Options; }

  /// Sets the reference widths from these points, and the positions of the fixed points.
  void freeze(const double* points);

  /**
   * @brief The energy, and its gradient with respect to the free points, 3 for each; +infinity if a
   * tetrahedron has no positive volume and delta is 0.
   * @param gradient overwritten; null: not computed
   */
  double evaluate(const double* points, double* gradient);

  /// The smallest V / V0 at the points of the last evaluation.
  double leastTetrahedron() const { return this->Least; }
  /// The numbers of the free points, in increasing order.
  const std::vector<Index>& freePoints() const { return this->Points; }

private:
  /// The cost of a face, with the derivatives with respect to its inputs.
  struct FaceCost
  {
    double value = 0;
    double least = 1; ///< of V / V0
    Vec3 area = { 0, 0, 0 }, center = { 0, 0, 0 }, own = { 0, 0, 0 }, other = { 0, 0, 0 };
  };
  /// The derivatives of the energy with respect to the area vector and the center of a face.
  struct FaceBar
  {
    Vec3 area, center;
  };
  FaceCost costOf(Index face, const double* points, Vec3* nodeBars) const;
  void addTetrahedra(FaceCost& cost, Index face, int side, const double* points, const Vec3& apex,
    Vec3& byApex, Vec3* nodeBars) const;
  void addAngle(FaceCost& cost, Index face, const Vec3& d) const;
  void addSkewness(FaceCost& cost, Index face, const Vec3& d) const;
  void addBoundarySkewness(FaceCost& cost, Index face) const;
  double addShrinking(FaceCost& cost, double t) const;
  Index bestBase(Index face, const double* points) const;
  void findVolumes(const double* points);
  void findFans(const double* points);
  void measure(const double* points);
  Vec3 centerBar(Index cell, const std::vector<FaceCost>& costs) const;
  void addFromCell(Index cell, Index face, FaceBar& bar) const;
  void addToNodes(Index face, const FaceBar& bar, const double* points, Vec3* nodes) const;

  const FaceMesh& Mesh;
  FaceEnergyOptions Options;
  std::vector<Index> Cells;           ///< with a free point
  std::vector<Index> Faces;           ///< of these cells
  std::vector<Index> Places;          ///< per face: its position in Faces, or -1
  std::vector<char> Moves;            ///< per cell: in Cells
  std::vector<Index> Points;          ///< free ones
  std::vector<Index> UseStarts, Uses; ///< per free point: positions of its uses in NodeBars
  std::vector<Index> NodeStarts;      ///< per face of Faces: its first position in NodeBars
  FaceGeometry Geometry;              ///< of the whole mesh; up to date near free points
  std::vector<double> Widths;         ///< per face of Faces
  /// Per position in NodeBars: six times V0 of the tetrahedra of the owner and the neighbor.
  std::vector<std::array<double, 2>> Volumes;
  std::vector<std::array<double, 2>> FanVolumes; ///< the same for the fans
  std::vector<Index> Bases;                      ///< per face of Faces: the base point of its fan
  /// points of the constructor; mean volume of the tetrahedra per cell
  std::vector<double> Start, MeanVolumes;
  std::vector<Vec3> StartCenters; ///< of the cells
  std::vector<Vec3> CellBars;     ///< per cell of the mesh; 0 for fixed cells
  /// the same for the apexes of its pyramids, divided by its number of faces
  std::vector<Vec3> ApexBars;
  std::vector<Vec3> NodeBars;
  double Least = 0;
};
}
#endif
