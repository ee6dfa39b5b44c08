// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegisteredMetrics.h
 * @brief The list of all metrics, built-in and registered.
 * Internal: not installed.
 */
#ifndef tautline_RegisteredMetrics_h
#define tautline_RegisteredMetrics_h

#include "Metrics.h"

#include <memory>

namespace tautline
{
struct MetricDescription;
enum class MetricArgument;

/// The metrics of the enumeration.
const std::vector<MetricInfo>& builtInMetrics();

/// The built-in metrics, then the currently registered ones.
const std::vector<MetricInfo>& knownMetrics();

/// The facts of a metric that is or was registered, or null.
const MetricInfo* registeredMetric(Metric metric);

/// Whether a number belongs to a metric that is or was registered in this process, not only in
/// another one.
bool isRegisteredHere(Metric metric);

/// Whether a number is above the built-in metrics, as it is for every registered metric.
bool isNumberOfUserMetric(int number);

/**
 * @brief Registers the facts of a metric of another process, without its function.
 *
 * A metric of the same name that is registered here is kept.
 * @param facts the received facts; a metric with the same facts is unchanged
 */
void mirrorMetric(MetricDescription description, MetricArgument argument, const std::string& facts);

/// Loads the libraries of TAUTLINE_METRICS, once.
void loadMetricsOfEnvironment();

/// Throws Error if the facts contradict each other or do not match the metric.
void tryMetric(const MetricDescription& description, const UserMetric& metric);
}
#endif
