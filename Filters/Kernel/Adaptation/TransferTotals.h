// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TransferTotals.h
 * @brief Field totals, and adjustment of values to a given total.
 * Internal: not installed.
 */
#ifndef tautline_TransferTotals_h
#define tautline_TransferTotals_h

#include "tautline/Core/Types.h"

#include <vector>

namespace tautline
{
/// The sum of weights[i] * values[i], and of its absolute values; compensated.
struct WeightedTotal
{
  double total = 0.0, magnitude = 0.0;
};
WeightedTotal totalOf(const std::vector<double>& weights, const std::vector<double>& values);

/// Values of one component on the target and their bounds.
struct BoundedValues
{
  std::vector<double> values, low, high;
  /// The largest distance of a value from its bounds.
  double excess(const std::vector<double>& weights) const;
};

/**
 * @brief Changes values to reach the target total: first in proportion to the room within the
 * bounds and, if this does not suffice, all by the same amount beyond the bounds.
 * @param weights the share of the area or volume of each value; values without a share stay
 *   unchanged
 * @param beside nonzero for the values that change; if there are none, all do
 * @param magnitude of the source; differences within its rounding do not exceed the bounds
 */
void takeTotal(const std::vector<double>& weights, const std::vector<unsigned char>& beside,
  double wanted, double magnitude, BoundedValues& values);
}
#endif
