// SPDX-License-Identifier: BSD-3-Clause
#include "Recolor.h"

#include "ParaViewCompatibility.h"

#include "pqDataRepresentation.h"
#include "pqView.h"

#include "vtkNew.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"

//------------------------------------------------------------------------------
void tautline::recolor(pqDataRepresentation* shown, const char* array, int association, bool legend)
{
  vtkSMProxy* proxy = shown->getProxy();
  vtkSMProxy* view = shown->getView()->getProxy();
  const vtkSmartPointer<vtkSMProxy> before = vtkSMPropertyHelper(proxy, "LookupTable").GetAsProxy();
  ColorMaps::SetScalarColoring(proxy, array, association);
  if (before && before != vtkSMPropertyHelper(proxy, "LookupTable").GetAsProxy())
  {
    vtkNew<vtkSMTransferFunctionManager> manager;
    manager->HideScalarBarIfNotNeeded(before, view);
  }
  ColorMaps::SetScalarBarVisibility(proxy, view, legend);
}
