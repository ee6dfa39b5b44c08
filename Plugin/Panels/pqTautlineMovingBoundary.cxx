// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineMovingBoundary.h"

#include "pqApplicationCore.h"
#include "pqBoxPropertyWidget.h"
#include "pqPipelineSource.h"
#include "pqProxySelectionWidget.h"
#include "pqProxyWidget.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"

#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkSMInputProperty.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMStringVectorProperty.h"
#include "vtkSMVectorProperty.h"

#include <QEvent>
#include <QPushButton>

#include <algorithm>

namespace
{
/// What chooses the part that moves.
constexpr const char* Inputs[] = { "Input", "Target", "MovedSelection", "FixedSelection" };
constexpr const char* Choices[] = { "Motion", "Displacement", "Correspondence", "TargetIds",
  "MovedPart", "Parts", "MovedArray", "Values", "FixedPoints" };

constexpr double Color[3] = { 1.0, 0.5, 0.0 };
constexpr double LineWidth = 5.0;  // pixels
constexpr double PointSize = 10.0; // pixels
constexpr double Opacity = 0.7;    // of the faces of a volume
constexpr double Thickness = 0.1;  // of a box around what is flat, of its longest side
constexpr const char* Hidden = "HiddenRepresentations"; // of a view: shown, but not listed

void copyInput(vtkSMProxy* from, vtkSMProxy* to, const char* name)
{
  vtkSMPropertyHelper given(from, name, true);
  given.SetUseUnchecked(true);
  vtkSMPropertyHelper taken(to, name, true);
  const bool some = given.GetNumberOfElements() > 0 && given.GetAsProxy();
  vtkSMProxy* now = taken.GetNumberOfElements() > 0 ? taken.GetAsProxy() : nullptr;
  if (some && (now != given.GetAsProxy() || taken.GetOutputPort() != given.GetOutputPort()))
  {
    taken.Set(given.GetAsProxy(), given.GetOutputPort());
  }
  else if (!some && now)
  {
    taken.RemoveAllValues();
  }
}

void copyValues(vtkSMProxy* from, vtkSMProxy* to, const char* name)
{
  vtkSMPropertyHelper given(from, name, true);
  given.SetUseUnchecked(true);
  vtkSMPropertyHelper taken(to, name, true);
  const unsigned int size = given.GetNumberOfElements();
  taken.SetNumberOfElements(size);
  for (unsigned int i = 0; i < size; ++i)
  {
    if (vtkSMStringVectorProperty::SafeDownCast(from->GetProperty(name)))
    {
      taken.Set(i, given.GetAsString(i));
    }
    else
    {
      taken.Set(i, given.GetAsDouble(i));
    }
  }
}

/// Bounds of a box that is flat in no direction.
void thicken(double bounds[6])
{
  const double longest =
    std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] });
  for (int axis = 0; axis < 3; ++axis)
  {
    if (bounds[2 * axis] == bounds[2 * axis + 1])
    {
      bounds[2 * axis] -= Thickness / 2 * longest;
      bounds[2 * axis + 1] += Thickness / 2 * longest;
    }
  }
}
}

//------------------------------------------------------------------------------
pqTautlineMovingBoundary::pqTautlineMovingBoundary(vtkPVXMLElement* hint, pqPropertyWidget* field)
  : pqPropertyWidgetDecorator(hint, field)
{
  for (QTimer* timer : { &this->Later, &this->PlaceLater })
  {
    timer->setSingleShot(true);
    timer->setInterval(0);
  }
  QObject::connect(&this->Later, &QTimer::timeout, this, &pqTautlineMovingBoundary::update);
  QObject::connect(&this->PlaceLater, &QTimer::timeout, this, &pqTautlineMovingBoundary::placeBox);
  QObject::connect(
    field, &pqPropertyWidget::viewChanged, &this->Later, QOverload<>::of(&QTimer::start));
  // ParaView places the box around the mesh after an update.
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::dataUpdated, this,
    [this]
    {
      this->Later.start();
      this->PlaceLater.start();
    });
  field->installEventFilter(this);
  this->Later.start();
  this->PlaceLater.start();
}

//------------------------------------------------------------------------------
pqTautlineMovingBoundary::~pqTautlineMovingBoundary()
{
  this->hide();
}

//------------------------------------------------------------------------------
bool pqTautlineMovingBoundary::eventFilter(QObject* object, QEvent* event)
{
  if (event->type() == QEvent::Show || event->type() == QEvent::Hide)
  {
    this->Later.start();
  }
  return this->pqPropertyWidgetDecorator::eventFilter(object, event);
}

//------------------------------------------------------------------------------
void pqTautlineMovingBoundary::connectPanel()
{
  QWidget* panel = this->parentWidget();
  while (panel && !qobject_cast<pqProxyWidget*>(panel))
  {
    panel = panel->parentWidget();
  }
  pqPipelineSource* warp = this->source();
  if (this->Connected || !panel || !warp)
  {
    return;
  }
  this->Connected = true;
  const auto start = QOverload<>::of(&QTimer::start);
  QObject::connect(
    qobject_cast<pqProxyWidget*>(panel), &pqProxyWidget::changeAvailable, &this->Later, start);
  QObject::connect(warp, &pqProxy::modifiedStateChanged, &this->Later, start);
  for (auto* selection : panel->findChildren<pqProxySelectionWidget*>())
  {
    QObject::connect(
      selection, &pqProxySelectionWidget::chosenProxyChanged, &this->PlaceLater, start);
  }
  for (auto* button : panel->findChildren<QPushButton*>("resetBounds"))
  {
    QObject::connect(button, &QPushButton::clicked, &this->PlaceLater, start);
  }
}

