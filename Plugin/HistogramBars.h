/**
 * @file HistogramBars.h
 * @brief The bars of the quality histogram: what they count, and the condition of each.
 */

#ifndef tautline_HistogramBars_h
#define tautline_HistogramBars_h

#include "ElementSelection.h"

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
  /// From the left to the right. The bad side ends with the bars of degenerate and inverted
  /// elements.
  std::vector<HistogramBar> bars;
};

/**
 * @brief The histograms of the tables Statistics and Histogram of Element Quality.
 * @return one for each metric; none if the tables are not such ones
 */
std::vector<MetricHistogram> histogramsOf(vtkTable* statistics, vtkTable* histogram);

/**
 * @brief The condition of the cells of the bars first to last.
 *
 * Bars of values are of valid elements, and of inverted ones too for metrics that order these.
 */
CellCondition conditionOf(const MetricHistogram& histogram, int first, int last);

/// "1.5 to 2", "above 3 or inverted": what the bars first to last are.
std::string describeBars(const MetricHistogram& histogram, int first, int last);

} // namespace tautline

#endif
