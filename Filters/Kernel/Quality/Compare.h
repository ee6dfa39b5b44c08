// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Compare.h
 * @brief What changed between two meshes of equal connectivity.
 */
#ifndef tautline_Compare_h
#define tautline_Compare_h

#include "Statistics.h"

#include <limits>

namespace tautline
{
/// Names the first difference of two meshes in points, cells or connectivity; empty if none.
TAUTLINE_KERNEL_EXPORT std::string connectivityDifference(const Mesh& before, const Mesh& after);

/// Smallest, largest and mean value; can be added to, block after block.
struct ValueSummary
{
  Index count = 0;
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  double sum = 0;
  double mean() const { return this->count > 0 ? this->sum / static_cast<double>(this->count) : 0; }
};

/// What became of one metric; can be added to, block after block.
struct MetricChange
{
  Index better = 0, worse = 0, equal = 0;
  ValueSummary before, after; ///< of measuredValues()
};

/**
 * @brief Finds for each cell whether its metric became better (1), worse (-1) or neither (0), and
 * adds up the counts.
 *
 * Validity comes first: a cell that becomes valid is better, one that becomes degenerate or
 * inverted is worse. Of two valid cells, and of two inverted ones where the metric orders these
 * (InvertedValue::Larger), the values decide, by the direction of the metric. They are equal if
 * they differ by no more than `tolerance` times the larger magnitude; for metrics without a unit
 * whose ideal value is 0, times 1 if that is more. A neutral metric, such as the size, makes no
 * valid cell better or worse. Cells the metric is not defined on, and those to skip, get 0 and are
 * not counted.
 * @param dimension 2 or 3
 */
TAUTLINE_KERNEL_EXPORT void compareMetric(const MetricInfo& info, int dimension,
  const CellValues& before, const CellValues& after, double tolerance, signed char* change,
  MetricChange& total);
}
#endif
