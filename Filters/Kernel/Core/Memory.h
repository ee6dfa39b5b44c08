// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Memory.h
 * @brief The memory that is available, and the check before large allocations.
 * Internal: not installed.
 *
 * Linux overcommits memory and kills processes that use it, and libraries often crash when an
 * allocation fails. Therefore, large allocations that grow with a product of the inputs (a dense
 * matrix, all pairs of elements, cells of a given size) are estimated and checked in advance.
 */
#ifndef tautline_Memory_h
#define tautline_Memory_h

#include "Types.h"

#include "tautline/KernelExport.h"

#include <exception>
#include <string>

namespace tautline
{
/**
 * @brief The number of bytes that this process can still allocate: the minimum of the free memory
 * of the machine, the remainder in the control groups of the process, and the remainder below its
 * limits on address space and data (`ulimit -v`, `ulimit -d`).
 */
TAUTLINE_KERNEL_EXPORT double availableMemory();

/// The error that requireMemory() throws.
class TAUTLINE_KERNEL_EXPORT MemoryError : public Error
{
public:
  using Error::Error;
};

/**
 * @brief Throws MemoryError if this many bytes are not available.
 *
 * The message is "what takes about 3.2 GiB of memory and 1.5 GiB are available: remedy".
 * @param bytes an estimate; NaN and infinity are too much
 * @param what the subject of a sentence, in the singular: "the matrix"
 * @param remedy what the user can do: "use a smaller horizon"
 * @param limit bytes that a user allows, or 0 for all that is available
 */
TAUTLINE_KERNEL_EXPORT void requireMemory(
  double bytes, const std::string& what, const std::string& remedy, double limit = 0.0);

/**
 * @class tautline::AllowedMemory
 * @brief While this object exists, requireMemory() allows its thread this many bytes, regardless of
 * the available memory: for tests of low-memory behavior.
 */
class TAUTLINE_KERNEL_EXPORT AllowedMemory
{
public:
  /// @param bytes above 0
  explicit AllowedMemory(double bytes);
  ~AllowedMemory();
  AllowedMemory(const AllowedMemory&) = delete;
  AllowedMemory& operator=(const AllowedMemory&) = delete;

private:
  double Before; ///< 0: all that is available
};

/// Makes allocations of this process fail after it has allocated this many more bytes.
TAUTLINE_KERNEL_EXPORT void limitMemory(double more);

/// The message of an error for the user: "Not enough memory: remedy." for std::bad_alloc.
TAUTLINE_KERNEL_EXPORT std::string errorText(
  const std::exception& error, const std::string& remedy);

/// "512 MiB", "3.2 GiB": three digits.
TAUTLINE_KERNEL_EXPORT std::string memoryText(double bytes);
}
#endif
