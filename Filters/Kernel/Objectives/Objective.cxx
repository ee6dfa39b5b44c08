// SPDX-License-Identifier: BSD-3-Clause
#include "Objective.h"

#include <algorithm>
#include <initializer_list>

namespace tautline
{
namespace
{
bool isIn(ObjectiveTemplate objectiveTemplate, std::initializer_list<ObjectiveTemplate> templates)
{
  return std::find(templates.begin(), templates.end(), objectiveTemplate) != templates.end();
}
}

//------------------------------------------------------------------------------
ObjectiveTemplate defaultTemplate(Metric metric)
{
  if (metric == Metric::ConditioningScaleInvariant || metric == Metric::ConditioningSizeShape)
  {
    return ObjectiveTemplate::SumOfReciprocals;
  }
  return metricInfo(metric).direction == Direction::LargerIsBetter
    ? ObjectiveTemplate::SumOfSquaredReciprocals
    : ObjectiveTemplate::SumOfSquares;
}

//------------------------------------------------------------------------------
std::string templateProblem(Metric metric, ObjectiveTemplate objectiveTemplate)
{
  using T = ObjectiveTemplate;
  const MetricInfo& info = metricInfo(metric);
  const std::string label = info.label;
  if (objectiveTemplate == T::SumOfSquares && info.direction == Direction::LargerIsBetter)
  {
    return "A larger value of \"" + label +
      "\" is better: minimizing the sum of its squares would damage the mesh. Choose a sum of "
      "reciprocals.";
  }
  if (isIn(objectiveTemplate, { T::SumOfReciprocals, T::SumOfSquaredReciprocals }) &&
    info.direction == Direction::SmallerIsBetter)
  {
    return "A smaller value of \"" + label +
      "\" is better: minimizing a sum of its reciprocals would damage the mesh. Choose the sum of "
      "squares.";
  }
  return "";
}

//------------------------------------------------------------------------------
bool canUntangle(const Objective& objective)
{
  using T = ObjectiveTemplate;
  const MetricInfo& info = metricInfo(objective.metric);
  const T objectiveTemplate = objective.objectiveTemplate == T::Default
    ? defaultTemplate(objective.metric)
    : objective.objectiveTemplate;
  // Here inverted elements have larger values, so any template that increases with the value drives
  // them back to validity.
  if (info.inverted == InvertedValue::Larger)
  {
    return isIn(objectiveTemplate, { T::SumOfSquares, T::Sum, T::PowerMean, T::Maximum });
  }
  // A metric that becomes negative still changes smoothly across 0 in a sum; reciprocals would have
  // a pole there.
  return info.inverted == InvertedValue::Negative && info.direction == Direction::LargerIsBetter &&
    isIn(objectiveTemplate, { T::Sum, T::Maximum });
}
}
