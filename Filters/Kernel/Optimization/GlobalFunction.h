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
 */
class GlobalFunction : public SmoothFunction
{
public:
  /**
   * @param optimizer NewtonConjugateGradient gets the whole Hessian, others its diagonal blocks
   * @param rowOfPoint per point of the mesh where its variables are, -1 for none; empty: in the
   * order of the simplices
   * @param rows of all points
   */
  GlobalFunction(OptimizationProblem& problem, Optimizer optimizer,
    std::vector<std::int32_t> rowOfPoint = {}, Index rows = 0);

  std::size_t size() const override;
  double valueAndGradient(const double* x, double* gradient) override;
  void linearize(const double* x) override;
  bool precondition(const double* r, double* z) override;
  bool hessianTimes(const double* d, double* product) override;

  /// Moves the points of the problem, and its simplices, to x.
  void put(const double* x);

  // Its parts, for a mesh on several ranks.

  /// Moves the points of the problem alone.
  void move(const double* x);
  /// No element is less valid than it was at the start.
  bool allowed();
  /// The terms of an objective: one per cell.
  void findTerms(std::size_t objective, double* terms);
  /// The gradient of the sum of the objectives times their slopes, and the terms of the first.
  void findGradient(const std::vector<double>& slopes, double* gradient, double* terms);
  /// Takes the memory for the Hessian.
  void makeMatrix();
  /// Takes the points, which put(x) has moved, for those that further steps are added to: points at
  /// limits and on surfaces are elsewhere than the steps alone lead.
  void rebase(const double* x);
  /// Whether points may be elsewhere than the steps alone lead.
  bool bends() const { return this->Surface || !this->Outward.empty(); }
  /// The Hessian with the slopes of findGradient(), not factorized; whether it is the positive
  /// semidefinite part.
  bool fillMatrix();
  /// Takes from steps of the points what leads them off their planes and lines.
  void keepSlides(double* d) const;
  HessianMatrix& matrix() { return *this->Hessian; }
  bool hasMatrix() const { return this->Hessian != nullptr; }

private:
  template <class Visit>
  void forEachFree(const Visit& visit) const;
  bool hasElements(std::size_t objective) const;
  void takeGradient(double* gradient) const;
  bool hasConstraints() const;
  bool isHeld(std::size_t p) const;
  void restrict(std::size_t row, std::size_t p);
  void keepLimit(std::size_t p);
  void bendAtLimit(std::size_t row, std::size_t p);
  Vec3 outwardOf(std::size_t p) const;
  Vec3 project(std::size_t p, Vec3 g) const;

  OptimizationProblem& Problem;
  bool Newton;
  int Size; ///< coordinates of a point
  std::vector<std::int32_t> RowOfPoint;
  Index Rows;
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
  std::unique_ptr<HessianMatrix> Hessian;
};
}
#endif
