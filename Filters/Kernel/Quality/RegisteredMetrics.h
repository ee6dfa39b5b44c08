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

/// The built-in metrics, then the registered ones, as of now.
const std::vector<MetricInfo>& knownMetrics();

/// The facts of a metric that is or was registered, or null.
const MetricInfo* registeredMetric(Metric metric);

/// Whether a number is that of a metric that is or was registered, and not of another process only.
bool isRegisteredHere(Metric metric);

/// Whether a number is above those of the built-in metrics, as that of every registered one.
bool isNumberOfUserMetric(int number);

/**
 * @brief Makes a metric of another process known, without its function.
 *
 * One of the same name that is registered here stays.
 * @param facts what the process has sent; a metric with the same facts stays as it is
 */
void mirrorMetric(MetricDescription description, MetricArgument argument, const std::string& facts);

/// Loads the libraries of TAUTLINE_METRICS, once.
void loadMetricsOfEnvironment();

/// Throws Error if the facts contradict each other, or are not those of the metric.
void tryMetric(const MetricDescription& description, const UserMetric& metric);
}
#endif
