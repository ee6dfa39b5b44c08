// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlinePlanarBox.h"

#include "pqApplicationCore.h"
#include "pqBoxPropertyWidget.h"
#include "pqDoubleLineEdit.h"
#include "pqPipelineSource.h"
#include "pqProxySelectionWidget.h"
#include "pqServerManagerModel.h"

#include "vtkAbstractWidget.h"
#include "vtkBoxRepresentation.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkEvent.h"
#include "vtkInteractorObserver.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSMNewWidgetRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkWidgetEvent.h"
#include "vtkWidgetEventTranslator.h"

#include <QLabel>
#include <QLayout>
#include <QTimer>

#include <cmath>
#include <utility>

namespace
{
/// What a transform in the plane z = constant leaves as it is: name of the field, value.
constexpr const char* Kept[][2] = { { "translateZ", "0" }, { "scaleZ", "1" }, { "rotateX", "0" },
  { "rotateY", "0" } };

constexpr const char* HintName = "PlanarBoxHint";
constexpr const char* Hint = "In the view: drag moves the box, Ctrl+drag turns it, Shift+drag of a "
                             "handle scales it along an axis, the right button along both.";
constexpr float BeforeWidgets = 1.0F; ///< priority of observers; widgets have 0.5
constexpr int Precise = 10;           ///< digits of the fields

/// A field of the panel of the box.
pqDoubleLineEdit* fieldOf(pqBoxPropertyWidget* box, const char* name)
{
  return box ? box->findChild<pqDoubleLineEdit*>(name) : nullptr;
}

/// The left button does what the middle one does, and with Shift what it did without.
void moveByLeftButton(vtkAbstractWidget* widget)
{
  vtkWidgetEventTranslator* events = widget ? widget->GetEventTranslator() : nullptr;
  for (const auto& [modifier, action] :
    { std::pair<int, unsigned long>(vtkEvent::NoModifier, vtkWidgetEvent::Translate),
      std::pair<int, unsigned long>(vtkEvent::ShiftModifier, vtkWidgetEvent::Select) })
  {
    if (events)
    {
      vtkNew<vtkEvent> press;
      press->SetEventId(vtkCommand::LeftButtonPressEvent);
      press->SetModifier(modifier);
      events->RemoveTranslation(press);
      events->SetTranslation(vtkCommand::LeftButtonPressEvent, modifier, 0, 0, nullptr, action);
    }
  }
}
}

//------------------------------------------------------------------------------
pqTautlinePlanarBox::pqTautlinePlanarBox(vtkPVXMLElement* hint, pqPropertyWidget* field)
  : pqPropertyWidgetDecorator(hint, field)
{
  // After the panel has made its widgets, and placed the box.
  const auto later = [this] { QTimer::singleShot(0, this, &pqTautlinePlanarBox::adapt); };
  if (auto* selection = qobject_cast<pqProxySelectionWidget*>(field))
  {
    QObject::connect(selection, &pqProxySelectionWidget::chosenProxyChanged, this, later);
  }
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::dataUpdated, this, later);
  later();
}

//------------------------------------------------------------------------------
pqTautlinePlanarBox::~pqTautlinePlanarBox()
{
  this->observe(nullptr);
}

//------------------------------------------------------------------------------
pqBoxPropertyWidget* pqTautlinePlanarBox::box() const
{
  return this->parentWidget() ? this->parentWidget()->findChild<pqBoxPropertyWidget*>() : nullptr;
}

//------------------------------------------------------------------------------
bool pqTautlinePlanarBox::planarBounds(double bounds[6]) const
{
  vtkSMPropertyHelper input(this->parentWidget()->proxy(), "Input", true);
  auto* source =
    input.GetNumberOfElements() > 0 ? vtkSMSourceProxy::SafeDownCast(input.GetAsProxy()) : nullptr;
  vtkPVDataInformation* info = source ? source->GetDataInformation(input.GetOutputPort()) : nullptr;
  if (!info || info->GetNumberOfPoints() == 0)
  {
    return false;
  }
  info->GetBounds(bounds);
  return bounds[4] == bounds[5];
}

//------------------------------------------------------------------------------
void pqTautlinePlanarBox::adapt()
{
  pqBoxPropertyWidget* widget = this->box();
  double bounds[6];
  if (!widget || !this->planarBounds(bounds))
  {
    return;
  }
  vtkAbstractWidget* drawn = widget->widgetProxy()->GetWidget();
  moveByLeftButton(drawn);
  this->observe(drawn ? drawn->GetInteractor() : nullptr);
  if (!widget->findChild<QLabel*>(HintName) && widget->layout())
  {
    auto* hint = new QLabel(Hint, widget);
    hint->setObjectName(HintName);
    hint->setWordWrap(true);
    widget->layout()->addWidget(hint);
  }
  for (const auto& [name, value] : Kept)
  {
    if (auto* field = widget->findChild<pqDoubleLineEdit*>(name))
    {
      field->setEnabled(false);
      field->setToolTip("The mesh is planar: it moves within its plane.");
    }
  }
  QObject::connect(widget, &pqPropertyWidget::changeAvailable, this,
    &pqTautlinePlanarBox::keepInPlane, Qt::UniqueConnection);
  QObject::connect(widget, &pqPropertyWidget::changeFinished, this,
    &pqTautlinePlanarBox::keepInPlane, Qt::UniqueConnection);
}

