// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlinePictures.h"

#include "ParaViewCompatibility.h"
#include "ProxyKind.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineFilter.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"

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
constexpr double MeshOpacity = 0.6;
constexpr double Behind = 1e-3; // distance of the image from the mesh, of its size

pqServerManagerModel* model()
{
  pqApplicationCore* core = pqApplicationCore::instance();
  return core ? core->getServerManagerModel() : nullptr;
}

/// The port of the filter that has the image in which the mesh was found, or null.
pqOutputPort* imageOf(pqPipelineFilter* filter)
{
  const std::string name = filter->getProxy()->GetXMLName();
  const QString input = name == "MatchShape" ? "Target" : name == "SilhouetteToMesh" ? "Input" : "";
  const QList<pqOutputPort*> ports =
    input.isEmpty() ? QList<pqOutputPort*>() : filter->getInputs(input);
  return ports.isEmpty() ? nullptr : ports.front();
}

/// Draws the colours of a picture as they are.
void showColors(vtkSMProxy* picture)
{
  vtkSMPropertyHelper(picture, "Representation").Set("Slice");
  vtkSMPropertyHelper(picture, "MapScalars", true).Set(0);
  picture->UpdateVTKObjects();
}

/// Bytes are drawn as they are, grey values or colours; other `pixels` by a colour map.
void moveBehind(vtkSMProxy* image, const double bounds[6], int pixels)
{
  if (image->GetProperty("Representation") && image->GetProperty("Position"))
  {
    const double size = std::max(bounds[1] - bounds[0], bounds[3] - bounds[2]);
    const double position[3] = { 0.0, 0.0, -Behind * size };
    vtkSMPropertyHelper(image, "Representation").Set("Surface");
    vtkSMPropertyHelper(image, "Position").Set(position, 3);
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
  // After Apply, which hides the inputs.
  const QPointer<pqDataRepresentation> mesh = qobject_cast<pqDataRepresentation*>(shown);
  QTimer::singleShot(0, this,
    [this, mesh]
    {
      if (mesh && mesh->getInput() && tautline::isTautline(mesh->getInput()->getProxy()))
      {
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
  if (view && port->getPortName() == SheetPort)
  {
    showColors(mesh->getProxy());
    tautline::ColorMaps::SetScalarColoring(mesh->getProxy(), SheetPort, vtkDataObject::POINT);
    tautline::ColorMaps::SetScalarBarVisibility(mesh->getProxy(), view->getViewProxy(), false);
    view->resetDisplay();
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
  vtkPVArrayInformation* pixels =
    image->getDataInformation()->GetPointDataInformation()->GetAttributeInformation(
      vtkDataSetAttributes::SCALARS);
  moveBehind(picture, bounds, pixels ? pixels->GetDataType() : VTK_VOID);
  vtkSMPropertyHelper(mesh->getProxy(), "Opacity").Set(MeshOpacity);
  mesh->getProxy()->UpdateVTKObjects();
  mesh->renderViewEventually();
}
