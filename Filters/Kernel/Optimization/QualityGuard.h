// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QualityGuard.h
 * @brief Guards the quantities that an optimization must not worsen: the number of invalid
 * elements, the worst element, and the objective.
 * Internal: not installed.
 */
#ifndef tautline_QualityGuard_h
#define tautline_QualityGuard_h

#include "OptimizationProblem.h"

namespace tautline
{
/**
 * @brief The metric of the worst element of a mesh: options.worstMetric or, if that is not set and
 * the worst element must be improved, the scaled Jacobian for meshes with cells other than
 * simplices, if it is defined on all; otherwise the metric of the first objective.
 */
TAUTLINE_KERNEL_EXPORT Metric worstMetric(const Mesh& mesh, const OptimizeOptions& options);

/// The relative rounding difference of element values for different orders of operations.
constexpr double guardRounding = 1e-9;

/// The result of Mesh::classifyCells(), per cell.
std::vector<signed char> cellValidity(const Mesh& mesh, int threads);

/// The sum of the squares of the values, which does not depend on the number of threads.
double sumOfSquares(const std::vector<double>& values, int threads);

/// The objective with the metric of the worst element: the first one, if it has this metric.
Objective judgedBy(Metric metric, const OptimizeOptions& options);

/**
 * @class tautline::QualityGuard
 * @brief Stores the worst element of a fully valid input, and restores elements that became worse.
 */
class TAUTLINE_KERNEL_EXPORT QualityGuard
{
public:
  /// The result of check() at the points of a problem.
  struct State
  {
    std::vector<signed char> validity; ///< from Mesh::classifyCells()
    std::vector<double> values;        ///< of judged(); empty unless active()
    /// whether an element is invalid, or worse than all of the input
    bool violated = false;
  };

  /**
   * @param input must outlive the guard
   * @param validity of its cells, from Mesh::classifyCells()
   * @param ranks each has a part of the input; all methods except accessors and worse() are then
   * collective
   */
  QualityGuard(const Mesh& input, const std::vector<signed char>& validity,
    const OptimizeOptions& options, const Ranks& ranks = {});
  /// The same, but computes the validity of the cells.
  QualityGuard(const Mesh& input, const OptimizeOptions& options);

  /// The objective that defines the worst element.
  const Objective& judged() const { return this->Judged; }
  /// Whether its larger values are better.
  bool isLarger() const { return this->Larger; }
  /// Its values on the input; empty if inversion is allowed.
  const std::vector<double>& values() const { return this->Values; }
  std::vector<double> takeValues() { return std::move(this->Values); }
  /// Whether the guard is active: not if the input has invalid elements, which are handled by
  /// untangling, or if inversion is allowed. Elements on which the metric is undefined stay valid.
  bool active() const { return this->Active; }
  /// Whether the input has no invalid element, inversion is not allowed, and steps reduce the
  /// objective of the whole mesh.
  bool holdsObjective() const { return this->ValidInput && !this->OnPatches; }
  /// Whether a value of the metric is worse than the worst element of the input, beyond rounding;
  /// never if OptimizeOptions::holdWorst is off.
  bool worse(double value) const;
  /// Stores the points of the problem and measures the elements there.
  State check(OptimizationProblem& problem) const;
  bool violated(OptimizationProblem& problem) const { return this->check(problem).violated; }
  /**
   * @brief Whether an element of the same mesh with other points is invalid, or worse than all of
   * the input; never if not active().
   * @param validity of its cells
   * @param values receives the values of judged(), if active()
   */
  bool violatedAt(
    const Mesh& mesh, const std::vector<signed char>& validity, std::vector<double>& values) const
  {
    return this->Active && this->TheRanks.any(!this->offenders(mesh, validity, values).empty());
  }
  /**
   * @brief Moves points around elements that are invalid or worse than all of the input back to
   * their input positions, until there are no such elements.
   * @param to alternative positions to restore, at which there are no such elements: 3 numbers per
   *   point
   * @return the number of points moved back
   */
  Index restore(OptimizationProblem& problem, const double* to = nullptr) const;

private:
  /// One flag per cell: nonzero if invalid, or worse than all of the input. Empty if there are
  /// none.
  std::vector<char> offenders(
    const Mesh& mesh, const std::vector<signed char>& validity, std::vector<double>& values) const;

  const Mesh& Input;
  Ranks TheRanks;
  Objective Judged;
  std::vector<double> Values;
  bool Active = false, ValidInput = false, OnPatches = false;
  bool Larger = false;
  bool HoldWorst = true;
  double Worst = 0.0;
};
}
#endif
