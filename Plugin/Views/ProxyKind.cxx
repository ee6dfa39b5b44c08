// SPDX-License-Identifier: BSD-3-Clause
#include "ProxyKind.h"

#include "vtkPVXMLElement.h"
#include "vtkSMProxy.h"

#include <algorithm>
#include <cstring>
#include <iterator>

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
  return proxy &&
    std::any_of(std::begin(DrawnInDock), std::end(DrawnInDock),
      [proxy](const auto& filter) { return std::strcmp(proxy->GetXMLName(), filter[0]) == 0; });
}

} // namespace tautline
