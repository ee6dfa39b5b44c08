// SPDX-License-Identifier: BSD-3-Clause
#include "ReportPipeline.h"

#include "pqApplicationCore.h"
#include "pqOutputPort.h"
#include "pqPipelineFilter.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"

#include "vtkSMBooleanDomain.h"
#include "vtkSMCoreUtilities.h"
#include "vtkSMEnumerationDomain.h"
#include "vtkSMInputProperty.h"
#include "vtkSMIntVectorProperty.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxyProperty.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"
#include "vtkVariant.h"

#include <QFileInfo>
#include <QList>

#include <algorithm>
#include <cstring>
#include <functional>

namespace tautline
{
namespace
{

constexpr const char* NoProxy = "none";
constexpr int LongestText = 200; // of a value, such as criteria in JSON

/// Whether a panel shows the property, possibly as an advanced one.
bool isSetting(vtkSMProperty* property)
{
  const char* visibility = property->GetPanelVisibility();
  const bool hidden = visibility && std::strcmp(visibility, "never") == 0;
  return !property->GetInformationOnly() && !property->GetIsInternal() && !hidden;
}

QString settingsOf(vtkSMProxy* proxy);

/// The proxies of a property: names of inputs, settings of other proxies such as a box.
QString proxiesOf(vtkSMProperty* property)
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  const bool input = vtkSMInputProperty::SafeDownCast(property);
  const vtkSMPropertyHelper helper(property);
  QStringList names;
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    vtkSMProxy* proxy = helper.GetAsProxy(i);
    auto* item = model->findItem<pqProxy*>(proxy);
    names << (!proxy    ? QString(NoProxy)
        : input && item ? item->getSMName()
                        : QString("%1 (%2)").arg(proxy->GetXMLLabel(), settingsOf(proxy)));
  }
  return names.join(", ");
}

/// The values of a property as shown in the panel.
QString valueOf(vtkSMProperty* property)
{
  if (vtkSMProxyProperty::SafeDownCast(property))
  {
    return proxiesOf(property);
  }
  auto* entries =
    vtkSMEnumerationDomain::SafeDownCast(property->FindDomain("vtkSMEnumerationDomain"));
  const bool isInteger = vtkSMIntVectorProperty::SafeDownCast(property);
  const bool isSwitch = isInteger && property->FindDomain("vtkSMBooleanDomain");
  const vtkSMPropertyHelper helper(property, true);
  QStringList values;
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    values << (isSwitch        ? QString(helper.GetAsInt(i) ? "on" : "off")
        : entries && isInteger ? QString(entries->GetEntryTextForValue(helper.GetAsInt(i)))
                               : QString::fromStdString(helper.GetAsVariant(i).ToString()));
  }
  const QString text = values.join(", ");
  return text.size() > LongestText ? text.left(LongestText) + "..." : text;
}

/// The values of a property for comparison.
QString rawValueOf(vtkSMProperty* property)
{
  if (vtkSMProxyProperty::SafeDownCast(property))
  {
    return proxiesOf(property);
  }
  const vtkSMPropertyHelper helper(property, true);
  QStringList values;
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    // If no array is selected, the value is "None" or empty.
    const QString value = QString::fromStdString(helper.GetAsVariant(i).ToString());
    values << (value == "None" ? QString() : value);
  }
  return values.join('\n');
}

/// Calls visit(name, property) for the properties of a proxy.
void forEachProperty(
  vtkSMProxy* proxy, const std::function<void(const char*, vtkSMProperty*)>& visit)
{
  vtkSmartPointer<vtkSMPropertyIterator> iterator;
  iterator.TakeReference(proxy->NewPropertyIterator());
  for (iterator->Begin(); !iterator->IsAtEnd(); iterator->Next())
  {
    visit(iterator->GetKey(), iterator->GetProperty());
  }
}

QString settingsOf(vtkSMProxy* proxy)
{
  QStringList settings;
  forEachProperty(proxy,
    [&settings](const char*, vtkSMProperty* property)
    {
      if (isSetting(property))
      {
        settings << QString("%1: %2").arg(property->GetXMLLabel(), valueOf(property));
      }
    });
  return settings.join("; ");
}

