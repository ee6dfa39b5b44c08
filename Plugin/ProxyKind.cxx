#include "ProxyKind.h"

#include "vtkPVXMLElement.h"
#include "vtkSMProxy.h"

#include <cstring>

namespace tautline
{

//------------------------------------------------------------------------------
bool isTautline(vtkSMProxy* proxy)
{
  vtkPVXMLElement* hints = proxy ? proxy->GetHints() : nullptr;
  vtkPVXMLElement* menu = hints ? hints->FindNestedElementByName("ShowInMenu") : nullptr;
  return menu && std::strcmp(menu->GetAttributeOrEmpty("category"), "Tautline") == 0;
}

} // namespace tautline
