// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizeCurved.h
 * @brief Moves all nodes of a mesh with curved elements so that objectives become smaller.
 *
 * An objective is the sum over elements of the mean of q^2 (or what its template makes of the
 * metric q) over the samples of a quadrature with positive weights, see SampleTable.h; that of
 * linear elements has the power of the mean over the corners. Newton's method minimizes it, with
 * conjugate gradients for the linear systems.
 *
 * After each step the Jacobian determinants are certified. A step is taken if the smallest one of
 * each element is positive and at least LeastShare of the smallest at the samples of the element;
 * where it is not, the place becomes a sample with the same metric, so that a barrier keeps it
 * away, and the step is computed again. Near the minimum the weights of these samples are reduced
 * to nothing, as interior point methods reduce theirs.
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
  /// Of these maximumIterations, maximumSeconds (instead of that of CurvedOptions), gradientNorm,
  /// relativeChange, and reduction with bestKnown count.
  StoppingCriteria stopping;
  /// What to do with invalid elements: untangleCurved() first (on); else, and where some remain,
  /// objectives that are infinite on them leave them out.
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
  Index addedSamples = 0;       ///< places that had to be represented
  std::vector<Index> remaining; ///< the cells that are not valid
};

/**
 * @brief Optimizes. The objective does not rise, and no valid element becomes invalid at any step.
 * @param mesh with all cells; of volumes, or in a plane
 * @throws Error with the remedy for metrics and templates that curved elements do not have, see
 * sampleFunction(), and as untangleCurved() does
 */
TAUTLINE_KERNEL_EXPORT CurvedOptimizeResult optimizeCurved(
  const Mesh& mesh, const CurvedOptimizeOptions& options);

/// The value of an objective of curved elements, and its derivatives.
struct CurvedObjectiveValue
{
  double value = 0; ///< infinite where a sample has none
  /// 3 per point; in a plane along the axes of Mesh::frame(), third 0.
  std::vector<double> gradient;
  std::vector<double> product; ///< of the Hessian with a vector, as the gradient
};

/**
 * @brief Evaluates an objective on all elements.
 * @param direction null, or the vector of the product, as the gradient
 * @throws Error as optimizeCurved() does
 */
TAUTLINE_KERNEL_EXPORT CurvedObjectiveValue evaluateCurvedObjective(const Mesh& mesh,
  const CurvedCellFacts& facts, const CurvedObjective& objective, const double* direction);
}
#endif
