// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Compare.h
 * @brief Compares two meshes of equal connectivity.
 */
#ifndef tautline_Compare_h
#define tautline_Compare_h

#include "Statistics.h"

#include <limits>

namespace tautline
{
/// Describes the first difference of two meshes in points, cells or connectivity; empty if none.
TAUTLINE_KERNEL_EXPORT std::string connectivityDifference(const Mesh& before, const Mesh& after);

/// Smallest, largest and mean value; can be accumulated block after block.
struct ValueSummary
{
  Index count = 0;
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  double sum = 0;
  double mean() const { return this->count > 0 ? this->sum / static_cast<double>(this->count) : 0; }
};

/// The change of one metric; can be accumulated block after block.
struct MetricChange
{
  Index better = 0, worse = 0, equal = 0;
  ValueSummary before, after; ///< of measuredValues()
};

/**
 * @brief Finds for each cell whether its metric became better (1), worse (-1) or neither (0), and
 * adds up the counts.
 *
 * Validity comes first: a cell that becomes valid is better, a cell that becomes degenerate or
 * inverted is worse. For two valid cells, and for two inverted ones if the metric orders them
 * (InvertedValue::Larger), the values decide according to the direction of the metric. Values are
 * equal if they differ by at most `tolerance` times the larger magnitude or, for unitless metrics
 * with the ideal value 0, by at most `tolerance`, if that is more. A neutral metric, such as the
 * size, never makes a valid cell better or worse. Cells on which the metric is undefined and
 * skipped cells get 0 and are not counted.
 * @param dimension 2 or 3
 */
TAUTLINE_KERNEL_EXPORT void compareMetric(const MetricInfo& info, int dimension,
  const CellValues& before, const CellValues& after, double tolerance, signed char* change,
  MetricChange& total);
}
#endif
