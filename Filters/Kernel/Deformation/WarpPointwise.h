// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpPointwise.h
 * @brief The methods of deformation that are compared with FEMWARP and need no partial differential
 * equation: inverse distance weighting, radial basis functions and weighted Laplacian smoothing.
 * Internal: not installed.
 *
 * All three move the points by the affine motion that fits the prescribed displacements best (least
 * squares) and treat only the rest; every method is exact for an affine motion. They work in
 * lengths relative to the extent of the prescribed points, so that the unit of length does not
 * matter.
 */
#ifndef tautline_WarpPointwise_h
#define tautline_WarpPointwise_h

#include "WarpControl.h"
#include "WarpWalls.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/**
 * @brief Displacements of all points, 3 each, by the method of Shontz and Vavasis (2003); bitwise
 * the same for any number of threads. Each point that is not prescribed is
 * a convex combination of its neighbours in the initial mesh, of all such combinations the one with
 * the largest product of weights; it stays that. Neighbours are the other points of the cells
 * around; where the point is not within their hull (surfaces: in the tangent plane), all count the
 * same. Points of parts without a prescribed point stay. The linear system is solved to
 * options.tolerance.
 *
 * `prescribed` has a flag per point; `displacement` has 3 numbers per point of the mesh and is
 * read, and returned as it is, where the flag is set. Without any prescribed point nothing moves.
 * The result is empty when the control stopped the work. Options come from the control.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> warpByWeightedLaplacian(const Mesh& mesh,
  const std::vector<unsigned char>& prescribed, const double* displacement, WarpControl& control);

class WarpParts;
/**
 * @brief The same on several ranks, for the local points: the affine motion is fitted to
 * the prescribed points of all, in the order of their ids, and each rank has the rows of its own
 * points. Solved by WarpSystem, so that points differ from one rank's by the tolerance. Empty, on
 * all ranks, when the control stopped the work. Collective.
 * @param mesh DistributedMesh::view(), the points of which may have moved
 */
std::vector<double> warpByWeightedLaplacian(
  const Mesh& mesh, const WarpParts& parts, const double* displacement, WarpControl& control);

/// What the three methods share: the prescribed displacements, split into an affine motion and the
/// rest.
class TAUTLINE_SOLVERS_EXPORT PrescribedMotion
{
public:
  /// @param walls one per point of the mesh, see wallPoints(); none: for methods without them
  PrescribedMotion(const Mesh& mesh, const std::vector<unsigned char>& prescribed,
    const double* displacement, int threads, std::vector<WallPoint> walls = {});

  /// Ids in the order of the places (x before y before z), then of the displacements: sums and
  /// choices do not depend on the order of the mesh.
  const std::vector<Index>& prescribed() const { return this->Prescribed; }
  const std::vector<Index>& free() const { return this->Free; } ///< ids, ascending
  /// A point in units of scale(), from the middle of the prescribed ones.
  Vec3 local(Index id) const;
  double scale() const { return this->Scale; }
  /// The wall at prescribed()[i]; in the unit of the mesh.
  const WallPoint& wall(std::size_t i) const { return this->Walls[this->Prescribed[i]]; }
  /// Largest norm of a prescribed displacement.
  double largest() const { return this->Largest; }
  /// What the affine motion leaves of the displacement of prescribed()[i].
  const Vec3& rest(std::size_t i) const { return this->Rest[i]; }
  /// The displacement of prescribed()[i].
  Vec3 given(std::size_t i) const { return this->displacementOf(this->Prescribed[i]); }
  /// The derivative of the affine motion along a coordinate of local().
  const Vec3& derivative(std::size_t k) const { return this->Map[k + 1]; }
  /// Whether the affine motion is all there is, to rounding.
  bool affine() const { return this->Affine; }

  /// All displacements: the given ones, and affine motion plus rest(i) at free()[i].
  std::vector<double> displacements(const std::vector<Vec3>& rest) const;

private:
  void measure();
  void fitAffine();
  Vec3 displacementOf(Index id) const;
  Vec3 affineAt(const Vec3& local) const;

  const Mesh& Input;
  const double* Displacement;
  int Threads;
  std::vector<WallPoint> Walls;
  std::vector<Index> Prescribed, Free;
  Vec3 Center = { 0, 0, 0 };
  double Scale = 1;
  double Largest = 0;
  bool Affine = true;
  std::array<Vec3, 4> Map = {}; ///< displacement at the centre, and its derivatives
  std::vector<Vec3> Rest;
};

/**
 * @brief Displacements of all points, 3 each: the prescribed ones as they are, the others by
 * inverse distance weighting (Shepard), the mean of the prescribed displacements, weighted by the
 * distance to the power -options.distancePower (above 0, at most 20). Bitwise the same for any
 * number of threads and any order of the points. Far groups of points count by their expansion to
 * second order, which differs from the sum over all points by less than 1e-4 of the largest
 * displacement. Empty when the control stopped the work; throws Error for options out of range.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> warpByInverseDistance(
  const PrescribedMotion& motion, WarpControl& control);

/**
 * @brief The same by inverse distances with rotations (E. Luke, E. Collins, E. Blades, "A fast mesh
 * deformation method using explicit interpolation", JCP 231, 2012): each prescribed point carries
 * the rigid motion of the wall there, and a free point takes the mean of these motions, weighted by
 * the share of the wall times (L / d)^3 + (a L / d)^5, d the distance, L the largest distance of a
 * prescribed point from their mean, a L five times the largest difference of a displacement from
 * the mean one, at least L / 10. Layers turn with their wall. Rigid motions of all are exact, other
 * affine motions are not. Far groups of points count by their expansion, which differs from the sum
 * over all points by less than 1e-3 of the largest displacement. Bitwise the same for any number of
 * threads.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> warpByRigidMeans(
  const PrescribedMotion& motion, WarpControl& control);

/**
 * @brief The same by radial basis functions: Wendland's C2 function with the radius
 * options.supportRadius (0: twice the extent of the prescribed points) around as many prescribed
 * points, at most 3000, as it takes to meet each of the others within options.fitTolerance times
 * the smallest height of the cells there. The point with the largest residual over its tolerance
 * comes next, together with up to 48 that are equal to rounding; of more the first by its place.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> warpByRadialBasis(
  const PrescribedMotion& motion, WarpControl& control);
}
#endif
