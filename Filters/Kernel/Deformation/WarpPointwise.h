// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpPointwise.h
 * @brief The deformation methods that are compared with FEMWARP and do not solve a partial
 * differential equation: inverse distance weighting, radial basis functions and weighted Laplacian
 * smoothing.
 *
 * All three move the points by the affine motion that fits the prescribed displacements best (least
 * squares) and process only the rest, so that every method is exact for an affine motion. Lengths
 * are relative to the extent of the prescribed points, so that the unit of length does not matter.
 * Internal: not installed.
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
 * the same for any number of threads. In the initial mesh, each point that is not prescribed is a
 * convex combination of its neighbors; of all such combinations, the one with the largest product
 * of weights is preserved. Neighbors are the other points of the surrounding cells; if the point is
 * not within their convex hull (surfaces: in the tangent plane), all weights are equal. Points of
 * parts without a prescribed point do not move. The linear system is solved to options.tolerance.
 *
 * `prescribed` has a flag per point; `displacement` has 3 numbers per point of the mesh and is
 * read, and returned unchanged, where the flag is set. Without any prescribed point, nothing moves.
 * The result is empty if the control stopped the work. Options come from the control.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> warpByWeightedLaplacian(const Mesh& mesh,
  const std::vector<unsigned char>& prescribed, const double* displacement, WarpControl& control);

class WarpParts;
/**
 * @brief The same on several ranks, for the local points: the affine motion is fitted to the
 * prescribed points of all ranks, in the order of their ids, and each rank has the rows of its
 * owned points. Solved by WarpSystem, so that the result matches the serial result up to the
 * tolerance. Empty, on all ranks, if the control stopped the work. Collective.
 * @param mesh DistributedMesh::view(), the points of which may have moved
 */
std::vector<double> warpByWeightedLaplacian(
  const Mesh& mesh, const WarpParts& parts, const double* displacement, WarpControl& control);

/// The common part of the three methods: the prescribed displacements, split into an affine motion
/// and the rest.
class TAUTLINE_SOLVERS_EXPORT PrescribedMotion
{
public:
  /// @param walls one per point of the mesh, see wallPoints(); none: for methods without them
  PrescribedMotion(const Mesh& mesh, const std::vector<unsigned char>& prescribed,
    const double* displacement, int threads, std::vector<WallPoint> walls = {});

  /// Ids sorted by position (x before y before z), then by displacement, so that sums and choices
  /// do not depend on the point order of the mesh.
  const std::vector<Index>& prescribed() const { return this->Prescribed; }
  const std::vector<Index>& free() const { return this->Free; } ///< ids, ascending
  /// A point in units of scale(), relative to the mean of the prescribed points.
  Vec3 local(Index id) const;
  double scale() const { return this->Scale; }
  /// The wall at prescribed()[i]; in mesh units.
  const WallPoint& wall(std::size_t i) const { return this->Walls[this->Prescribed[i]]; }
  /// Largest norm of a prescribed displacement.
  double largest() const { return this->Largest; }
  /// The residual displacement of prescribed()[i] after the affine motion.
  const Vec3& rest(std::size_t i) const { return this->Rest[i]; }
  /// The displacement of prescribed()[i].
  Vec3 given(std::size_t i) const { return this->displacementOf(this->Prescribed[i]); }
  /// The derivative of the affine motion along a coordinate of local().
  const Vec3& derivative(std::size_t k) const { return this->Map[k + 1]; }
  /// Whether the motion is affine, up to rounding.
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
  std::array<Vec3, 4> Map = {}; ///< displacement at the center, and its derivatives
  std::vector<Vec3> Rest;
};

/**
 * @brief Displacements of all points, 3 each: the prescribed ones unchanged, the others by inverse
 * distance weighting (Shepard): the mean of the prescribed displacements, weighted by the distance
 * to the power -options.distancePower (above 0, at most 20). Bitwise the same for any number of
 * threads and any order of the points. Distant groups of points are approximated by their
 * second-order expansion, which differs from the full sum by less than 1e-4 of the largest
 * displacement. Empty if the control stopped the work; throws Error for options out of range.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> warpByInverseDistance(
  const PrescribedMotion& motion, WarpControl& control);

/**
 * @brief The same with inverse distances and rotations (E. Luke, E. Collins, E. Blades, "A fast
 * mesh deformation method using explicit interpolation", JCP 231, 2012): each prescribed point has
 * the rigid motion of the wall there, and a free point moves by the mean of these motions, weighted
 * by the share of the wall times (L / d)^3 + (a L / d)^5, d the distance, L the largest distance of
 * a prescribed point from their mean, a L five times the largest difference of a displacement from
 * the mean one, at least L / 10. Layers turn with their wall. Rigid motions of the whole are exact,
 * other affine motions are not. Distant groups of points are approximated by their expansion, which
 * differs from the full sum by less than 1e-3 of the largest displacement. Bitwise the same for any
 * number of threads.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> warpByRigidMeans(
  const PrescribedMotion& motion, WarpControl& control);

/**
 * @brief The same with radial basis functions: Wendland's C2 function with the radius
 * options.supportRadius (0: twice the extent of the prescribed points) around as many prescribed
 * points, at most 3000, as needed to fit all others within options.fitTolerance times the smallest
 * height of the cells there. The next point chosen has the largest ratio of residual to tolerance;
 * up to 48 points that tie up to rounding are chosen together; of more, only the first by position.
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> warpByRadialBasis(
  const PrescribedMotion& motion, WarpControl& control);
}
#endif
