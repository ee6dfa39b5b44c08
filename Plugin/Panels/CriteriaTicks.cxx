// SPDX-License-Identifier: BSD-3-Clause
#include "CriteriaTicks.h"

#include "tautline/Quality/Criteria.h"

#include "pqDataRepresentation.h"
#include "pqView.h"

#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMTransferFunctionProxy.h"
#include "vtkSMViewProxy.h"

#include <QVariant>

#include <algorithm>

namespace tautline
{
namespace
{
/// Property of a representation whose legend has labels of criteria.
constexpr const char* Labelled = "TautlineCriteriaLabels";

/// Throws Error for what are no criteria.
QualityCriteria parsed(const std::string& text)
{
  const auto& known = criteriaPresets();
  const bool preset = std::find(known.begin(), known.end(), text) != known.end();
  return parseCriteria(preset ? presetCriteria(text) : text);
}

/// The name of the array that the mesh is colored by, or "".
std::string coloredBy(vtkSMProxy* shown)
{
  constexpr int arrayName = 4; // of the five parts of the property
  return shown->GetProperty("ColorArrayName")
    ? vtkSMPropertyHelper(shown, "ColorArrayName").GetAsString(arrayName)
    : "";
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::vector<double> criteriaLimits(const std::string& criteria, const std::string& metric)
{
  std::vector<double> values;
  try
  {
    for (const QualityCriterion& criterion : parsed(criteria).criteria)
    {
      if (criterion.name() != metric)
      {
        continue;
      }
      for (const auto& limits : criterion.limits)
      {
        if (limits)
        {
          values.insert(values.end(), { limits->warn, limits->fail });
        }
      }
    }
  }
  catch (const Error&)
  {
    return {};
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

//------------------------------------------------------------------------------
void labelLegend(pqDataRepresentation* shown, vtkSMProxy* quality)
{
  vtkSMProxy* proxy = shown->getProxy();
  if (!quality->GetProperty("Criteria") || !proxy->GetProperty("LookupTable") || !shown->getView())
  {
    return;
  }
  vtkSMProxy* colors = vtkSMPropertyHelper(proxy, "LookupTable").GetAsProxy();
  vtkSMProxy* legend = colors
    ? vtkSMTransferFunctionProxy::FindScalarBarRepresentation(colors, shown->getView()->getProxy())
    : nullptr;
  if (!legend)
  {
    return;
  }
  double range[2] = { 0, 0 };
  vtkSMTransferFunctionProxy::GetRange(colors, range);
  std::vector<double> labels;
  for (const double limit :
    criteriaLimits(vtkSMPropertyHelper(quality, "Criteria").GetAsString(), coloredBy(proxy)))
  {
    if (limit >= range[0] && limit <= range[1])
    {
      labels.push_back(limit);
    }
  }
  const bool some = !labels.empty();
  if (!some && !shown->property(Labelled).isValid())
  {
    return;
  }
  shown->setProperty(Labelled, some ? QVariant(true) : QVariant());
  // The ends of the range have labels of their own.
  vtkSMPropertyHelper(legend, "UseCustomLabels").Set(some ? 1 : 0);
  vtkSMPropertyHelper(legend, "CustomLabels")
    .Set(labels.data(), static_cast<unsigned>(labels.size()));
  legend->UpdateVTKObjects();
  shown->renderViewEventually();
}

} // namespace tautline
