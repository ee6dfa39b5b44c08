// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HistogramBars.h
 * @brief The elements in the bars of the quality histogram.
 */

#ifndef tautline_HistogramBars_h
#define tautline_HistogramBars_h

#include "ElementSelection.h"
#include "MetricHistogram.h"

namespace tautline
{

/**
 * @brief The condition of the cells of the bars first to last.
 *
 * Bars of values are of valid elements, and of inverted ones too for metrics that order these.
 */
CellCondition conditionOf(const MetricHistogram& histogram, int first, int last);

} // namespace tautline

#endif
