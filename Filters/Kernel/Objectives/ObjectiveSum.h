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
 * The mesh gives the cells; coordinates come with each call. Sums are computed in an order fixed by
 * the mesh: values and gradients are bitwise the same for any number of threads.
 */
class TAUTLINE_KERNEL_EXPORT ObjectiveSum
{
public:
  /**
   * @brief Throws Error if the objective cannot be evaluated on the mesh: a metric not defined on
   * any of its cells, a template that does not match the direction of the metric, or weights or
   * powers out of range.
   * @param mesh must outlive the sum. The coordinates in its view may change between calls; the
   * dimension and the plane stay as determined at construction of the mesh.
   * @param threads 0: use objective.evaluation
   * @param ranks by default this process alone; otherwise the ranks that each have a part of the
   * mesh, on which the constructor, value() and addGradient() are collective. Sums are then over
   * the whole mesh, rounded once, and gradients are exact at owned points. Not for Maximum; for
   * PowerMean, only the value.
   */
  ObjectiveSum(
    const Mesh& mesh, const Objective& objective, int threads = 0, const Ranks& ranks = {});
  ~ObjectiveSum();
  ObjectiveSum(ObjectiveSum&&) noexcept;
  ObjectiveSum& operator=(ObjectiveSum&&) noexcept;

  /// The objective at the points of the mesh view; +infinity if an element is at fault, never NaN.
  double value() const;
  /**
   * @brief The objective and its gradient: 3 entries per point, multiplied by `scale` and *added*
   * to the array. The value may differ from value() in the last digits. If the objective is
   * infinite, the added numbers are finite but not a gradient.
   */
  double addGradient(double scale, double* gradient) const;
  /// The metric value of every cell of the view, 0 if it is undefined; see evaluateMetric().
  void elementValues(double* values) const;

  /// The objective, with the template Default replaced by the actual template.
  const Objective& objective() const;

  /// For other parts of the kernel.
  const ObjectiveSumState& state() const { return *this->Impl; }

private:
  std::unique_ptr<ObjectiveSumState> Impl;
};

/// Throws Error with the cell number unless its weight is finite and at least 0.
TAUTLINE_KERNEL_EXPORT void requireElementWeight(Index cell, double weight);
}
#endif
