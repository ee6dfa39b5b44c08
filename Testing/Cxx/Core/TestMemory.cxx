// SPDX-License-Identifier: BSD-3-Clause
// The memory that is available, under the limits of a process, and the errors where it does not
// suffice.
#include "Registry.h"
#include "Sanitized.h"
#include "tautline/Core/Memory.h"

#include <functional>
#include <limits>
#include <new>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace tautline;

namespace
{
constexpr double Mebibyte = 1048576;

/// In a child process, whose limits may be changed: the exit code.
int inChild(const std::function<bool()>& succeeds)
{
  const pid_t child = fork();
  if (child == 0)
  {
    bool success = false;
    try
    {
      success = succeeds();
    }
    catch (...)
    {
    }
    _exit(success ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

/// Sets a limit to what is in use plus some bytes.
void leave(int resource, double bytes)
{
  const double before = availableMemory();
  rlimit limit{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  // With a limit of a terabyte, the available memory shows the used memory.
  constexpr double large = 1024 * 1024 * Mebibyte;
  limit.rlim_cur = static_cast<rlim_t>(large);
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
  double low = 0, high = large;
  while (high - low > Mebibyte / 16)
  {
    const double middle = 0.5 * (low + high);
    limit.rlim_cur = static_cast<rlim_t>(middle);
    setrlimit(static_cast<__rlimit_resource>(resource), &limit);
    (availableMemory() < std::min(before, bytes) ? low : high) = middle;
  }
}

bool allocates(double bytes)
{
  void* volatile place = std::malloc(static_cast<std::size_t>(bytes)); // not optimized away
  const bool success = place != nullptr;
  std::free(place);
  return success;
}

void testLimits()
{
  const double available = availableMemory();
  TAUTLINE_CHECK(available > Mebibyte && std::isfinite(available));
  for (const int resource : { RLIMIT_AS, RLIMIT_DATA })
  {
    const int status = inChild(
      [resource]
      {
        constexpr double left = 200 * Mebibyte;
        leave(resource, left);
        const double found = availableMemory();
        if (!(std::abs(found - left) < Mebibyte))
        {
          return false;
        }
        requireMemory(0.9 * left, "the test", "stop");
        // As much as is available can be allocated, and no more.
        return allocates(0.9 * left) && !allocates(1.1 * left);
      });
    TAUTLINE_CHECK_EQUAL(status, 0);
  }
  TAUTLINE_CHECK_EQUAL(inChild(
                         []
                         {
                           constexpr double more = 100 * Mebibyte;
                           limitMemory(more);
                           return std::abs(availableMemory() - more) < Mebibyte;
                         }),
    0);
}

TAUTLINE_PART(testRequire)
{
  const double little = 1000, endless = std::numeric_limits<double>::infinity();
  requireMemory(little, "the test", "stop");
  requireMemory(little, "the test", "stop", 2 * little);
  TAUTLINE_CHECK_THROWS(
    requireMemory(1e18, "the test", "stop here"), wording("the-test-takes-about-9-09e-05"));
  TAUTLINE_CHECK_THROWS(
    requireMemory(1e18, "the test", "stop here"), wording("available-stop-here"));
  TAUTLINE_CHECK_THROWS(requireMemory(3 * Mebibyte, "the test", "stop", 2 * Mebibyte),
    wording("the-test-takes-about-3-mib-of"));
  TAUTLINE_CHECK_THROWS(requireMemory(endless, "the test", "stop"), "inf");
  TAUTLINE_CHECK_THROWS(requireMemory(std::nan(""), "the test", "stop"), "nan");
}

TAUTLINE_PART(testTexts)
{
  TAUTLINE_CHECK_EQUAL(memoryText(512 * Mebibyte), std::string("512 MiB"));
  TAUTLINE_CHECK_EQUAL(memoryText(999 * Mebibyte), std::string("999 MiB"));
  TAUTLINE_CHECK_EQUAL(memoryText(1536 * Mebibyte), std::string("1.5 GiB"));
  TAUTLINE_CHECK_EQUAL(memoryText(2048 * 1024 * Mebibyte), std::string("2 TiB"));
  TAUTLINE_CHECK_EQUAL(
    errorText(std::bad_alloc(), "do less"), std::string("Not enough memory: do less."));
  TAUTLINE_CHECK_EQUAL(errorText(Error("an error"), "do less"), std::string("an error"));
}
}

TAUTLINE_TEST(TestMemory)
{
  if (!TAUTLINE_ADDRESS_SANITIZER)
  {
    TAUTLINE_RUN(testLimits());
  }
}
