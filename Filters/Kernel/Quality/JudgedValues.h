// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JudgedValues.h
 * @brief The values of a metric by which the worst element is found.
 * Internal: not installed.
 */
#ifndef tautline_JudgedValues_h
#define tautline_JudgedValues_h

#include "Metrics.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tautline
{
/**
 * @brief As evaluateMetric(), but infinitely bad where a user's metric has no finite value, instead
 * of 0: infinity, or -infinity of metrics of which larger values are better.
 */
void evaluateJudged(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values);

/// Values of evaluateJudged() as those of evaluateMetric().
inline void asMeasured(std::vector<double>& values)
{
  std::replace_if(
    values.begin(), values.end(), [](double q) { return !std::isfinite(q); }, 0.0);
}

/// What is wrong with an input that has no finite value where the metric judges the worst element.
/// @param element as "cell 7"
inline std::string noValueToJudge(const MetricInfo& info, const std::string& element)
{
  return "The metric \"" + std::string(info.label) + "\" has no finite value on " + element +
    " and cannot judge which element is the worst. Its formula must have a finite value on every "
    "valid element: correct it, or choose another metric for the worst element.";
}
}
#endif
