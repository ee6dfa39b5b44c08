// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ObjectiveSum.h
 * @brief The value and the gradient of an objective on a mesh whose points move.
 */
#ifndef tautline_ObjectiveSum_h
#define tautline_ObjectiveSum_h

#include "Objective.h"
#include "tautline/Mesh/Ranks.h"

#include <memory>

namespace tautline
{
struct ObjectiveSumState;

/**
 * @brief Evaluates one objective on a mesh whose points move.
 *
 * The mesh gives the cells; coordinates come with each call. Sums are made in an order fixed by the
 * mesh: values and gradients are bitwise the same for any number of threads.
 */
class TAUTLINE_KERNEL_EXPORT ObjectiveSum
{
public:
  /**
   * @brief Throws Error if the objective cannot be evaluated on the mesh: a metric not defined on
   * any of its cells, a template that does not fit the metric's direction, weights or powers out of
   * range.
   * @param mesh must outlive the sum. The coordinates in its view's array may change between calls;
   * the dimension and the plane remain those found when the mesh was made.
   * @param threads 0: that of objective.evaluation
   * @param ranks by default this process alone; else those that each have a part of the mesh, on
   * which the constructor, value() and addGradient() are collective. Sums are then of the whole
   * mesh, rounded once, and gradients are exact at the points that a rank owns. Not for Maximum;
   * of a PowerMean the value alone.
   */
  ObjectiveSum(
    const Mesh& mesh, const Objective& objective, int threads = 0, const Ranks& ranks = {});
  ~ObjectiveSum();
  ObjectiveSum(ObjectiveSum&&) noexcept;
  ObjectiveSum& operator=(ObjectiveSum&&) noexcept;

  /// The objective at the points of the mesh's view; +infinity if an element is at fault, never
  /// NaN.
  double value() const;
  /**
   * @brief The objective and its gradient: 3 entries per point, *added* to what is there after
   * multiplication by `scale`. The value may differ from value() in the last digits. Where the
   * objective is infinite, what is added is finite but no gradient.
   */
  double addGradient(double scale, double* gradient) const;
  /// The metric's value of every cell of the view, 0 where it is not defined; see evaluateMetric().
  void elementValues(double* values) const;

  /// As given, with the template Default replaced by the one it stands for.
  const Objective& objective() const;

  /// For other parts of the kernel.
  const ObjectiveSumState& state() const { return *this->Impl; }

private:
  std::unique_ptr<ObjectiveSumState> Impl;
};

/// Throws Error that names the cell unless its weight is finite and at least 0.
TAUTLINE_KERNEL_EXPORT void requireElementWeight(Index cell, double weight);
}
#endif
