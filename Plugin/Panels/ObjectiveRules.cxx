// SPDX-License-Identifier: BSD-3-Clause
#include "ObjectiveRules.h"

#include "tautline/Objectives/Objective.h"
#include "tautline/Objectives/Scalarization.h"
#include "tautline/Quality/Metrics.h"

#include "vtkMeshOptimizer.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Whether the client has the facts of a metric; a server of another version may have other ones.
bool isKnown(int metric)
{
  const std::vector<MetricInfo>& known = metricRegistry();
  return std::any_of(known.begin(), known.end(),
    [metric](const MetricInfo& info) { return static_cast<int>(info.metric) == metric; });
}
}

//------------------------------------------------------------------------------
std::string metricReason(int metric)
{
  return isKnown(metric) ? objectiveProblem(static_cast<Metric>(metric)) : "";
}

//------------------------------------------------------------------------------
std::string targetReason(int metric, int target)
{
  if (!isKnown(metric))
  {
    return "";
  }
  const MetricInfo& info = metricInfo(static_cast<Metric>(metric));
  const std::string label = info.label;
  if (target == vtkMeshOptimizer::IDEAL)
  {
    return "";
  }
  if (info.family != MetricFamily::Target)
  {
    return label + " does not compare the elements with a target.";
  }
  if (target == vtkMeshOptimizer::SIZE && info.scaleInvariant)
  {
    return label + " does not depend on the size of the elements.";
  }
  return "";
}

//------------------------------------------------------------------------------
std::string templateReason(int metric, int objectiveTemplate)
{
  return isKnown(metric) ? templateProblem(static_cast<Metric>(metric),
                             static_cast<ObjectiveTemplate>(objectiveTemplate))
                         : "";
}

//------------------------------------------------------------------------------
std::string weightReason(int scalarization, int objectives)
{
  if (objectives < 2)
  {
    return "There is only one objective.";
  }
  switch (static_cast<Scalarization>(scalarization))
  {
    case Scalarization::WeightedSum:
    case Scalarization::WeightedMinMax:
    case Scalarization::ExponentialWeighted:
      return "";
    default:
      return "This Scalarization has no weights. Weighted sum, Weighted min-max and Exponential "
             "weighted have.";
  }
}

} // namespace tautline