//------------------------------------------------------------------------------
void pqTautlinePlanarBox::keepInPlane()
{
  pqBoxPropertyWidget* widget = this->box();
  double bounds[6];
  if (!widget || !this->planarBounds(bounds))
  {
    return;
  }
  for (const auto& [name, value] : Kept)
  {
    auto* field = widget->findChild<pqDoubleLineEdit*>(name);
    if (field && field->text().toDouble() != QString(value).toDouble())
    {
      field->setTextAndResetCursor(value);
      Q_EMIT field->textChangedAndEditingFinished();
    }
  }
}

//------------------------------------------------------------------------------
vtkBoxRepresentation* pqTautlinePlanarBox::drawnBox() const
{
  pqBoxPropertyWidget* widget = this->box();
  vtkAbstractWidget* drawn = widget ? widget->widgetProxy()->GetWidget() : nullptr;
  return drawn && drawn->GetEnabled()
    ? vtkBoxRepresentation::SafeDownCast(drawn->GetRepresentation())
    : nullptr;
}

//------------------------------------------------------------------------------
void pqTautlinePlanarBox::observe(vtkRenderWindowInteractor* interactor)
{
  if (interactor == this->Observed)
  {
    return;
  }
  for (const unsigned long observer : std::exchange(this->Observers, {}))
  {
    if (this->Observed)
    {
      this->Observed->RemoveObserver(observer);
    }
  }
  this->Observed = interactor;
  if (interactor)
  {
    this->Observers = { interactor->AddObserver(vtkCommand::LeftButtonPressEvent, this,
                          &pqTautlinePlanarBox::press, BeforeWidgets),
      interactor->AddObserver(
        vtkCommand::MouseMoveEvent, this, &pqTautlinePlanarBox::move, BeforeWidgets),
      interactor->AddObserver(
        vtkCommand::LeftButtonReleaseEvent, this, &pqTautlinePlanarBox::release, BeforeWidgets) };
  }
}

//------------------------------------------------------------------------------
double pqTautlinePlanarBox::direction(double center[3]) const
{
  vtkBoxRepresentation* drawn = this->drawnBox();
  const double* bounds = drawn->GetBounds();
  for (int axis = 0; axis < 3; ++axis)
  {
    center[axis] = 0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]);
  }
  double shown[3];
  vtkInteractorObserver::ComputeWorldToDisplay(
    drawn->GetRenderer(), center[0], center[1], center[2], shown);
  const int* mouse = this->Observed->GetEventPosition();
  return vtkMath::DegreesFromRadians(std::atan2(mouse[1] - shown[1], mouse[0] - shown[0]));
}

//------------------------------------------------------------------------------
bool pqTautlinePlanarBox::press(vtkObject*, unsigned long, void*)
{
  vtkBoxRepresentation* drawn = this->drawnBox();
  double bounds[6], center[3];
  if (!drawn || !drawn->GetRenderer() || !this->Observed->GetControlKey() ||
    !this->planarBounds(bounds))
  {
    return false;
  }
  const int* mouse = this->Observed->GetEventPosition();
  if (drawn->ComputeInteractionState(mouse[0], mouse[1]) == vtkBoxRepresentation::Outside)
  {
    return false;
  }
  this->Turning = true;
  this->Last = this->direction(center);
  return true;
}

//------------------------------------------------------------------------------
bool pqTautlinePlanarBox::move(vtkObject*, unsigned long, void*)
{
  vtkBoxRepresentation* drawn = this->drawnBox();
  if (!this->Turning || !drawn || !drawn->GetRenderer())
  {
    return false;
  }
  double center[3];
  const double now = this->direction(center);
  // From behind the plane, a turn to the left is one to the right.
  const double* normal = drawn->GetRenderer()->GetActiveCamera()->GetViewPlaneNormal();
  const double turned = std::remainder(now - this->Last, 360.0);
  this->Last = now;
  this->turn(normal[2] < 0 ? -turned : turned, center);
  return true;
}

//------------------------------------------------------------------------------
bool pqTautlinePlanarBox::release(vtkObject*, unsigned long, void*)
{
  return std::exchange(this->Turning, false);
}

//------------------------------------------------------------------------------
void pqTautlinePlanarBox::turn(double degrees, const double center[3])
{
  pqBoxPropertyWidget* widget = this->box();
  pqDoubleLineEdit* fields[] = { fieldOf(widget, "translateX"), fieldOf(widget, "translateY"),
    fieldOf(widget, "rotateZ") };
  double values[3];
  for (int i = 0; i < 3; ++i)
  {
    if (!fields[i])
    {
      return;
    }
    values[i] = fields[i]->text().toDouble();
  }
  // The transform scales and turns about the origin, then translates.
  const double angle = vtkMath::RadiansFromDegrees(degrees);
  const double x = values[0] - center[0], y = values[1] - center[1];
  values[0] = center[0] + std::cos(angle) * x - std::sin(angle) * y;
  values[1] = center[1] + std::sin(angle) * x + std::cos(angle) * y;
  values[2] = std::remainder(values[2] + degrees, 360.0);
  for (int i = 0; i < 3; ++i)
  {
    fields[i]->setTextAndResetCursor(QString::number(values[i], 'g', Precise));
    Q_EMIT fields[i]->textChangedAndEditingFinished();
  }
}
