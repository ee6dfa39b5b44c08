// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlinePictures.h"

#include "LoadingState.h"
#include "ParaViewCompatibility.h"
#include "ProxyKind.h"
#include "Recolor.h"
#include "RegionLegend.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineFilter.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkType.h"

#include <QList>
#include <QPointer>
#include <QString>
#include <QTimer>

#include <algorithm>
#include <string>

namespace
{
constexpr int MeshPort = 0;
constexpr const char* SheetPort = "Sheet"; // of Shape Retrieval
constexpr const char* ListReader = "SilhouetteSetReader";
constexpr double MeshOpacity = 0.6;
constexpr double Behind = 1e-3; // distance of the image from the mesh, relative to its size

pqServerManagerModel* model()
{
  pqApplicationCore* core = pqApplicationCore::instance();
  return core ? core->getServerManagerModel() : nullptr;
}

/// Whether the display of a proxy is changed; the reader is not in the Tautline menu.
bool isArranged(vtkSMProxy* proxy)
{
  return tautline::isTautline(proxy) || std::string(proxy->GetXMLName()) == ListReader;
}

/// The output with the image in which the mesh was found, or null.
pqOutputPort* imageOf(pqPipelineFilter* filter)
{
  const std::string name = filter->getProxy()->GetXMLName();
  const QString input = name == "MatchShape" ? "Target" : name == "SilhouetteToMesh" ? "Input" : "";
  const QList<pqOutputPort*> ports =
    input.isEmpty() ? QList<pqOutputPort*>() : filter->getInputs(input);
  return ports.isEmpty() ? nullptr : ports.front();
}

/// The pixel array, or null; for several images, which have no scalars, the first array.
vtkPVArrayInformation* pixelsOf(pqOutputPort* image)
{
  auto* arrays = image->getDataInformation()->GetPointDataInformation();
  vtkPVArrayInformation* scalars = arrays->GetAttributeInformation(vtkDataSetAttributes::SCALARS);
  return scalars || arrays->GetNumberOfArrays() == 0 ? scalars : arrays->GetArrayInformation(0);
}

/// Draws a picture in its own colors, without a legend.
void showColors(pqDataRepresentation* shown, const char* representation, const char* array)
{
  vtkSMProxy* picture = shown->getProxy();
  vtkSMPropertyHelper(picture, "Representation").Set(representation);
  vtkSMPropertyHelper(picture, "MapScalars", true).Set(0);
  picture->UpdateVTKObjects();
  tautline::recolor(shown, array, vtkDataObject::POINT, false);
  if (auto* view = qobject_cast<pqRenderView*>(shown->getView()))
  {
    view->resetDisplay();
  }
}

/// Bytes are drawn directly as gray values or colors; other `pixels` with a color map.
void moveBehind(vtkSMProxy* image, const double bounds[6], int pixels)
{
  if (image->GetProperty("Representation") && image->GetProperty(tautline::TranslationProperty))
  {
    const double size = std::max(bounds[1] - bounds[0], bounds[3] - bounds[2]);
    const double position[3] = { 0.0, 0.0, -Behind * size };
    vtkSMPropertyHelper(image, "Representation").Set("Surface");
    vtkSMPropertyHelper(image, tautline::TranslationProperty).Set(position, 3);
    vtkSMPropertyHelper(image, "MapScalars", true).Set(pixels == VTK_UNSIGNED_CHAR ? 0 : 1);
    image->UpdateVTKObjects();
  }
}
}

//------------------------------------------------------------------------------
void pqTautlinePictures::startup()
{
  QObject::connect(
    model(), &pqServerManagerModel::representationAdded, this, &pqTautlinePictures::added);
}

//------------------------------------------------------------------------------
void pqTautlinePictures::shutdown()
{
  if (model())
  {
    QObject::disconnect(model(), nullptr, this, nullptr);
  }
}

//------------------------------------------------------------------------------
void pqTautlinePictures::added(pqRepresentation* shown)
{
  if (tautline::isLoadingState())
  {
    return;
  }
  // After Apply, which hides the inputs.
  const QPointer<pqDataRepresentation> mesh = qobject_cast<pqDataRepresentation*>(shown);
  QTimer::singleShot(0, this,
    [this, mesh]
    {
      if (mesh && mesh->getInput() && isArranged(mesh->getInput()->getProxy()))
      {
        const pqScopedUndoExclude notUndone;
        this->arrange(mesh);
      }
    });
}

//------------------------------------------------------------------------------
void pqTautlinePictures::arrange(pqDataRepresentation* mesh)
{
  auto* view = qobject_cast<pqRenderView*>(mesh->getView());
  auto* filter = qobject_cast<pqPipelineFilter*>(mesh->getInput());
  pqOutputPort* port = mesh->getOutputPortFromInput();
  const std::string name = mesh->getInput()->getProxy()->GetXMLName();
  if (view && port->getPortName() == SheetPort)
  {
    showColors(mesh, "Slice", SheetPort);
    return;
  }
  if (view && name == ListReader)
  {
    if (vtkPVArrayInformation* pixels = pixelsOf(port))
    {
      showColors(mesh, "Surface", pixels->GetName());
    }
    return;
  }
  if (view && port->getPortNumber() == MeshPort &&
    (name == "InteractionLayer" || name == "MeshDomain"))
  {
    tautline::showRegions(mesh);
    return;
  }
  if (!view || !filter || port->getPortNumber() != MeshPort)
  {
    return;
  }
  pqOutputPort* image = imageOf(filter);
  if (!image || image->getDataInformation()->GetNumberOfPoints() == 0)
  {
    return;
  }
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSMProxy* picture = controller->Show(
    image->getSource()->getSourceProxy(), image->getPortNumber(), view->getViewProxy());
  if (!picture)
  {
    return;
  }
  double bounds[6];
  image->getDataInformation()->GetBounds(bounds);
  vtkPVArrayInformation* pixels = pixelsOf(image);
  moveBehind(picture, bounds, pixels ? pixels->GetDataType() : VTK_VOID);
  vtkSMPropertyHelper(mesh->getProxy(), "Opacity").Set(MeshOpacity);
  mesh->getProxy()->UpdateVTKObjects();
  mesh->renderViewEventually();
}
