// SPDX-License-Identifier: BSD-3-Clause
#include "ProxyKind.h"

#include "vtkPVXMLElement.h"
#include "vtkSMProxy.h"

#include <cstring>

namespace tautline
{

//------------------------------------------------------------------------------
bool isInMenu(vtkPVXMLElement* hints)
{
  vtkPVXMLElement* menu = hints ? hints->FindNestedElementByName("ShowInMenu") : nullptr;
  return menu && std::strcmp(menu->GetAttributeOrEmpty("category"), "Tautline") == 0;
}

//------------------------------------------------------------------------------
bool isTautline(vtkSMProxy* proxy)
{
  return proxy && isInMenu(proxy->GetHints());
}

//------------------------------------------------------------------------------
bool isDrawnInDock(vtkSMProxy* proxy)
{
  for (const char* name : { "MeshOptimizer", "MeshUntangler", "MeshImprover" })
  {
    if (proxy && std::strcmp(proxy->GetXMLName(), name) == 0)
    {
      return true;
    }
  }
  return false;
}

} // namespace tautline
