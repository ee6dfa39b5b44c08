// SPDX-License-Identifier: BSD-3-Clause
#include "Version.h"

namespace tautline
{

const char* version()
{
  return TAUTLINE_VERSION;
}

} // namespace tautline
