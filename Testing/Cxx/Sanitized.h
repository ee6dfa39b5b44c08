// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Sanitized.h
 * @brief Whether a test runs under AddressSanitizer, whose allocator does not live with limits of
 * the address space.
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

#endif
