// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMTautlineMetricsDomain.h"

#include "Startup.h"

#include "tautline/Quality/Metrics.h"

#include "vtkClientServerInterpreter.h"
#include "vtkObjectFactory.h"
#include "vtkPVSession.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMStringVectorProperty.h"
#include "vtkSmartPointer.h"

#include <sstream>
#include <string>

vtkStandardNewMacro(vtkSMTautlineMetricsDomain);

namespace
{
vtkObjectBase* create(void*)
{
  return vtkSMTautlineMetricsDomain::New();
}

/// The metrics that are registered where the filters of a session execute.
std::string listOf(vtkSMSession* session)
{
  if (!vtkSMSessionClient::SafeDownCast(session))
  {
    return tautline::listUserMetrics();
  }
  static bool asking = false; // the proxy that is asked has such a domain, too
  if (asking)
  {
    return {};
  }
  asking = true;
  std::string list;
  const auto filter = vtkSmartPointer<vtkSMProxy>::Take(
    session->GetSessionProxyManager()->NewProxy("filters", "ElementQuality"));
  if (filter)
  {
    filter->SetLocation(vtkPVSession::DATA_SERVER_ROOT);
    filter->UpdateVTKObjects();
    filter->UpdatePropertyInformation(filter->GetProperty("UserMetrics"));
    list = vtkSMPropertyHelper(filter, "UserMetrics").GetAsString();
  }
  asking = false;
  return list;
}
}

//------------------------------------------------------------------------------
void vtkSMTautlineMetricsDomain::Register(vtkClientServerInterpreter* interpreter)
{
  interpreter->AddNewInstanceFunction("vtkSMTautlineMetricsDomain", create);
}

//------------------------------------------------------------------------------
int vtkSMTautlineMetricsDomain::ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element)
{
  const int result = this->Superclass::ReadXMLAttributes(property, element);
  vtkSMProxy* proxy = property ? property->GetParent() : nullptr;
  this->AddMetrics(proxy ? listOf(proxy->GetSession()) : "");
  return result;
}

//------------------------------------------------------------------------------
void vtkSMTautlineMetricsDomain::Update(vtkSMProperty*)
{
  auto* list = vtkSMStringVectorProperty::SafeDownCast(this->GetRequiredProperty("List"));
  if (list && list->GetNumberOfElements() > 0)
  {
    this->AddMetrics(list->GetElement(0));
  }
}

//------------------------------------------------------------------------------
void vtkSMTautlineMetricsDomain::AddMetrics(const std::string& list)
{
  tautline::mirrorUserMetrics(list);
  tautlineInstallColorMaps();
  bool added = false;
  std::istringstream lines(list);
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t tab = line.find('\t');
    unsigned int index = 0;
    const int number = std::stoi(line);
    if (tab != std::string::npos && !this->IsInDomain(number, index))
    {
      const std::string label = line.substr(tab + 1, line.find('\t', tab + 1) - tab - 1);
      this->AddEntry(label.c_str(), number);
      added = true;
    }
  }
  if (added)
  {
    this->DomainModified();
  }
}
