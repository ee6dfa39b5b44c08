// SPDX-License-Identifier: BSD-3-Clause
#include "ArrayChecks.h"

#include "tautline/Core/Parallel.h"

#include <atomic>
#include <cstring>
#include <limits>
#include <type_traits>

namespace tautline
{
namespace
{
/// The first i below count with bad(i). The test of a chunk is branch-free and vectorized; only a
/// failing chunk is searched for the position.
template <class Bad>
Index findFirst(Index count, int threads, const Bad& bad)
{
  std::atomic<Index> first{ count };
  forEachChunk(count, threads,
    [&](Index, Index begin, Index end)
    {
      bool any = false;
      for (Index i = begin; i < end; ++i)
      {
        any |= bad(i);
      }
      if (!any)
      {
        return;
      }
      Index found = begin;
      while (!bad(found))
      {
        ++found;
      }
      // On failure, the exchange reloads the smallest position: the loop ends if another chunk was
      // ahead.
      Index smallest = first;
      while (found < smallest && !first.compare_exchange_weak(smallest, found))
      {
      }
    });
  return first < count ? first.load() : -1;
}

/// The number of points of a cell, -1 if the offsets decrease; the difference of arbitrary offsets
/// could overflow.
template <class Id>
Index sizeOf(const Id* offsets, Index cell)
{
  const Index begin = offsets[cell], end = offsets[cell + 1];
  return begin < 0 || end < begin ? -1 : end - begin;
}
}

//------------------------------------------------------------------------------
template <class Id>
Index findIdOutside(const Id* ids, Index count, Index limit, int threads)
{
  using Unsigned = std::make_unsigned_t<Id>;
  // A negative id is a large unsigned one.
  const auto bound = static_cast<Unsigned>(std::min<Index>(limit, std::numeric_limits<Id>::max()));
  return findFirst(count, threads, [=](Index i) { return static_cast<Unsigned>(ids[i]) >= bound; });
}

//------------------------------------------------------------------------------
template <class Real>
Index findNonFinite(const Real* values, Index count, int threads)
{
  using Bits =
    std::conditional_t<sizeof(Real) == sizeof(std::uint64_t), std::uint64_t, std::uint32_t>;
  // NaN and infinity are the values whose exponent has all bits set.
  const Real infinity = std::numeric_limits<Real>::infinity();
  Bits exponent;
  std::memcpy(&exponent, &infinity, sizeof(Real));
  return findFirst(count, threads,
    [=](Index i)
    {
      Bits bits;
      std::memcpy(&bits, values + i, sizeof(Real));
      return (bits & exponent) == exponent;
    });
}

//------------------------------------------------------------------------------
template <class Id>
Index findWrongSize(
  const Id* offsets, const unsigned char* types, Index cells, const CellSizes& sizes, int threads)
{
  return findFirst(
    cells, threads, [&](Index i) { return !sizes.allows(types[i], sizeOf(offsets, i)); });
}

//------------------------------------------------------------------------------
template <class Id>
Index findTooShort(const Id* offsets, Index cells, Index least, int threads)
{
  return findFirst(cells, threads, [=](Index i) { return sizeOf(offsets, i) < least; });
}

template TAUTLINE_KERNEL_EXPORT Index findIdOutside(const std::int32_t*, Index, Index, int);
template TAUTLINE_KERNEL_EXPORT Index findIdOutside(const std::int64_t*, Index, Index, int);
template TAUTLINE_KERNEL_EXPORT Index findNonFinite(const float*, Index, int);
template TAUTLINE_KERNEL_EXPORT Index findNonFinite(const double*, Index, int);
template TAUTLINE_KERNEL_EXPORT Index findWrongSize(
  const std::int32_t*, const unsigned char*, Index, const CellSizes&, int);
template TAUTLINE_KERNEL_EXPORT Index findWrongSize(
  const std::int64_t*, const unsigned char*, Index, const CellSizes&, int);
template TAUTLINE_KERNEL_EXPORT Index findTooShort(const std::int32_t*, Index, Index, int);
template TAUTLINE_KERNEL_EXPORT Index findTooShort(const std::int64_t*, Index, Index, int);
}
