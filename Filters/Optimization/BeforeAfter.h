// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BeforeAfter.h
 * @brief Reports the quality before and after points are moved: cell arrays, rows of a table,
 * sentences.
 */
#ifndef tautline_BeforeAfter_h
#define tautline_BeforeAfter_h

#include "MovableMesh.h"
#include "TableRows.h"
#include "tautline/Objectives/Objective.h"
#include "tautline/Optimization/Optimize.h"

#include <string>
#include <vector>

namespace tautline
{
/// A metric to measure: the metrics of objectives, each with its own targets, and the metric of the
/// worst element, each once.
struct MeasuredMetric
{
  std::string name; ///< of the metric; "imr 2" for the second objective with another target
  Metric metric;
  EvaluationOptions options;
};
std::vector<MeasuredMetric> measuredMetrics(const OptimizeOptions& options, Metric worst);

/// The names of the objectives in tables, one for each, all distinct.
std::vector<std::string> objectiveNames(const std::vector<Objective>& objectives);

/**
 * @brief Adds to the output the cell arrays `<name>_before` and `<name>` of each metric and
 * `Validity`, and makes the first the active scalars.
 * @param rows receives a row per metric: `Block` (composite input), `Metric`, `Label`, and with the
 * suffixes Before and After `Minimum`, `Mean`, `Maximum`, `RMS`, `StandardDeviation`, `Worst`,
 * `OutsideAcceptable`, `Inverted`, `Degenerate`
 * @param known values of the first metric at these points, if measured before; missing values are
 * measured For a mesh in pieces, the arrays cover the piece and the numbers the whole mesh, the
 * same on all processes; collective.
 * @return a line per metric: "imr: mean 1.3 to 1.1, worst 8.2 to 2.1"
 */
std::string addBeforeAfter(const MovableMesh& mesh, const std::vector<double>& points,
  const std::vector<MeasuredMetric>& metrics, const VerifiedElements& known, int threads,
  const std::string& block, vtkDataSet* output, TableRows& rows);
}
#endif
