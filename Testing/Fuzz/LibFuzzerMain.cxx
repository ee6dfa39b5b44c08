// SPDX-License-Identifier: BSD-3-Clause
// The driver of libFuzzer: TAUTLINE_FUZZ_TARGET names the target, or is "list" to print their
// names; the arguments are libFuzzer's.

#include "FuzzTargets.h"

#include "vtkObject.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace
{
const tautline::FuzzTarget* target = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  const char* name = std::getenv("TAUTLINE_FUZZ_TARGET");
  if (name && std::strcmp(name, "list") == 0)
  {
    for (const tautline::FuzzTarget& known : tautline::fuzzTargets())
    {
      std::puts(known.name);
    }
    std::exit(EXIT_SUCCESS);
  }
  target = tautline::findFuzzTarget(name ? name : "");
  if (!target)
  {
    std::fprintf(stderr, "TAUTLINE_FUZZ_TARGET names no target: %s\n", name ? name : "(not set)");
    std::exit(EXIT_FAILURE);
  }
  vtkObject::GlobalWarningDisplayOff();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  target->run({ reinterpret_cast<const char*>(data), size }); // an exception ends the program
  return 0;
}
