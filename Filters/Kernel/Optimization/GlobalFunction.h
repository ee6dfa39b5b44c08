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
 * @brief The variables are how far the free points are from where they were at construction, in the
 * axes of coordinateAxes(): two a point in a planar mesh, three in others. Points that slide have
 * gradients along their line or plane only, those that are held none. A point that would go
 * farther than its limit is at the closest place within; while it is at its limit it moves across
 * its way from the start only, see keepLimit(). Points of a surface stay on it, see SurfaceSlides.
 *
 * On several ranks the variables of a rank are those of the free points that it owns, and all
 * methods but size() are collective. All cells at these points are here, so that gradients and rows
 * of the Hessian need no sums over ranks: the displacements of the points about them are received
 * before. Preconditioners do not depend on the ranks, to rounding: diagonal blocks, and
 * BlockJacobiMultigrid for Newton's method with the positive semidefinite part of the Hessian.
 */
class GlobalFunction : public SmoothFunction
{
public:
  /// @param optimizer NewtonConjugateGradient gets the whole Hessian, others its diagonal blocks
  GlobalFunction(OptimizationProblem& problem, Optimizer optimizer);

  std::size_t size() const override;
  double valueAndGradient(const double* x, double* gradient) override;
  /// Throws MemoryError, on all ranks, where the matrix does not fit into the memory of one.
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
  bool Convex = false; ///< the Hessian is its positive semidefinite part
  int Size;            ///< coordinates of a point
  const MatrixRows& Rows;
  std::array<Vec3, 3> Axes;
  const PointSlides& Slides;
  std::vector<double> Origin; ///< 3 per point
  /// Of points with limits, 3 per point: the unit vector from the start of one at its limit, else
  /// 0; and by what factor its way was shortened. Empty without limits.
  std::vector<double> Outward, Shortened;
  std::unique_ptr<SurfaceSlides> Surface; ///< of a surface in space
  bool Check = true; ///< whether elements may invert without an infinite objective
  std::vector<signed char> Start, Levels; ///< a ValidityLevel per cell: at the start, now
  std::vector<double> Gradient;
  std::vector<double> Objectives, Slopes;
  /// Per objective without derivatives of its own: the shape, whose Hessian stands for its own in
  /// the preconditioner.
  std::vector<std::unique_ptr<ObjectiveSum>> Stand;
  std::unique_ptr<HessianMatrix> Hessian;
  std::unique_ptr<GridHierarchy> Grids;
  std::vector<double> All, Product; ///< of the rows of all points here, on several ranks
};
}
#endif