//------------------------------------------------------------------------------
pqBoxPropertyWidget* pqTautlineMovingBoundary::box() const
{
  QWidget* panel = this->parentWidget()->parentWidget();
  return panel ? panel->findChild<pqBoxPropertyWidget*>() : nullptr;
}

//------------------------------------------------------------------------------
pqPipelineSource* pqTautlineMovingBoundary::source() const
{
  return pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
    this->parentWidget()->proxy());
}

//------------------------------------------------------------------------------
bool pqTautlineMovingBoundary::bounds(bool wholeMesh, double result[6]) const
{
  vtkSMPropertyHelper input(this->parentWidget()->proxy(), "Input", true);
  vtkSMSourceProxy* mesh =
    input.GetNumberOfElements() > 0 ? vtkSMSourceProxy::SafeDownCast(input.GetAsProxy()) : nullptr;
  vtkSMSourceProxy* data = wholeMesh ? mesh : this->Boundary.Get();
  vtkPVDataInformation* info =
    data ? data->GetDataInformation(wholeMesh ? input.GetOutputPort() : 0) : nullptr;
  if (!info || info->GetNumberOfPoints() == 0)
  {
    return false;
  }
  info->GetBounds(result);
  return true;
}

//------------------------------------------------------------------------------
bool pqTautlineMovingBoundary::find()
{
  const pqScopedUndoExclude notUndone;
  vtkSMProxy* warp = this->parentWidget()->proxy();
  double mesh[6];
  if (!this->bounds(true, mesh))
  {
    return false;
  }
  if (!this->Boundary)
  {
    this->Boundary.TakeReference(vtkSMSourceProxy::SafeDownCast(
      warp->GetSessionProxyManager()->NewProxy("internal_filters", "MovingBoundary")));
  }
  if (!this->Boundary)
  {
    return false;
  }
  for (const char* name : Inputs)
  {
    copyInput(warp, this->Boundary, name);
  }
  for (const char* name : Choices)
  {
    copyValues(warp, this->Boundary, name);
  }
  this->Boundary->UpdateVTKObjects();
  this->Boundary->UpdatePipeline();
  return true;
}

//------------------------------------------------------------------------------
void pqTautlineMovingBoundary::update()
{
  this->connectPanel();
  pqPipelineSource* warp = this->source();
  auto* view = qobject_cast<pqRenderView*>(this->parentWidget()->view());
  const bool wanted =
    warp && this->parentWidget()->isVisible() && warp->modifiedState() != pqProxy::UNMODIFIED;
  if (!wanted || !this->find())
  {
    this->hide();
    return;
  }
  double around[6];
  if (this->bounds(false, around) && !std::equal(around, around + 6, this->Placed))
  {
    this->PlaceLater.start();
  }
  this->show(view);
}

//------------------------------------------------------------------------------
void pqTautlineMovingBoundary::show(pqRenderView* view)
{
  const pqScopedUndoExclude notUndone;
  if (view != this->View)
  {
    this->hide();
  }
  if (view && !this->Shown)
  {
    vtkSMSessionProxyManager* manager = view->getProxy()->GetSessionProxyManager();
    this->Shown.TakeReference(manager->NewProxy("representations", "GeometryRepresentation"));
    vtkNew<vtkSMParaViewPipelineController> controller;
    controller->PreInitializeProxy(this->Shown);
    vtkSMPropertyHelper(this->Shown, "Input").Set(this->Boundary, 0);
    controller->PostInitializeProxy(this->Shown);
    vtkSMPropertyHelper(this->Shown, "AmbientColor").Set(Color, 3);
    vtkSMPropertyHelper(this->Shown, "DiffuseColor").Set(Color, 3);
    vtkSMPropertyHelper(this->Shown, "LineWidth").Set(LineWidth);
    vtkSMPropertyHelper(this->Shown, "PointSize").Set(PointSize);
    vtkSMPropertyHelper(this->Shown, "Opacity").Set(Opacity);
    vtkSMPropertyHelper(this->Shown, "Pickable", true).Set(0);
    this->Shown->UpdateVTKObjects();
    vtkSMPropertyHelper(view->getProxy(), Hidden).Add(this->Shown);
    view->getProxy()->UpdateVTKObjects();
    this->View = view;
  }
  if (view)
  {
    view->render();
  }
}

//------------------------------------------------------------------------------
void pqTautlineMovingBoundary::hide()
{
  const pqScopedUndoExclude notUndone;
  if (this->Shown && this->View)
  {
    vtkSMPropertyHelper(this->View->getProxy(), Hidden).Remove(this->Shown);
    this->View->getProxy()->UpdateVTKObjects();
    this->View->render();
  }
  this->Shown = nullptr;
  this->View = nullptr;
}

//------------------------------------------------------------------------------
void pqTautlineMovingBoundary::placeBox()
{
  const pqScopedUndoExclude notUndone;
  this->connectPanel();
  pqBoxPropertyWidget* widget = this->box();
  double around[6];
  const bool moving = this->bounds(false, around);
  if (!widget || !(moving || this->bounds(true, around)))
  {
    return;
  }
  if (moving)
  {
    std::copy_n(around, 6, this->Placed);
  }
  thicken(around);
  vtkSMProxy* drawn = widget->widgetProxy();
  vtkSMPropertyHelper(drawn, "PlaceWidget").Set(around, 6);
  drawn->UpdateVTKObjects();
  if (pqView* view = this->parentWidget()->view())
  {
    view->render();
  }
}
