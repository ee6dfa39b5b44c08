// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineScriptOnly
 * @brief Hides a property from the panel, and only from there.
 *
 * An information property whose panel_visibility is "never" is missing in ParaView's Python. This
 * is for numbers of a result, which scripts read and the panel has in its summary.
 *
 * The hint `<PropertyWidgetDecorator type="tautline_script_only"/>` of a property selects it.
 */

#ifndef pqTautlineScriptOnly_h
#define pqTautlineScriptOnly_h

#include "pqPropertyWidgetDecorator.h"

class pqTautlineScriptOnly : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  using Superclass::Superclass;

  bool canShowWidget(bool) const override { return false; }
};

#endif
