// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JudgedValues.h
 * @brief The metric values that define the worst element.
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
 * @brief Like evaluateMetric(), but infinitely bad instead of 0 if a user metric has no finite
 * value: infinity, or -infinity for metrics with larger values better.
 */
void evaluateJudged(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values);

/// Converts values of evaluateJudged() to values of evaluateMetric().
inline void asMeasured(std::vector<double>& values)
{
  std::replace_if(
    values.begin(), values.end(), [](double q) { return !std::isfinite(q); }, 0.0);
}

/// The message for an input with an element on which the metric of the worst element has no finite
/// value.
/// @param element for example "cell 7"
inline std::string noValueToJudge(const MetricInfo& info, const std::string& element)
{
  return "The metric \"" + std::string(info.label) + "\" has no finite value on " + element +
    " and cannot determine the worst element. Its formula must have a finite value on every "
    "valid element: correct it, or choose another metric for the worst element.";
}
}
#endif
