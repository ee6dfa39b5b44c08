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
#include "tautline/Objectives/HessianMatrix.h"

#include <memory>

namespace tautline
{
/**
 * @class tautline::GlobalFunction
 * @brief The variables are how far the free points are from where they were at construction, in the
 * axes of coordinateAxes(): two a point in a planar mesh, three in a volume. Points that slide have
 * gradients along their line or plane only.
 */
class GlobalFunction : public SmoothFunction
{
public:
  /// @param optimizer NewtonConjugateGradient gets the whole Hessian, others its diagonal blocks
  GlobalFunction(OptimizationProblem& problem, Optimizer optimizer);

  std::size_t size() const override;
  double valueAndGradient(const double* x, double* gradient) override;
  void linearize(const double* x) override;
  bool precondition(const double* r, double* z) override;
  bool hessianTimes(const double* d, double* product) override;

  /// Moves the points of the problem, and its simplices, to x.
  void put(const double* x);

private:
  template <class Visit>
  void forEachFree(const Visit& visit) const;
  void move(const double* x);
  void makeMatrix();
  void restrict(std::size_t row, std::size_t p);
  bool allowed();
  Vec3 project(std::size_t p, Vec3 g) const;

  OptimizationProblem& Problem;
  bool Newton;
  int Size; ///< coordinates of a point
  std::array<Vec3, 3> Axes;
  std::vector<double> Origin; ///< 3 per point
  bool Check = true;          ///< whether elements may invert without an infinite objective
  std::vector<signed char> Start, Levels; ///< a ValidityLevel per cell: at the start, now
  std::vector<double> Gradient;
  std::vector<double> Objectives, Slopes;
  std::unique_ptr<HessianMatrix> Hessian;
};
}
#endif
