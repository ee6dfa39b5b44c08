// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineBadElements.h"

#include "CriteriaTicks.h"
#include "ProxyKind.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"

#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMViewProxy.h"

#include <QPointer>
#include <QTimer>
#include <QVariant>

namespace
{
constexpr double FadedOpacity = 0.2;
constexpr const char* Opacity = "Opacity";
/// Property of a representation made translucent: its previous opacity.
constexpr const char* Before = "TautlineOpacityBefore";
constexpr double EdgeColor[3] = { 0.1, 0.1, 0.1 };
constexpr const char* Style = "Representation";
constexpr const char* WorstPort = "Worst";
constexpr double WorstSize = 12.0; // pixels

/// Cell array of a mesh with curved cells.
constexpr const char* CurvedArray = "MinimumPoint";
constexpr const char* Subdivision = "NonlinearSubdivisionLevel";
/// Subdivision level at which an edge looks curved (2^3 parts); ParaView's default is one.
constexpr int CurvedLevel = 3, DefaultLevel = 1;
/// Property of a representation whose edges were made to look curved.
constexpr const char* Refined = "TautlineRefined";

pqServerManagerModel* model()
{
  pqApplicationCore* core = pqApplicationCore::instance();
  return core ? core->getServerManagerModel() : nullptr;
}

/// Whether a mesh extends in all directions, so that points can lie inside.
bool isSolid(pqDataRepresentation* mesh)
{
  const double* bounds = mesh->getOutputPortFromInput()->getDataInformation()->GetBounds();
  return bounds[0] < bounds[1] && bounds[2] < bounds[3] && bounds[4] < bounds[5];
}

/// The output that is drawn inside the mesh; null if there is none.
pqOutputPort* insideOf(pqPipelineSource* source)
{
  pqOutputPort* bad = source->getOutputPort(tautline::BadElementsPort);
  return bad ? bad : source->getOutputPort(tautline::SectionsPort);
}

bool isCurved(pqDataRepresentation* mesh)
{
  vtkPVDataInformation* info = mesh->getOutputPortFromInput()->getDataInformation();
  return info->GetArrayInformation(CurvedArray, vtkDataObject::CELL) != nullptr;
}

/// Draws the edges of curved cells as curves, unless the user has chosen how, once.
void refine(pqDataRepresentation* elements)
{
  if (!elements || elements->property(Refined).isValid() ||
    !elements->getProxy()->GetProperty(Subdivision))
  {
    return;
  }
  elements->setProperty(Refined, true);
  vtkSMPropertyHelper level(elements->getProxy(), Subdivision);
  if (level.GetAsInt() == DefaultLevel)
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", elements->getProxy());
    level.Set(CurvedLevel);
    elements->getProxy()->UpdateVTKObjects();
    elements->renderViewEventually();
  }
}

/// Draws points as spheres.
void enlarge(pqDataRepresentation* points)
{
  if (points->getProxy()->GetProperty("RenderPointsAsSpheres"))
  {
    vtkSMPropertyHelper(points->getProxy(), "RenderPointsAsSpheres").Set(1);
    vtkSMPropertyHelper(points->getProxy(), "PointSize").Set(WorstSize);
    points->getProxy()->UpdateVTKObjects();
  }
}
}

//------------------------------------------------------------------------------
void pqTautlineBadElements::startup()
{
  QObject::connect(
    model(), &pqServerManagerModel::dataUpdated, this, &pqTautlineBadElements::dataUpdated);
}

//------------------------------------------------------------------------------
void pqTautlineBadElements::shutdown()
{
  if (model())
  {
    QObject::disconnect(model(), nullptr, this, nullptr);
  }
}

//------------------------------------------------------------------------------
void pqTautlineBadElements::dataUpdated(pqPipelineSource* source)
{
  if (tautline::isTautline(source->getProxy()) && insideOf(source))
  {
    // The mesh is shown after the first execution, and may be hidden and shown again.
    QObject::connect(source, &pqPipelineSource::visibilityChanged, this,
      &pqTautlineBadElements::arrangeLater, Qt::UniqueConnection);
    this->arrangeLater(source);
  }
}

