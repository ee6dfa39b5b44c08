// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::MetricSelection
 * @brief The metrics requested from a filter, in order and without repetitions.
 */
#ifndef tautline_MetricSelection_h
#define tautline_MetricSelection_h

#include "TautlineQualityModule.h" // for export macro

#include "tautline/Quality/Metrics.h"

#include <string>
#include <vector>

namespace tautline
{
class TAUTLINEQUALITY_EXPORT MetricSelection
{
public:
  /// The chosen metrics that this process has; the inverse mean ratio if there are none.
  std::vector<Metric> metrics() const;
  /// The problem with a chosen user metric that this process lacks, see missingMetric(); or "".
  std::string problem() const;

  /// @return whether the selection changed. Throws Error for a number that is not a metric's; a
  /// user metric may be registered later.
  bool add(int metric);
  /// By name, label, symbol or alias; throws Error, with a list of the names, if it does not exist.
  bool addByName(const char* name);
  bool clear();

  int count() const { return static_cast<int>(this->Chosen.size()); }

private:
  std::vector<Metric> Chosen;
};
}
#endif
