// SPDX-License-Identifier: BSD-3-Clause
#include "LoadingState.h"

#include "pqApplicationCore.h"

#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"

//------------------------------------------------------------------------------
bool tautline::isLoadingState()
{
  // The first is set for Python states, the second for XML, also where a script loads it.
  pqApplicationCore* core = pqApplicationCore::instance();
  vtkSMSessionProxyManager* proxies = vtkSMProxyManager::IsInitialized()
    ? vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager()
    : nullptr;
  return (core && core->isLoadingState()) || (proxies && proxies->GetInLoadXMLState());
}
