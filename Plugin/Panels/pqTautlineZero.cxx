// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineZero.h"

#include "PanelWidth.h"

#include "pqPropertyWidget.h"

#include "vtkPVXMLElement.h"

#include <QEvent>
#include <QLabel>
#include <QLayout>
#include <QScrollBar>
#include <QTimer>

//------------------------------------------------------------------------------
pqTautlineZero::pqTautlineZero(vtkPVXMLElement* hint, pqPropertyWidget* field)
  : pqPropertyWidgetDecorator(hint, field)
{
  const char* meaning = hint->GetAttribute("text");
  if (meaning && field->layout())
  {
    auto* label = new QLabel("0 = " + QString::fromUtf8(meaning), field);
    label->setObjectName("Zero");
    label->setEnabled(false);
    field->layout()->addWidget(label);
    field->installEventFilter(this);
  }
}

//------------------------------------------------------------------------------
bool pqTautlineZero::eventFilter(QObject* field, QEvent* event)
{
  const QScrollBar* bar = event->type() == QEvent::Show
    ? tautline::horizontalScrollBar(qobject_cast<QWidget*>(field))
    : nullptr;
  if (bar)
  {
    // When the layout of the panel is done.
    QObject::connect(bar, &QScrollBar::rangeChanged, this, &pqTautlineZero::fitWidth,
      static_cast<Qt::ConnectionType>(Qt::QueuedConnection | Qt::UniqueConnection));
    QTimer::singleShot(0, this, &pqTautlineZero::fitWidth);
  }
  return this->Superclass::eventFilter(field, event);
}

//------------------------------------------------------------------------------
void pqTautlineZero::fitWidth()
{
  tautline::fitDock(this->parentWidget());
}