/// A new proxy of the same kind with the same inputs and file, and default settings. Some defaults
/// depend on the data; defaults saved by the user are ignored.
vtkSmartPointer<vtkSMProxy> defaultOf(vtkSMProxy* proxy)
{
  vtkSmartPointer<vtkSMProxy> made;
  made.TakeReference(
    proxy->GetSessionProxyManager()->NewProxy(proxy->GetXMLGroup(), proxy->GetXMLName()));
  auto* source = vtkSMSourceProxy::SafeDownCast(made);
  if (!source)
  {
    return nullptr;
  }
  const char* file = vtkSMCoreUtilities::GetFileNameProperty(proxy);
  const auto isGiven = [file](const char* name, vtkSMProperty* property)
  { return vtkSMInputProperty::SafeDownCast(property) || (file && std::strcmp(file, name) == 0); };
  forEachProperty(proxy,
    [&](const char* name, vtkSMProperty* property)
    {
      vtkSMProperty* copy = source->GetProperty(name);
      if (copy && isGiven(name, property))
      {
        copy->Copy(property);
      }
    });
  source->UpdateVTKObjects();
  source->UpdatePipelineInformation();
  source->UpdatePropertyInformation();
  forEachProperty(source,
    [&](const char* name, vtkSMProperty* property)
    {
      if (isSetting(property) && !isGiven(name, property))
      {
        property->ResetToDefault();
      }
    });
  return made;
}

} // anonymous namespace

//------------------------------------------------------------------------------
pqOutputPort* inputOf(pqPipelineSource* source)
{
  auto* filter = qobject_cast<pqPipelineFilter*>(source);
  const QList<pqOutputPort*> ports = filter ? filter->getInputs("Input") : QList<pqOutputPort*>();
  return ports.size() == 1 ? ports.front() : nullptr;
}

//------------------------------------------------------------------------------
std::vector<pqPipelineSource*> pipelineOf(pqPipelineSource* source)
{
  std::vector<pqPipelineSource*> steps;
  while (source)
  {
    steps.push_back(source);
    pqOutputPort* input = inputOf(source);
    source = input ? input->getSource() : nullptr;
  }
  std::reverse(steps.begin(), steps.end());
  return steps;
}

//------------------------------------------------------------------------------
QString fileOf(pqPipelineSource* source)
{
  const char* name = vtkSMCoreUtilities::GetFileNameProperty(source->getProxy());
  const vtkSMPropertyHelper file(source->getProxy(), name ? name : "", true);
  return name && file.GetNumberOfElements() > 0 ? QFileInfo(file.GetAsString()).fileName()
                                                : QString();
}

//------------------------------------------------------------------------------
QStringList changedSettings(pqPipelineSource* source)
{
  const pqScopedUndoExclude notUndone;
  vtkSMProxy* proxy = source->getProxy();
  const vtkSmartPointer<vtkSMProxy> standard = defaultOf(proxy);
  const char* file = vtkSMCoreUtilities::GetFileNameProperty(proxy);
  const bool readsFile = file && !inputOf(source);
  QStringList settings;
  forEachProperty(proxy,
    [&](const char* name, vtkSMProperty* property)
    {
      const bool isSource =
        std::strcmp(name, "Input") == 0 || (file && std::strcmp(name, file) == 0);
      vtkSMProperty* initial = standard ? standard->GetProperty(name) : nullptr;
      if (!isSetting(property) || isSource || !initial)
      {
        return;
      }
      const QString value = valueOf(property);
      // A reader may have no array if the default array is not in the file.
      if (readsFile && rawValueOf(property).isEmpty())
      {
        return;
      }
      // Inputs other than the mesh have no default.
      const bool other = vtkSMInputProperty::SafeDownCast(property);
      const bool changed = other
        ? !value.isEmpty() && value != NoProxy
        : !property->IsValueDefault() && rawValueOf(property) != rawValueOf(initial);
      if (changed)
      {
        settings << QString("%1: %2").arg(property->GetXMLLabel(), value);
      }
    });
  return settings;
}

} // namespace tautline
