// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ObjectiveRules.h
 * @brief What applies to an objective of Optimize Mesh, and why the rest does not.
 */

#ifndef tautline_ObjectiveRules_h
#define tautline_ObjectiveRules_h

#include <string>

namespace tautline
{

/// Why a metric cannot be an objective; "" if it can.
std::string metricReason(int metric);

/**
 * @brief Why a target has no effect on a metric; "" if it has.
 * @param metric number in the registry of metrics
 * @param target value of the property Target: 0 ideal, 1 reference, 2 size, 3 tensor
 */
std::string targetReason(int metric, int target);

/// Why a template does not suit a metric; "" if it does. Template -1 is the default of the metric.
std::string templateReason(int metric, int objectiveTemplate);

/**
 * @brief Why weights have no effect; "" if they have.
 * @param scalarization value of the property Scalarization
 */
std::string weightReason(int scalarization, int objectives);

} // namespace tautline

#endif
