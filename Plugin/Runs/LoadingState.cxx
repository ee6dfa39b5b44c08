// SPDX-License-Identifier: BSD-3-Clause
#include "LoadingState.h"

#include "pqApplicationCore.h"

#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"

//------------------------------------------------------------------------------
bool tautline::isLoadingState()
{
  // The first is set for Python states, the second for XML states, even if a script loads them.
  pqApplicationCore* core = pqApplicationCore::instance();
  vtkSMSessionProxyManager* proxies = vtkSMProxyManager::IsInitialized()
    ? vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager()
    : nullptr;
  return (core && core->isLoadingState()) || (proxies && proxies->GetInLoadXMLState());
}
