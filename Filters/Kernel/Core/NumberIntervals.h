// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NumberIntervals.h
 * @brief A table to look up numbers in a sorted list.
 */
#ifndef tautline_NumberIntervals_h
#define tautline_NumberIntervals_h

#include "Types.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tautline
{
/**
 * @class tautline::NumberIntervals
 * @brief The position of a number in a sorted list, in constant time where the numbers are dense.
 *
 * The range is divided into about as many equal intervals as there are numbers; the table stores
 * the first position of each interval.
 */
class NumberIntervals
{
public:
  NumberIntervals() = default;

  /**
   * @param count length of the list, below 2^31; throws Error otherwise
   * @param numberOf numberOf(place) for positions in [0, count), increasing
   */
  template <class NumberOf>
  NumberIntervals(Index count, const NumberOf& numberOf)
  {
    if (count > std::numeric_limits<std::int32_t>::max())
    {
      throw Error("A process has " + std::to_string(count) +
        " points, more than it can number: use more processes.");
    }
    this->Low = count > 0 ? numberOf(0) : 0;
    const Index length = count > 0 ? numberOf(count - 1) - this->Low : 0;
    while ((length >> this->Bits) > count)
    {
      ++this->Bits;
    }
    this->Starts.reserve(static_cast<std::size_t>(length >> this->Bits) + 2);
    for (Index place = 0; place < count; ++place)
    {
      const auto interval = static_cast<std::size_t>((numberOf(place) - this->Low) >> this->Bits);
      this->Starts.resize(
        std::max(this->Starts.size(), interval + 1), static_cast<std::int32_t>(place));
    }
    this->Starts.push_back(static_cast<std::int32_t>(count));
  }

  /// The first position whose number is not less than the given one, like std::lower_bound.
  template <class NumberOf>
  Index find(Index number, const NumberOf& numberOf) const
  {
    if (this->Starts.empty() || number < this->Low)
    {
      return 0;
    }
    const auto interval = static_cast<std::size_t>((number - this->Low) >> this->Bits);
    if (interval + 1 >= this->Starts.size())
    {
      return this->Starts.back();
    }
    Index place = this->Starts[interval], end = this->Starts[interval + 1];
    while (place < end)
    {
      const Index middle = place + (end - place) / 2;
      if (numberOf(middle) < number)
      {
        place = middle + 1;
      }
      else
      {
        end = middle;
      }
    }
    return place;
  }

private:
  Index Low = 0;
  int Bits = 0;                     ///< an interval has 2^Bits numbers
  std::vector<std::int32_t> Starts; ///< positions; the last entry is the count
};
}
#endif
