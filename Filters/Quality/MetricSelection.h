// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::MetricSelection
 * @brief The metrics requested of a filter, in order and without repeats.
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
  /// The metrics chosen that this process has; the inverse mean ratio if there is none.
  std::vector<Metric> metrics() const;
  /// What is wrong with a user's metric that is chosen and that this process does not have, see
  /// missingMetric(); or "".
  std::string problem() const;

  /// @return whether the selection changed. Throws Error for a number that is no metric's; that of
  /// a user's metric may be registered later.
  bool add(int metric);
  /// By name, label, symbol or alias; throws Error that lists the names if there is none such.
  bool addByName(const char* name);
  bool clear();

  int count() const { return static_cast<int>(this->Chosen.size()); }

private:
  std::vector<Metric> Chosen;
};
}
#endif
