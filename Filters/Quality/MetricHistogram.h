// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricHistogram.h
 * @brief The bars of a quality histogram: bins over the acceptable range, values beyond it, and
 * invalid elements.
 */

#ifndef tautline_MetricHistogram_h
#define tautline_MetricHistogram_h

#include "TautlineQualityModule.h" // for export macro

#include "vtkType.h"

#include <string>
#include <vector>

class vtkTable;

namespace tautline
{

/// A bar of the histogram of a metric.
struct HistogramBar
{
  enum Kind
  {
    Bin,       ///< values in [low, high)
    LastBin,   ///< values in [low, high]
    Below,     ///< values below the acceptable range
    Above,     ///< values above the acceptable range
    Inverted,  ///< the inverted elements
    Degenerate ///< the degenerate elements
  };
  Kind kind = Bin;
  double low = 0, high = 0; ///< unused for Inverted and Degenerate
  vtkIdType count = 0;
};

/// The histogram of one metric.
struct MetricHistogram
{
  std::string metric; ///< the name of the cell array, "imr"
  std::string label;  ///< "Inverse mean ratio"
  /// From left to right. The bad side ends with the bars of degenerate and inverted elements.
  std::vector<HistogramBar> bars;
};

/// Whether the bar stands for an interval of values.
inline bool hasValues(const HistogramBar& bar)
{
  return bar.kind != HistogramBar::Inverted && bar.kind != HistogramBar::Degenerate;
}

/**
 * @brief The histograms from the tables Statistics and Histogram of Element Quality.
 * @return one for each metric; empty for other tables
 */
TAUTLINEQUALITY_EXPORT std::vector<MetricHistogram> histogramsOf(
  vtkTable* statistics, vtkTable* histogram);

/// Describes the bars from first to last: "1.5 to 2", "above 3 or inverted".
TAUTLINEQUALITY_EXPORT std::string describeBars(
  const MetricHistogram& histogram, int first, int last);

} // namespace tautline

#endif
