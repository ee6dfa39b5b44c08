// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GlobalFunction.h
 * @brief The scalarized objective of an optimization as a function of all free points at once.
 * Internal: not installed.
 */
#ifndef tautline_GlobalFunction_h
#define tautline_GlobalFunction_h

#include "Minimize.h"
#include "OptimizationProblem.h"
#include "SurfaceSlides.h"
#include "tautline/Objectives/BlockJacobiMultigrid.h"
#include "tautline/Objectives/HessianMatrix.h"

#include <memory>

namespace tautline
{
/**
 * @class tautline::GlobalFunction
 * @brief The variables are the displacements of the free points since construction, in the axes of
 * coordinateAxes(): two per point in a planar mesh, otherwise three. Sliding points only have
 * gradients along their line or plane, held points have none. A point that would exceed its limit
 * is placed at the closest position within; at its limit, it only moves perpendicular to its
 * displacement from the start, see keepLimit(). Points of a surface stay on it, see SurfaceSlides.
 *
 * On several ranks, a rank has the variables of the free points that it owns, and all methods
 * except size() are collective. All cells at these points are local, so that gradients and rows of
 * the Hessian need no sums over ranks: the displacements of the surrounding points are received
 * beforehand. Preconditioners do not depend on the ranks, up to rounding: diagonal blocks, and
 * BlockJacobiMultigrid for Newton's method with the positive semidefinite part of the Hessian.
 */
class GlobalFunction : public SmoothFunction
{
public:
  /// @param optimizer NewtonConjugateGradient gets the whole Hessian, others its diagonal blocks
  GlobalFunction(OptimizationProblem& problem, Optimizer optimizer);

  std::size_t size() const override;
  double valueAndGradient(const double* x, double* gradient) override;
  /// Throws MemoryError on all ranks if the matrix does not fit into the memory of one.
  void linearize(const double* x) override;
  bool precondition(const double* r, double* z) override;
  bool hessianTimes(const double* d, double* product) override;

  /// Moves the points of the problem, and its simplices, to x.
  void put(const double* x);

private:
  template <class Visit>
  void forEachFree(const Visit& visit) const;
  void move(const double* x);
  bool allowed();
  void takeGradient(double* gradient) const;
  void makeMatrix();
  void fillMatrix();
  void rebase(const double* x);
  bool bends() const;
  void keepSlides(double* d) const;
  bool hasConstraints() const;
  bool isHeld(std::size_t p) const;
  void restrict(std::size_t row, std::size_t p);
  void keepLimit(std::size_t p);
  void bendAtLimit(std::size_t row, std::size_t p);
  Vec3 outwardOf(std::size_t p) const;
  Vec3 project(std::size_t p, Vec3 g) const;

  OptimizationProblem& Problem;
  bool Newton;
  bool Convex = false; ///< whether the Hessian is replaced by its positive semidefinite part
  int Size;            ///< coordinates of a point
  const MatrixRows& Rows;
  std::array<Vec3, 3> Axes;
  const PointSlides& Slides;
  std::vector<double> Origin; ///< 3 per point
  /// For points with limits, 3 per point: the unit vector from the start to a point at its limit,
  /// otherwise 0; and the factor by which its displacement was shortened. Empty without limits.
  std::vector<double> Outward, Shortened;
  std::unique_ptr<SurfaceSlides> Surface; ///< for a surface in space
  bool Check = true; ///< whether elements may invert without an infinite objective
  std::vector<signed char> Start, Levels; ///< a ValidityLevel per cell: at the start, now
  std::vector<double> Gradient;
  std::vector<double> Objectives, Slopes;
  /// Per objective without analytic derivatives: the shape metric, whose Hessian is used in the
  /// preconditioner.
  std::vector<std::unique_ptr<ObjectiveSum>> Stand;
  std::unique_ptr<HessianMatrix> Hessian;
  std::unique_ptr<GridHierarchy> Grids;
  std::vector<double> All, Product; ///< for the rows of all local points, on several ranks
};
}
#endif
