// SPDX-License-Identifier: BSD-3-Clause
#include "MetricSelection.h"

#include "tautline/Quality/UserMetric.h"

#include <algorithm>

namespace tautline
{
std::vector<Metric> MetricSelection::metrics() const
{
  return this->Chosen.empty() ? std::vector<Metric>{ Metric::InverseMeanRatio } : this->Chosen;
}

bool MetricSelection::add(int metric)
{
  const Metric known = metricInfo(static_cast<Metric>(metric)).metric;
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
      std::string("There is no metric '") + (name ? name : "") + "'. There are:";
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
