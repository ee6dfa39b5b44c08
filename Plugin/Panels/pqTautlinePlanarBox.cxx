// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlinePlanarBox.h"

#include "pqApplicationCore.h"
#include "pqBoxPropertyWidget.h"
#include "pqDoubleLineEdit.h"
#include "pqPipelineSource.h"
#include "pqProxySelectionWidget.h"
#include "pqServerManagerModel.h"

#include "vtkAbstractWidget.h"
#include "vtkCommand.h"
#include "vtkEvent.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkSMNewWidgetRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkWidgetEvent.h"
#include "vtkWidgetEventTranslator.h"

#include <QTimer>

#include <utility>

namespace
{
/// What a transform in the plane z = constant leaves as it is: name of the field, value.
constexpr const char* Kept[][2] = { { "translateZ", "0" }, { "scaleZ", "1" }, { "rotateX", "0" },
  { "rotateY", "0" } };

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
  moveByLeftButton(widget->widgetProxy()->GetWidget());
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
