// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineFilledText.h"

#include "pqCoreUtilities.h"
#include "pqPropertyWidget.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

//------------------------------------------------------------------------------
pqTautlineFilledText::pqTautlineFilledText(vtkPVXMLElement* xml, pqPropertyWidget* parent)
  : Superclass(xml, parent)
{
  pqCoreUtilities::connect(
    parent->property(), vtkCommand::ModifiedEvent, this, SIGNAL(visibilityChanged()));
}

//------------------------------------------------------------------------------
bool pqTautlineFilledText::canShowWidget(bool) const
{
  const char* text = vtkSMPropertyHelper(this->parentWidget()->property()).GetAsString();
  return text && *text;
}
