// SPDX-License-Identifier: BSD-3-Clause
#include "MetricSelection.h"

#include "tautline/Quality/UserMetric.h"

#include <algorithm>
#include <iterator>

namespace tautline
{
std::vector<Metric> MetricSelection::metrics() const
{
  std::vector<Metric> known;
  std::copy_if(this->Chosen.begin(), this->Chosen.end(), std::back_inserter(known),
    [](Metric metric) { return missingMetric(static_cast<int>(metric)).empty(); });
  return known.empty() ? std::vector<Metric>{ Metric::InverseMeanRatio } : known;
}

std::string MetricSelection::problem() const
{
  for (const Metric metric : this->Chosen)
  {
    const std::string missing = missingMetric(static_cast<int>(metric));
    if (!missing.empty())
    {
      return missing;
    }
  }
  return "";
}

bool MetricSelection::add(int metric)
{
  const bool missing = !missingMetric(metric).empty();
  const Metric known =
    missing ? static_cast<Metric>(metric) : metricInfo(static_cast<Metric>(metric)).metric;
  if (std::find(this->Chosen.begin(), this->Chosen.end(), known) != this->Chosen.end())
  {
    return false;
  }
  this->Chosen.push_back(known);
  return true;
}

bool MetricSelection::addByName(const char* name)
{
  const MetricInfo* info = findMetric(name ? name : "");
  if (!info)
  {
    std::string message =
      std::string("There is no metric '") + (name ? name : "") + "'. The metrics are:";
    for (const MetricInfo& known : metricRegistry())
    {
      message += std::string(" ") + known.name;
    }
    throw Error(message + ". " + metricLoadErrors());
  }
  return this->add(static_cast<int>(info->metric));
}

bool MetricSelection::clear()
{
  const bool changed = !this->Chosen.empty();
  this->Chosen.clear();
  return changed;
}
}
