// SPDX-License-Identifier: BSD-3-Clause
#include "RegionLegend.h"

#include "Recolor.h"

#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqView.h"

#include "vtkDataObject.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMTransferFunctionProxy.h"
#include "vtkSMViewProxy.h"

#include <iterator>

namespace
{
constexpr const char* Regions = "Reference";
/// Value and name of each region, and its color: the color of good elements, and gray.
constexpr const char* Names[] = { "1", "1: domain", "2", "2: interaction layer" };
constexpr double Colors[] = { 0.49, 0.71, 0.87, 0.75, 0.75, 0.75 };
}

//------------------------------------------------------------------------------
void tautline::showRegions(pqDataRepresentation* mesh)
{
  vtkSMProxy* shown = mesh->getProxy();
  vtkPVDataInformation* data = mesh->getOutputPortFromInput()->getDataInformation();
  if (!mesh->getView() || !shown->GetProperty("UseSeparateColorMap") ||
    !data->GetCellDataInformation()->GetArrayInformation(Regions))
  {
    return;
  }
  vtkSMPropertyHelper(shown, "UseSeparateColorMap").Set(1);
  shown->UpdateVTKObjects();
  recolor(mesh, Regions, vtkDataObject::CELL, true);
  vtkSMProxy* map = vtkSMPropertyHelper(shown, "LookupTable").GetAsProxy();
  if (!map)
  {
    return;
  }
  vtkSMPropertyHelper(map, "IndexedLookup").Set(1);
  vtkSMPropertyHelper names(map, "Annotations");
  names.SetNumberOfElements(0);
  for (unsigned int i = 0; i < std::size(Names); ++i)
  {
    names.Set(i, Names[i]);
  }
  vtkSMPropertyHelper(map, "IndexedColors").Set(Colors, static_cast<unsigned>(std::size(Colors)));
  map->UpdateVTKObjects();
  vtkSMProxy* view = mesh->getView()->getProxy();
  if (vtkSMProxy* legend = vtkSMTransferFunctionProxy::FindScalarBarRepresentation(map, view))
  {
    vtkSMPropertyHelper(legend, "Title").Set("Region");
    vtkSMPropertyHelper(legend, "ComponentTitle").Set("");
    legend->UpdateVTKObjects();
  }
  mesh->renderViewEventually();
}
