// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TransferTotals.h
 * @brief Totals of fields, and values that are changed so that they have a given one.
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

/// Values of one component on the target, and where they may be.
struct BoundedValues
{
  std::vector<double> values, low, high;
  /// How far the values are outside of their bounds at most.
  double excess(const std::vector<double>& weights) const;
};

/**
 * @brief Changes values so that their total is the one that is wanted: first in proportion to what
 * the bounds leave, then, where that does not suffice, all by the same amount, beyond the bounds.
 * @param weights the share of the area or volume of each value; those without any keep theirs
 * @param beside nonzero for the values that change; if there are none, all do
 * @param magnitude of the source; differences that are rounding of it do not leave the bounds
 */
void takeTotal(const std::vector<double>& weights, const std::vector<unsigned char>& beside,
  double wanted, double magnitude, BoundedValues& values);
}
#endif
