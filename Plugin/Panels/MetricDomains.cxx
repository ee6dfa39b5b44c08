// SPDX-License-Identifier: BSD-3-Clause
#include "MetricDomains.h"

#include "Startup.h"

#include "vtkCallbackCommand.h"
#include "vtkClientServerInterpreterInitializer.h"
#include "vtkNew.h"
#include "vtkPVProxyDefinitionIterator.h"
#include "vtkPVXMLElement.h"
#include "vtkProcessModule.h"
#include "vtkSMProxyDefinitionManager.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMTautlineMetricsDomain.h"
#include "vtkSessionIterator.h"
#include "vtkSmartPointer.h"

#include <string>

namespace
{
constexpr const char* ListProperty = "UserMetrics";
constexpr const char* PlainDomain = "EnumerationDomain";
constexpr const char* MetricsDomain = "TautlineMetricsDomain"; // vtkSM is put before it

/// Whether a domain takes entries from the list of metrics.
bool requiresList(vtkPVXMLElement* domain)
{
  vtkPVXMLElement* required = domain->FindNestedElementByName("RequiredProperties");
  for (unsigned int i = 0; required && i < required->GetNumberOfNestedElements(); ++i)
  {
    const std::string property = required->GetNestedElement(i)->GetAttributeOrEmpty("name");
    if (property == ListProperty)
    {
      return true;
    }
  }
  return false;
}

void change(vtkPVXMLElement* proxy)
{
  for (unsigned int i = 0; i < proxy->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* domain = proxy->GetNestedElement(i)->FindNestedElementByName(PlainDomain);
    if (domain && requiresList(domain))
    {
      domain->SetName(MetricsDomain);
    }
  }
}

void changeAll(vtkSMProxyDefinitionManager* definitions)
{
  vtkSmartPointer<vtkPVProxyDefinitionIterator> all;
  all.TakeReference(definitions->NewSingleGroupIterator("filters"));
  for (all->InitTraversal(); !all->IsDoneWithTraversal(); all->GoToNextItem())
  {
    if (vtkPVXMLElement* proxy = all->GetProxyDefinition())
    {
      change(proxy);
    }
  }
}

void definitionsUpdated(vtkObject* caller, unsigned long, void*, void*)
{
  if (auto* definitions = vtkSMProxyDefinitionManager::SafeDownCast(caller))
  {
    changeAll(definitions);
  }
}

void connectionCreated(vtkObject* caller, unsigned long, void*, void*)
{
  if (auto* module = vtkProcessModule::SafeDownCast(caller))
  {
    tautline::watchMetricDomains(
      vtkSMSession::SafeDownCast(module->GetSession(module->GetEventCallDataSessionId())));
  }
}
}

//------------------------------------------------------------------------------
void tautline::watchMetricDomains(vtkSMSession* session)
{
  vtkSMSessionProxyManager* proxies = session ? session->GetSessionProxyManager() : nullptr;
  if (!proxies || !proxies->GetProxyDefinitionManager())
  {
    return;
  }
  static vtkNew<vtkCallbackCommand> updated;
  updated->SetCallback(definitionsUpdated);
  vtkSMProxyDefinitionManager* definitions = proxies->GetProxyDefinitionManager();
  if (!definitions->HasObserver(vtkSMProxyDefinitionManager::ProxyDefinitionsUpdated, updated))
  {
    definitions->AddObserver(vtkSMProxyDefinitionManager::ProxyDefinitionsUpdated, updated);
  }
  changeAll(definitions);
}

//------------------------------------------------------------------------------
void tautlineRegisterDomains()
{
  vtkClientServerInterpreterInitializer::GetInitializer()->RegisterCallback(
    vtkSMTautlineMetricsDomain::Register);
  vtkProcessModule* module = vtkProcessModule::GetProcessModule();
  if (!module)
  {
    return;
  }
  vtkNew<vtkCallbackCommand> created;
  created->SetCallback(connectionCreated);
  module->AddObserver(vtkCommand::ConnectionCreatedEvent, created);
  vtkSmartPointer<vtkSessionIterator> sessions;
  sessions.TakeReference(module->NewSessionIterator());
  for (sessions->InitTraversal(); !sessions->IsDoneWithTraversal(); sessions->GoToNextItem())
  {
    tautline::watchMetricDomains(vtkSMSession::SafeDownCast(sessions->GetCurrentSession()));
  }
}
