// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricGroups.h
 * @brief The quality metrics by purpose, in the order of the list in a panel.
 */

#ifndef tautline_MetricGroups_h
#define tautline_MetricGroups_h

#include <string>
#include <vector>

namespace tautline
{

/// Metrics of one purpose.
struct MetricGroup
{
  std::string title;
  std::string purpose;      ///< the tool tip of the title
  std::vector<int> metrics; ///< numbers, the most useful first
};

/**
 * @brief Sorts metrics by purpose. Each is in one group; groups without any are left out.
 * @param metrics the numbers of the metrics; registered metrics, and numbers about which the
 * client has no facts, are in the last group
 */
std::vector<MetricGroup> groupMetrics(const std::vector<int>& metrics);

} // namespace tautline

#endif
