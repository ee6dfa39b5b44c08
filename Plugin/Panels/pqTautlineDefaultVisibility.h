// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineDefaultVisibility
 * @brief Shows a property while another one has a given value; otherwise it is an advanced one.
 *
 * The hint `<PropertyWidgetDecorator type="tautline_default_visibility" mode="visibility"
 * property="Preset" value="7"/>` of a property selects it. It has the attributes of ParaView's
 * GenericDecorator, which hides the property otherwise, from advanced users too. The property's
 * panel_visibility must be "default".
 */

#ifndef pqTautlineDefaultVisibility_h
#define pqTautlineDefaultVisibility_h

#include "pqGenericPropertyWidgetDecorator.h"

class pqTautlineDefaultVisibility : public pqGenericPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqGenericPropertyWidgetDecorator;

public:
  using Superclass::Superclass;

  bool canShowWidget(bool showAdvanced) const override;
};

#endif
