// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LargeArray.h
 * @brief Arrays that are fully written before they are read.
 * Internal: not installed.
 */
#ifndef tautline_LargeArray_h
#define tautline_LargeArray_h

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace tautline
{
/**
 * @class tautline::LargeArrayAllocator
 * @brief Memory that resize() does not clear, so that the threads that fill an array touch it
 * first. It uses large pages where the system supports them, which reduces page faults and look-ups
 * for random writes.
 */
template <class T>
class LargeArrayAllocator : public std::allocator<T>
{
public:
  template <class U>
  struct rebind
  {
    using other = LargeArrayAllocator<U>;
  };

  LargeArrayAllocator() = default;
  template <class U>
  LargeArrayAllocator(const LargeArrayAllocator<U>&) noexcept
  {
  }

  T* allocate(std::size_t count)
  {
    if (!isLarge(count))
    {
      return std::allocator<T>::allocate(count);
    }
    void* memory = ::operator new(count * sizeof(T), std::align_val_t(pageSize));
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    // a hint: its failure does not change results
    madvise(memory, count * sizeof(T), MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }

  void deallocate(T* memory, std::size_t count)
  {
    isLarge(count) ? ::operator delete(memory, std::align_val_t(pageSize))
                   : std::allocator<T>::deallocate(memory, count);
  }

  /// Does not initialize the elements that resize() adds.
  template <class U>
  void construct(U* place) noexcept(std::is_nothrow_default_constructible_v<U>)
  {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments)
  {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

private:
  static constexpr std::size_t pageSize = std::size_t(1) << 21; ///< of a large page
  static constexpr std::size_t fewPages = 2;

  /// std::allocator rejects counts that are too large.
  static bool isLarge(std::size_t count)
  {
    return count >= fewPages * pageSize / sizeof(T) &&
      count <= std::size_t(PTRDIFF_MAX) / sizeof(T);
  }
};

/// A vector whose elements are not initialized by resize().
template <class T>
using LargeArray = std::vector<T, LargeArrayAllocator<T>>;
}
#endif
