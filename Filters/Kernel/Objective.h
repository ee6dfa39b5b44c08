/**
 * @file Objective.h
 * @brief Objective functions: a metric of the registry, summed up over the elements by a template.
 *
 * Objectives are always minimised. With q_i the metric of element i, w_i its weight (1 by default)
 * and s = -1 where a larger q is better, s = 1 elsewhere, the templates are
 *
 *     SumOfSquares            sum w_i q_i^2                       (3.4) of Kim's dissertation
 *     SumOfSquaredReciprocals sum w_i / q_i^2                     (3.5)
 *     SumOfReciprocals        sum w_i / q_i                       SI, section 3.2.2
 *     Sum                     sum w_i s q_i
 *     PowerMean               (sum w_i |q_i|^(s p) / sum w_i)^(1/p)
 *     Maximum                 (1/k) ln(sum w_i exp(k s q_i)), a smooth maximum that exceeds the
 *                             true one by at most ln(sum w_i) / k
 *
 * Cells the metric is not defined on are left out.
 */
#ifndef tautline_Objective_h
#define tautline_Objective_h

#include "Metrics.h"

#include <memory>

namespace tautline
{
/// How element values become one number. The numbers are stable: ParaView state files hold them.
enum class ObjectiveTemplate : int
{
  Default = -1, ///< the one the dissertation uses for the metric, see defaultTemplate()
  SumOfSquares = 0,
  SumOfSquaredReciprocals = 1,
  SumOfReciprocals = 2,
  Sum = 3,
  PowerMean = 4,
  Maximum = 5
};

/// One objective: what is measured, how it is summed up, and how much it counts.
struct Objective
{
  Metric metric = Metric::InverseMeanRatio;
  ObjectiveTemplate form = ObjectiveTemplate::Default;
  /// Weight of the objective in the scalarizations that take weights; above 0.
  double weight = 1.0;
  /// p of PowerMean (at least 1), k of Maximum (above 0).
  double power = 8.0;
  /// Parameters, combination over the corners, targets. The targets must outlive the objective.
  EvaluationOptions evaluation;
  /// Weights w_i >= 0, one per cell of the mesh, or null for 1; they must outlive the objective.
  const double* elementWeights = nullptr;
};

/**
 * @brief SumOfReciprocals for the conditioning metrics SI and SS of section 3.2.1 that are signed,
 * SumOfSquaredReciprocals for other metrics where larger is better, SumOfSquares for those where
 * smaller is better.
 */
TAUTLINE_KERNEL_EXPORT ObjectiveTemplate defaultTemplate(Metric metric);

/// Whether the objective orders inverted elements, so that lowering it can repair them.
TAUTLINE_KERNEL_EXPORT bool canUntangle(const Objective& objective);

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
   * @brief Throws Error if the objective cannot be evaluated on the mesh: a metric not defined on any of its
   * cells, a template that does not fit the metric's direction, weights or powers out of range.
   * @param mesh must outlive the sum; its view's points may change between calls.
   */
  ObjectiveSum(const Mesh& mesh, const Objective& objective, int threads = 0);
  ~ObjectiveSum();
  ObjectiveSum(ObjectiveSum&&) noexcept;

  /// The objective at the points of the mesh's view.
  double value() const;
  /**
   * @brief The objective and its gradient: 3 entries per point, *added* to what is there after
   * multiplication by `scale`.
   */
  double addGradient(double scale, double* gradient) const;

  const Objective& objective() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl;
};
}
#endif
