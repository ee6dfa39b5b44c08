// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AutomaticMethod.h
 * @brief Which methods move the points of a stage, and when Automatic goes over from one to
 * another: the same rules on one process and on several ranks. Internal: not installed.
 */
#ifndef tautline_AutomaticMethod_h
#define tautline_AutomaticMethod_h

#include "SweepControl.h"

namespace tautline
{
/// Elements with corners beside simplices: from so many on, for each of these, sweeps take several
/// times as long as Newton's method.
constexpr double manyCorners = 0.01;

/**
 * @class tautline::OptimizationSteps
 * @brief What the rules need of an optimization. On ranks all methods are collective and return the
 * same everywhere.
 */
class OptimizationSteps
{
public:
  virtual ~OptimizationSteps() = default;

  /**
   * @brief Sweeps to convergence.
   * @param slow set, if not null, where they converge too slowly
   * @param failed set where a sweep raised the objective, as those of several objectives can
   * @param repaired set where an element that was left out has become valid
   */
  virtual StopReason sweep(Slowness* slow, bool& failed, bool& repaired) = 0;
  /// Moves all points at once, to convergence. Throws MemoryError if the matrix of Newton's method
  /// does not fit and the optimizer is Automatic.
  virtual StopReason minimizeAll(Optimizer method) = 0;

  /// Whether more than manyCorners of the elements have several corners that together make one
  /// value: quadrilaterals, hexahedra, wedges and pyramids. Sweeps have no closed form there.
  virtual bool hasManyCorners() const = 0;
  /// See HessianMatrix::hasConvexPart(), of the first objective.
  virtual bool hasConvexPart() = 0;
  /// Whether points slide on lines or planes or have limits, or an objective has targets.
  virtual bool hasConstraintsOrTargets() const = 0;
  /// Whether points slide on the boundary of a planar or volume mesh, which only sweeps keep where
  /// it is curved.
  virtual bool slidesOnSurface() const = 0;
  /// Whether methods that move all points at once hold some of these.
  virtual bool holdsPoints() = 0;
  virtual bool outOfTime() const = 0;

  /// The points as they were stored.
  virtual const std::vector<double>& stored() const = 0;
  /// Stores the points that the last steps have led to.
  virtual void store() = 0;
  /// Goes to other points.
  virtual void restart(const std::vector<double>& points) = 0;
  /// Replaces points by their harmonicPoints(); false if there are none. Throws MemoryError if the
  /// matrix does not fit.
  virtual bool findHarmonicPoints(std::vector<double>& points) = 0;
  /// See shiftFreePoints().
  virtual void shiftPoints(double part, std::vector<double>& points) = 0;
  /// The record of the points as they are.
  virtual IterationRecord record(int iteration) = 0;
};

/**
 * @brief Moves the points of a stage to convergence, by the optimizer wanted.
 *
 * Automatic sweeps; for one sum it begins with Newton's method where most elements have several
 * corners, and goes over to it where sweeps converge too slowly: from the start, or near the
 * minimum from where they are. If its matrix does not fit into memory the sweeps go on; if it does
 * not get as far as they did, their points are kept. Where sweeps fail, as those of several
 * objectives can, LimitedMemoryBFGS goes on. With points that slide on a surface, sweeps and
 * Newton's method, which holds points on curved parts, take turns.
 *
 * @param onlyLocal constraints that only sweeps keep
 * @param first the record of the start
 * @param history of the run, whose last record may change
 * @param reason set to why the last method ended
 * @return whether an element that was left out has become valid
 */
bool movePoints(OptimizationSteps& steps, const OptimizeOptions& options, bool onlyLocal,
  const IterationRecord& first, std::vector<IterationRecord>& history, StopReason& reason);
}
#endif
