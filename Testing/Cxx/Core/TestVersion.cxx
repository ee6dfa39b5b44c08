// SPDX-License-Identifier: BSD-3-Clause
#include "Check.h"

#include "tautline/Core/Version.h"

#include <string>

int TestVersion(int, char*[])
{
  TAUTLINE_CHECK(std::string(tautline::version()).find('.') != std::string::npos);
  return tautline::exitCode();
}
