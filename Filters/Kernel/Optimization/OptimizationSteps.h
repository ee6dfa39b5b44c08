// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizationSteps.h
 * @brief The methods that move the points of an optimization, and its history.
 * Internal: not installed.
 */
#ifndef tautline_OptimizationSteps_h
#define tautline_OptimizationSteps_h

#include "OptimizationProblem.h"
#include "SweepControl.h"

namespace tautline
{
/// The ratio of elements with several corners to simplices above which sweeps take several times as
/// long as Newton's method.
constexpr double manyCorners = 0.01;

/**
 * @class tautline::OptimizationSteps
 * @brief The methods that move the points of a problem, each to convergence. On several ranks, all
 * methods are collective and return the same result everywhere.
 */
class OptimizationSteps
{
public:
  OptimizationSteps(
    OptimizationProblem& problem, const StoppingTest& watch, std::vector<IterationRecord>& history)
    : Problem(problem)
    , Watch(watch)
    , History(history)
  {
  }

  OptimizationProblem& problem() { return this->Problem; }
  /// Adds a record to the history and calls the observer; false if that stops the run, on any rank.
  bool report(const IterationRecord& record) { return this->report(this->Problem, record); }
  /// The same for the points of another problem.
  bool report(OptimizationProblem& problem, const IterationRecord& record);
  /// The number of the next record.
  int next() const { return this->History.back().iteration + 1; }

  /**
   * @brief Sweeps to convergence.
   * @param slow set, if not null, if they converge too slowly
   * @param failed set if a sweep increased the objective, which can happen with several objectives
   * @param repaired set if an excluded element has become valid
   */
  StopReason sweep(Slowness* slow, bool& failed, bool& repaired);
  /// Moves all points at once, to convergence. Throws MemoryError if the matrix of Newton's method
  /// does not fit and the optimizer is Automatic.
  StopReason minimizeAll(Optimizer method);
  /// The harmonicPoints() for the given points; empty if there are none. Throws MemoryError if the
  /// matrix does not fit.
  std::vector<double> harmonic(const std::vector<double>& points);

  /// Whether more than manyCorners of the elements have several corners that are combined into one
  /// value: quadrilaterals, hexahedra, wedges and pyramids. Sweeps have no closed form there.
  bool hasManyCorners() const;
  /// See HessianMatrix::hasConvexPart(), for the first objective.
  bool hasConvexPart() const;
  /// Whether points slide on lines or planes or have limits, an objective has targets, or the mesh
  /// is a surface in space.
  bool hasConstraintsOrTargets() const;
  /// Whether points slide on the boundary of a planar or volume mesh, which only sweeps preserve
  /// where it is curved.
  bool slidesOnSurface() const;
  /// Whether global methods hold some points fixed.
  bool holdsPoints();

private:
  StopReason minimizeTogether(Optimizer method);

  OptimizationProblem& Problem;
  const StoppingTest& Watch;
  std::vector<IterationRecord>& History;
};
}
#endif
