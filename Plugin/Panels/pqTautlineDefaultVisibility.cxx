// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineDefaultVisibility.h"

//------------------------------------------------------------------------------
bool pqTautlineDefaultVisibility::canShowWidget(bool showAdvanced) const
{
  return showAdvanced || this->Superclass::canShowWidget(showAdvanced);
}
