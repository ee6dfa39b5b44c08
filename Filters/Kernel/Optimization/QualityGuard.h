// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QualityGuard.h
 * @brief Holds what an optimization must not make worse: the number of invalid elements, the worst
 * element, and the objective.
 * Internal: not installed.
 */
#ifndef tautline_QualityGuard_h
#define tautline_QualityGuard_h

#include "OptimizationProblem.h"

namespace tautline
{
/**
 * @brief The metric that judges the worst element of a mesh: options.worstMetric, or, where that is
 * not set and the worst element is to be improved, the scaled Jacobian for meshes with other cells
 * than simplices, if it is defined on all; else the metric of the first objective.
 */
TAUTLINE_KERNEL_EXPORT Metric worstMetric(const Mesh& mesh, const OptimizeOptions& options);

/// Values of one element differ by this much, relatively, with the order of its operations.
constexpr double guardRounding = 1e-9;

/// What Mesh::classifyCells() gives, per cell.
std::vector<signed char> cellValidity(const Mesh& mesh, int threads);

/// The sum of the squares of the values, which does not depend on the number of threads.
double sumOfSquares(const std::vector<double>& values, int threads);

/// The objective whose metric judges the worst element: the first one, if it has this metric.
Objective judgedBy(Metric metric, const OptimizeOptions& options);

/**
 * @class tautline::QualityGuard
 * @brief The worst element of an input whose elements are all valid; and the way back for those
 * that became worse.
 */
class TAUTLINE_KERNEL_EXPORT QualityGuard
{
public:
  /// What check() finds at the points of a problem.
  struct State
  {
    std::vector<signed char> validity; ///< as Mesh::classifyCells() gives it
    std::vector<double> values;        ///< of judged(); empty unless active()
    bool violated = false;             ///< an element is invalid, or worse than all of the input
  };

  /**
   * @param input must outlive the guard
   * @param validity of its cells, as Mesh::classifyCells() gives it
   * @param ranks of which each has a part of the input; all methods but accessors and worse() are
   * then collective
   */
  QualityGuard(const Mesh& input, const std::vector<signed char>& validity,
    const OptimizeOptions& options, const Ranks& ranks = {});
  /// Measures the validity of the cells itself.
  QualityGuard(const Mesh& input, const OptimizeOptions& options);

  /// Tells which element is the worst.
  const Objective& judged() const { return this->Judged; }
  /// Whether its larger values are better.
  bool isLarger() const { return this->Larger; }
  /// Its values on the input; empty if inversion is allowed.
  const std::vector<double>& values() const { return this->Values; }
  std::vector<double> takeValues() { return std::move(this->Values); }
  /// Whether there is something to hold: not where the input has invalid elements, which untangling
  /// answers for, nor where inversion is allowed. Elements the metric is not defined on stay valid.
  bool active() const { return this->Active; }
  /// Whether the input has no invalid element, inversion is not allowed, and steps reduce the
  /// objective of the whole mesh.
  bool holdsObjective() const { return this->ValidInput && !this->OnPatches; }
  /// Whether a value of the metric is worse than that of the worst element of the input, beyond
  /// rounding; never if OptimizeOptions::holdWorst is off.
  bool worse(double value) const;
  /// Stores the problem's points and measures the elements at them.
  State check(OptimizationProblem& problem) const;
  bool violated(OptimizationProblem& problem) const { return this->check(problem).violated; }
  /**
   * @brief Whether an element of the same mesh with other points is invalid, or worse than all of
   * the input; never if not active().
   * @param validity of its cells
   * @param values gets those of judged(), if active()
   */
  bool violatedAt(
    const Mesh& mesh, const std::vector<signed char>& validity, std::vector<double>& values) const
  {
    return this->Active && this->TheRanks.any(!this->offenders(mesh, validity, values).empty());
  }
  /**
   * @brief Puts points back to where they were in the input, about the elements that are invalid or
   * worse than all of the input, until there is none.
   * @param to other places to put them back to, at which there is none: 3 numbers per point
   * @return the number of points put back
   */
  Index restore(OptimizationProblem& problem, const double* to = nullptr) const;

private:
  /// One flag per cell: invalid, or worse than all of the input. Empty if there is none.
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
