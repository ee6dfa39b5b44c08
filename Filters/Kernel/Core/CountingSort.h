// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CountingSort.h
 * @brief A stable, multithreaded counting sort.
 * Internal: not installed.
 */
#ifndef tautline_CountingSort_h
#define tautline_CountingSort_h

#include "Interruption.h"
#include "Parallel.h"

namespace tautline
{
/// The number of parts of a loop over this many items if each part needs its own memory: one per
/// thread, unless there are too few items per thread.
inline int numberOfParts(Index items, int threads)
{
  constexpr Index enough = 50000;
  constexpr Index most = 8;
  return static_cast<int>(
    std::clamp<Index>(items / enough, 1, std::min<Index>(resolveThreads(threads), most)));
}

/**
 * @class tautline::CountingSort
 * @brief Sorted positions for the uses of keys by items: smaller keys first, then the order of the
 * items, then the order within an item. The positions do not depend on the number of threads.
 */
class CountingSort
{
public:
  /// @param usesOf usesOf(item, use) calls use(key) for each use of a key in [0, keys)
  template <class UsesOf>
  CountingSort(Index items, std::int32_t keys, int threads, const UsesOf& usesOf)
    : Items(items)
    , Threads(threads)
    , Next(numberOfParts(items, threads))
    , Starts(static_cast<std::size_t>(keys) + 1)
  {
    this->forEachItem([&](std::vector<std::int32_t>& counts) { counts.assign(keys, 0); },
      [&usesOf](Index item, Index, std::vector<std::int32_t>& counts)
      { usesOf(item, [&counts](std::int32_t key) { ++counts[key]; }); });
    std::int32_t place = 0;
    for (std::int32_t key = 0; key < keys; ++key)
    {
      this->Starts[key] = place;
      for (std::vector<std::int32_t>& next : this->Next)
      {
        const std::int32_t count = next[key];
        next[key] = place;
        place += count;
      }
    }
    this->Starts[keys] = place;
  }

  /// Where the uses of each key begin, and the end.
  std::vector<std::int32_t>& starts() { return this->Starts; }

  /// Calls visit(item, placeOf) for each item; placeOf(key) is the place of its next use of a key,
  /// to be called in the order of usesOf(). Only once.
  template <class Visit>
  void place(const Visit& visit)
  {
    this->place(visit, [](Index, const auto&) {});
  }

  /// The same, and also calls fetch(item, placeOf) ahead of time for each item so that it can
  /// prefetch memory; placeOf(key) is then near the final position and does not advance.
  template <class Visit, class Fetch>
  void place(const Visit& visit, const Fetch& fetch)
  {
    constexpr Index ahead = 32; // items processed during one memory fetch
    this->forEachItem([](std::vector<std::int32_t>&) {},
      [&](Index item, Index end, std::vector<std::int32_t>& next)
      {
        if (item + ahead < end)
        {
          fetch(item + ahead, [&next](std::int32_t key) { return next[key]; });
        }
        visit(item, [&next](std::int32_t key) { return next[key]++; });
      });
  }

private:
  template <class Begin, class Visit>
  void forEachItem(const Begin& begin, const Visit& visit)
  {
    const auto parts = static_cast<Index>(this->Next.size());
    parallelFor(parts, 1, this->Threads,
      [&](Index part)
      {
        std::vector<std::int32_t>& own = this->Next[part];
        begin(own);
        const Index end = this->Items * (part + 1) / parts;
        for (Index item = this->Items * part / parts; item < end; ++item)
        {
          pollInterruption(item);
          visit(item, end, own);
        }
      });
  }

  Index Items;
  int Threads;
  std::vector<std::vector<std::int32_t>> Next; ///< of each part: the next place of each key
  std::vector<std::int32_t> Starts;
};
}
#endif