//------------------------------------------------------------------------------
void pqTautlineBadElements::arrangeLater(pqPipelineSource* source)
{
  // After Apply, which makes the representations.
  const QPointer<pqPipelineSource> updated = source;
  QTimer::singleShot(0, this,
    [this, updated]
    {
      if (updated)
      {
        const pqScopedUndoExclude notUndone;
        this->arrange(updated);
      }
    });
}

//------------------------------------------------------------------------------
void pqTautlineBadElements::arrange(pqPipelineSource* source)
{
  pqOutputPort* worst = source->getOutputPort(WorstPort);
  constexpr int meshPort = 0;
  pqOutputPort* inside = insideOf(source);
  const bool some = inside->getDataInformation()->GetNumberOfCells() > 0;
  for (pqView* view : source->getViews())
  {
    pqDataRepresentation* mesh = source->getOutputPort(meshPort)->getRepresentation(view);
    pqDataRepresentation* elements = inside->getRepresentation(view);
    if (!mesh || !mesh->getProxy()->GetProperty(Opacity))
    {
      continue;
    }
    tautline::labelLegend(mesh, source->getProxy());
    if (some && mesh->isVisible() && !elements)
    {
      vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
      controller->Show(source->getSourceProxy(), inside->getPortNumber(), view->getViewProxy());
      elements = inside->getRepresentation(view);
    }
    pqDataRepresentation* points = worst ? worst->getRepresentation(view) : nullptr;
    if (isCurved(mesh))
    {
      refine(mesh);
      refine(elements);
      // The smallest determinants of the worst curved cells, hidden by the faces of the cells.
      if (some && worst && mesh->isVisible() && !points)
      {
        vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
        controller->Show(source->getSourceProxy(), worst->getPortNumber(), view->getViewProxy());
        points = worst->getRepresentation(view);
      }
    }
    const bool pointsInside = points && points->isVisible() && isSolid(mesh);
    if (pointsInside)
    {
      enlarge(points);
      this->fade(mesh, nullptr);
    }
    if (some && elements && elements->isVisible())
    {
      this->fade(mesh, elements);
    }
    else if (!some && !pointsInside)
    {
      this->restore(mesh);
    }
  }
}

//------------------------------------------------------------------------------
void pqTautlineBadElements::fade(pqDataRepresentation* mesh, pqDataRepresentation* inside)
{
  vtkSMPropertyHelper opacity(mesh->getProxy(), Opacity);
  if (mesh->property(Before).isValid() || opacity.GetAsDouble() < 1.0)
  {
    return;
  }
  mesh->setProperty(Before, opacity.GetAsDouble());
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", mesh->getProxy());
    opacity.Set(FadedOpacity);
    mesh->getProxy()->UpdateVTKObjects();
  }
  const bool elements =
    inside && inside->getOutputPortFromInput()->getPortName() == tautline::BadElementsPort;
  if (elements && inside->getProxy()->GetProperty(Style))
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", inside->getProxy());
    vtkSMPropertyHelper(inside->getProxy(), Style).Set("Surface With Edges");
    vtkSMPropertyHelper(inside->getProxy(), "EdgeColor").Set(EdgeColor, 3);
    inside->getProxy()->UpdateVTKObjects();
  }
  mesh->renderViewEventually();
}

//------------------------------------------------------------------------------
void pqTautlineBadElements::restore(pqDataRepresentation* mesh)
{
  const QVariant before = mesh->property(Before);
  if (!before.isValid())
  {
    return;
  }
  vtkSMPropertyHelper opacity(mesh->getProxy(), Opacity);
  if (opacity.GetAsDouble() == FadedOpacity)
  {
    opacity.Set(before.toDouble());
    mesh->getProxy()->UpdateVTKObjects();
    mesh->renderViewEventually();
  }
  mesh->setProperty(Before, QVariant());
}
