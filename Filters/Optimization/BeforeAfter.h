// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BeforeAfter.h
 * @brief Quality before and after points moved: cell arrays, rows of a table, sentences.
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
/// What is measured, once each: the metrics of objectives, each with its own targets, and that by
/// which the worst element is found.
struct MeasuredMetric
{
  std::string name; ///< that of the metric; "imr 2" for the second objective with another target
  Metric metric;
  EvaluationOptions options;
};
std::vector<MeasuredMetric> measuredMetrics(const OptimizeOptions& options, Metric worst);

/// The names of the objectives in tables, one for each, none twice.
std::vector<std::string> objectiveNames(const std::vector<Objective>& objectives);

/**
 * @brief Adds to the output the cell arrays `<name>_before` and `<name>` of each metric and
 * `Validity`, and makes the first the active scalars.
 * @param rows gets a row per metric: `Block` (composite input), `Metric`, `Label`, and with the
 * endings Before and After `Minimum`, `Mean`, `Maximum`, `RMS`, `StandardDeviation`, `Worst`,
 * `OutsideAcceptable`, `Inverted`, `Degenerate`
 * @param known of these points, with the first metric, if it was measured before; what is empty is
 * measured
 * Of a mesh in pieces: arrays of the piece, numbers of the whole mesh, the same on all processes;
 * collective.
 * @return a line per metric: "imr: mean 1.3 to 1.1, worst 8.2 to 2.1"
 */
std::string addBeforeAfter(const MovableMesh& mesh, const std::vector<double>& points,
  const std::vector<MeasuredMetric>& metrics, const VerifiedElements& known, int threads,
  const std::string& block, vtkDataSet* output, TableRows& rows);
}
#endif
