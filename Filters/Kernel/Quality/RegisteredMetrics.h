// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegisteredMetrics.h
 * @brief The list of all metrics, built-in and registered. Internal: not installed.
 */
#ifndef tautline_RegisteredMetrics_h
#define tautline_RegisteredMetrics_h

#include "Metrics.h"

#include <memory>

namespace tautline
{
struct MetricDescription;

/// The metrics of the enumeration.
const std::vector<MetricInfo>& builtInMetrics();

/// The built-in metrics, then the registered ones, as of now.
const std::vector<MetricInfo>& knownMetrics();

/// The facts of a metric that is or was registered, or null.
const MetricInfo* registeredMetric(Metric metric);

/// Loads the libraries of TAUTLINE_METRICS, once.
void loadMetricsOfEnvironment();

/// Throws Error if the facts contradict each other, or are not those of the metric.
void tryMetric(const MetricDescription& description, const UserMetric& metric);
}
#endif
