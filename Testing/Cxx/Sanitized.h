// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Sanitized.h
 * @brief Whether a test runs under AddressSanitizer, whose allocator does not live with limits of
 * the address space, and the objects that LeakSanitizer must not miss.
 */
#ifndef tautline_Sanitized_h
#define tautline_Sanitized_h

#if defined(__SANITIZE_ADDRESS__) // gcc
#define TAUTLINE_ADDRESS_SANITIZER 1
#elif defined(__has_feature) // clang
#if __has_feature(address_sanitizer)
#define TAUTLINE_ADDRESS_SANITIZER 1
#endif
#endif
#ifndef TAUTLINE_ADDRESS_SANITIZER
#define TAUTLINE_ADDRESS_SANITIZER 0
#endif

#if TAUTLINE_ADDRESS_SANITIZER
#include <sanitizer/lsan_interface.h>
#endif

namespace tautline
{
/// Memory that is allocated while one exists may leak: its library was shut down by other code.
class LeakAllowed
{
public:
#if TAUTLINE_ADDRESS_SANITIZER
  LeakAllowed()
  {
    __lsan_disable();
  }
  ~LeakAllowed()
  {
    __lsan_enable();
  }
#else
  LeakAllowed() = default;
  ~LeakAllowed()
  {
  }
#endif
  LeakAllowed(const LeakAllowed&) = delete;
  LeakAllowed& operator=(const LeakAllowed&) = delete;
};
}

#endif
