// SPDX-License-Identifier: BSD-3-Clause
#include "Registry.h"
#include "tautline/Core/Version.h"

TAUTLINE_TEST(TestVersion)
{
  TAUTLINE_CHECK(tautline::contains(tautline::version(), "."));
}
