// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizeCurved.h
 * @brief Moves all nodes of a mesh with curved elements to reduce objectives.
 *
 * An objective is the sum over elements of the mean of q^2 (or another template of the metric q)
 * over the samples of a quadrature with positive weights, see SampleTable.h; for linear elements,
 * the template is applied to the mean over the corners. Newton's method minimizes it, with
 * conjugate gradients for the linear systems.
 *
 * After each step the Jacobian determinants are certified. A step is accepted if the smallest
 * determinant in each element is positive and at least LeastShare times the smallest at the samples
 * of the element. Otherwise, the location becomes a sample with the same metric, which acts as a
 * barrier, and the step is computed again. Near the minimum, the weights of these samples are
 * reduced to zero, as in interior-point methods.
 */
#ifndef tautline_OptimizeCurved_h
#define tautline_OptimizeCurved_h

#include "CurvedOptions.h"
#include "tautline/Objectives/Scalarization.h"
#include "tautline/Optimization/OptimizeOptions.h"
#include "tautline/Quality/Targets.h"

namespace tautline
{
/// An objective of curved elements. EvaluationOptions::targets and combination are not used.
struct CurvedObjective
{
  Objective objective;
  TargetType target = TargetType::Ideal;
  /// With TargetType::Size: area or volume per cell; Tensor: 9 numbers per cell; Reference: the 3
  /// coordinates of each point of a mesh with the same cells.
  const double* data = nullptr;
};

struct CurvedOptimizeOptions : CurvedOptions
{
  std::vector<CurvedObjective> objectives = std::vector<CurvedObjective>(1);
  ScalarizationOptions scalarization;
  /// Used: maximumIterations, maximumSeconds (instead of CurvedOptions::maximumSeconds),
  /// gradientNorm, relativeChange, and reduction with bestKnown.
  StoppingCriteria stopping;
  /// How to treat invalid elements: if on, untangleCurved() is called first. Remaining invalid
  /// elements are excluded from objectives that are infinite on them.
  bool untangleFirst = true;
};

struct CurvedOptimizeResult
{
  std::vector<double> points; ///< 3 x numberOfPoints; the best found
  std::vector<IterationRecord> history;
  StopReason reason = StopReason::IterationLimit;
  int iterations = 0;
  Index freePoints = 0;
  Index invalidBefore = 0, invalidAfter = 0, newlyInvalid = 0;
  bool untangled = false;
  Index addedSamples = 0;       ///< locations added as samples
  std::vector<Index> remaining; ///< the invalid cells
};

/**
 * @brief Optimizes. The objective does not rise, and no valid element becomes invalid at any step.
 * @param mesh with all cells; a volume mesh or a planar mesh
 * @throws Error with the remedy for metrics and templates that curved elements do not support, see
 * sampleFunction(), and in the cases of untangleCurved()
 */
TAUTLINE_KERNEL_EXPORT CurvedOptimizeResult optimizeCurved(
  const Mesh& mesh, const CurvedOptimizeOptions& options);

/// The value of an objective of curved elements, and its derivatives.
struct CurvedObjectiveValue
{
  double value = 0; ///< infinite if it is undefined at a sample
  /// 3 per point; for a planar mesh, along the axes of Mesh::frame(), third 0.
  std::vector<double> gradient;
  std::vector<double> product; ///< of the Hessian with a vector, laid out like the gradient
};

/**
 * @brief Evaluates an objective on all elements.
 * @param direction null, or the vector of the product, laid out like the gradient
 * @throws Error in the cases of optimizeCurved()
 */
TAUTLINE_KERNEL_EXPORT CurvedObjectiveValue evaluateCurvedObjective(const Mesh& mesh,
  const CurvedCellFacts& facts, const CurvedObjective& objective, const double* direction);
}
#endif
