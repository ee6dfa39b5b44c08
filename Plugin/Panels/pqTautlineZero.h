// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineZero
 * @brief Writes beside the field of a property what its value 0 stands for: "0 = no limit".
 *
 * The hint `<PropertyWidgetDecorator type="tautline_zero" text="no limit"/>` of a property selects
 * it. Labels do not have this text, since the names of properties in Python are made of them. The
 * panel is widened until the text is seen.
 */

#ifndef pqTautlineZero_h
#define pqTautlineZero_h

#include "pqPropertyWidgetDecorator.h"

class pqTautlineZero : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  pqTautlineZero(vtkPVXMLElement* hint, pqPropertyWidget* field);

protected:
  bool eventFilter(QObject* field, QEvent* event) override;

private Q_SLOTS:
  void fitWidth();
};

#endif
