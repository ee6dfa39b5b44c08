#include "pqTautlineZero.h"

#include "pqPropertyWidget.h"

#include "vtkPVXMLElement.h"

#include <QLabel>
#include <QLayout>

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
  }
}
