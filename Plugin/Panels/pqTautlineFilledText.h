// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineFilledText
 * @brief Hides a text of the result, such as notes on the mesh, while it is empty.
 *
 * The hint `<PropertyWidgetDecorator type="tautline_filled_text"/>` of a text property selects it.
 */

#ifndef pqTautlineFilledText_h
#define pqTautlineFilledText_h

#include "pqPropertyWidgetDecorator.h"

class pqTautlineFilledText : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  pqTautlineFilledText(vtkPVXMLElement* xml, pqPropertyWidget* parent);

  bool canShowWidget(bool showAdvanced) const override;
};

#endif
