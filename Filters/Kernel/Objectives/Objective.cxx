#include "Objective.h"

#include <algorithm>
#include <initializer_list>

namespace tautline
{
namespace
{
bool isIn(ObjectiveTemplate form, std::initializer_list<ObjectiveTemplate> forms)
{
  return std::find(forms.begin(), forms.end(), form) != forms.end();
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
bool canUntangle(const Objective& objective)
{
  using T = ObjectiveTemplate;
  const MetricInfo& info = metricInfo(objective.metric);
  const T form = objective.form == T::Default ? defaultTemplate(objective.metric) : objective.form;
  if (info.inverted == InvertedValue::Larger)
  {
    return isIn(form, { T::SumOfSquares, T::Sum, T::PowerMean, T::Maximum });
  }
  return info.inverted == InvertedValue::Negative && info.direction == Direction::LargerIsBetter &&
    isIn(form, { T::Sum, T::Maximum });
}
}
