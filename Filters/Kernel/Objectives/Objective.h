// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Objective.h
 * @brief Objective functions: a metric of the registry, aggregated over the elements by a template.
 *
 * Objectives are always minimized. With q_i the metric of element i, w_i its weight (1 by default)
 * and s = -1 if a larger q is better, otherwise s = 1, the templates are
 *
 *     SumOfSquares            sum w_i q_i^2                       (3.4) of Kim's dissertation
 *     SumOfSquaredReciprocals sum w_i / q_i^2                     (3.5)
 *     SumOfReciprocals        sum w_i / q_i                       SI, section 3.2.2
 *     Sum                     sum w_i s q_i
 *     PowerMean               (sum w_i |q_i|^(s p) / sum w_i)^(1/p)
 *     Maximum                 (1/k) ln(sum w_i exp(k s q_i)), a smooth maximum that exceeds the
 *                             true one by at most ln(sum w_i) / k
 *
 * SumOfSquares supports metrics where smaller is better, and sizes; the two reciprocal templates
 * support metrics where larger is better, and sizes; the others support any metric. PowerMean and
 * Maximum are scaled internally, so that powers and exponentials do not overflow; their gradient
 * costs one value and one gradient.
 *
 * Inverted and degenerate elements. An element is at fault, and the objective +infinity, if
 * - the metric is a barrier (MetricInfo::barrier) and a corner Jacobian is not positive, for any
 *   template;
 * - the template is SumOfSquaredReciprocals, or PowerMean where larger is better, and q <= 0;
 * - the template is SumOfReciprocals and q = 0. Negative q give the finite negative terms of the
 *   dissertation: reducing them drives an inverted element *towards* degeneration, and an
 *   additional untangling objective is needed to reverse the element;
 * - the metric is user-defined and its formula has no finite value. Everything else is finite on
 * any element: UntangleBeta and the other metrics that grow as elements invert
 * (InvertedValue::Larger), and Sum and Maximum of signed metrics where larger is better. Elements
 * at fault add nothing to the gradient, which never has a NaN; elements of weight 0 add nothing at
 * all. A cell with a coordinate that is not finite has q = 0: at fault for barriers, reciprocals
 * and user metrics; in other templates, it contributes as q = 0.
 *
 * The sum is over the elements: the cells of the mesh dimension on which the metric is defined.
 * Additional facets and edges are left out.
 */
#ifndef tautline_Objective_h
#define tautline_Objective_h

#include "tautline/Quality/Metrics.h"

#include <string>

namespace tautline
{
/// How element values are aggregated. The numbers are stable: ParaView state files hold them.
enum class ObjectiveTemplate : int
{
  Default = -1, ///< the template of the dissertation for the metric, see defaultTemplate()
  SumOfSquares = 0,
  SumOfSquaredReciprocals = 1,
  SumOfReciprocals = 2,
  Sum = 3,
  PowerMean = 4,
  Maximum = 5
};

/// One objective: the metric, its aggregation, and its weight.
struct Objective
{
  Metric metric = Metric::InverseMeanRatio;
  ObjectiveTemplate objectiveTemplate = ObjectiveTemplate::Default;
  /// The weight of the objective in weighted scalarizations; above 0.
  double weight = 1.0;
  /// p of PowerMean (at least 1), k of Maximum (above 0, in the inverse unit of the metric).
  double power = 8.0;
  /// Parameters, combination over the corners, targets. The targets must outlive the objective.
  EvaluationOptions evaluation;
  /// Weights w_i >= 0, one per cell of the mesh, or null for 1; they must outlive the objective.
  const double* elementWeights = nullptr;
};

/**
 * @brief The template of section 3.2.2: SumOfReciprocals for the conditioning metrics (SI),
 * SumOfSquaredReciprocals for the interpolation metrics (SS) and all others where larger is better,
 * SumOfSquares for metrics where smaller is better and for sizes.
 */
TAUTLINE_KERNEL_EXPORT ObjectiveTemplate defaultTemplate(Metric metric);

/**
 * @brief The reason why a template does not suit a metric, with a remedy: minimizing it would make
 * the elements worse. "" if it is suitable; Default suits every metric.
 */
TAUTLINE_KERNEL_EXPORT std::string templateProblem(
  Metric metric, ObjectiveTemplate objectiveTemplate);

/**
 * @brief Whether the objective is finite on inverted elements and grows with their inversion, so
 * that minimizing it can untangle them: sums, means and maxima of metrics that grow as elements
 * invert, and Sum and Maximum of signed metrics where larger is better.
 */
TAUTLINE_KERNEL_EXPORT bool canUntangle(const Objective& objective);
}
#endif
