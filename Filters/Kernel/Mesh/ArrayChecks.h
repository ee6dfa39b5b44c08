// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ArrayChecks.h
 * @brief Searches the raw arrays of a mesh for invalid values.
 *
 * Linear and threaded: each array is read once. The result is the first position, for any number of
 * threads, or -1. Ids are not dereferenced, so that arrays with any content are allowed. `Id` is
 * std::int32_t or std::int64_t, `Real` is float or double.
 * Internal: not installed.
 */
#ifndef tautline_ArrayChecks_h
#define tautline_ArrayChecks_h

#include "tautline/Core/Types.h"

namespace tautline
{
/// The first of `count` ids that is negative or not below `limit`.
template <class Id>
TAUTLINE_KERNEL_EXPORT Index findIdOutside(const Id* ids, Index count, Index limit, int threads);

/// The first of `count` values that is NaN or infinite.
template <class Real>
TAUTLINE_KERNEL_EXPORT Index findNonFinite(const Real* values, Index count, int threads);

/// The number of points that a cell of each type lists.
struct CellSizes
{
  static constexpr int Unknown = 0; ///< the type does not exist
  /// By type: n > 0 is exactly n points, n < 0 is at least -n - 1 points.
  std::array<int, 256> points{};

  static constexpr int atLeast(int n) { return -n - 1; }
  bool allows(unsigned char type, Index size) const
  {
    const Index n = this->points[type];
    return n > 0 ? size == n : n < 0 && size >= -n - 1;
  }
};

/**
 * @brief The first cell whose size, offsets[i + 1] - offsets[i], its type does not allow; negative
 * sizes are never allowed.
 * @param offsets cells + 1 values
 * @param types one value per cell
 */
template <class Id>
TAUTLINE_KERNEL_EXPORT Index findWrongSize(
  const Id* offsets, const unsigned char* types, Index cells, const CellSizes& sizes, int threads);

/// The first cell with fewer than `least` points, at least 0.
template <class Id>
TAUTLINE_KERNEL_EXPORT Index findTooShort(const Id* offsets, Index cells, Index least, int threads);
}
#endif
