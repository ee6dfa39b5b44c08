// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Loops.h
 * @brief Sums, largest values and vectors of what a function gives for each number or element.
 */
#ifndef tautline_Loops_h
#define tautline_Loops_h

#include "tautline/Core/Types.h"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace tautline
{
/** Calls f with each number below a count, or with each element of a range. */
template <class Range, class Function>
void forEach(const Range& range, const Function& f)
{
  if constexpr (std::is_arithmetic<Range>::value)
  {
    for (Range i = 0; i < range; ++i)
    {
      f(i);
    }
  }
  else
  {
    for (const auto& element : range)
    {
      f(element);
    }
  }
}

/** f of each, as with forEach(). */
template <class T, class Range, class Function>
std::vector<T> collect(const Range& range, const Function& f)
{
  std::vector<T> result;
  forEach(range, [&](const auto& x) { result.push_back(f(x)); });
  return result;
}

/** A start plus f of each. */
template <class T, class Range, class Function>
T sumOf(T start, const Range& range, const Function& f)
{
  forEach(range, [&](const auto& x) { start += f(x); });
  return start;
}

/** The largest of a start and f of each; a NaN does not count. */
template <class T, class Range, class Function>
T largestOf(T start, const Range& range, const Function& f)
{
  forEach(range, [&](const auto& x) { start = std::max<T>(start, f(x)); });
  return start;
}

template <class T, class Range, class Function>
T smallestOf(T start, const Range& range, const Function& f)
{
  forEach(range, [&](const auto& x) { start = std::min<T>(start, f(x)); });
  return start;
}
}

#endif
