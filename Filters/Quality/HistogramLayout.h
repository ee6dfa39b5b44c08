// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HistogramLayout.h
 * @brief How the histogram of a metric is drawn: places and heights of the bars, ticks of both
 * axes, limits of criteria, colors.
 *
 * The panel of Element Quality and the HTML report draw the same layout. Lengths are fractions of
 * the plot: 0 is its left or lower end, 1 its right or upper end.
 */

#ifndef tautline_HistogramLayout_h
#define tautline_HistogramLayout_h

#include "TautlineQualityModule.h" // for export macro

#include "MetricHistogram.h"

#include <array>
#include <string>
#include <vector>

namespace tautline
{

enum class CountScale
{
  Linear,
  Logarithmic ///< a bar of one element has a height, too
};

/// A limit of the criteria for a metric.
struct HistogramLimit
{
  double value = 0;
  bool fail = false;   ///< else the limit of a warning
  std::string types{}; ///< "": all cell types; else "triangle, quadrilateral"
};

/**
 * @brief The limits of a metric.
 * @param criteria as vtkElementQuality::SetCriteria() takes them; what cannot be read has none
 * @param vtkCellTypes only limits for these; empty: for all that the metric is defined on
 */
TAUTLINEQUALITY_EXPORT std::vector<HistogramLimit> histogramLimits(
  const std::string& criteria, const std::string& metric, const std::vector<int>& vtkCellTypes);

/// What is to be drawn.
struct HistogramView
{
  CountScale scale = CountScale::Logarithmic;
  vtkIdType most = 0; ///< the count that the axis reaches at least
  int valueTicks = 6; ///< at most, apart from the ends of the acceptable range
  int countTicks = 4; ///< at most, apart from 0
};

struct HistogramTick
{
  double position = 0;
  std::string label{};
};

/// A limit in the plot.
struct HistogramMark
{
  double position = 0;
  bool fail = false;
  std::string label{}; ///< "warn 3", "fail 10 (triangle)"
};

struct HistogramLayout
{
  std::vector<double> left, right; ///< of the bars
  std::vector<double> heights;     ///< of the bars
  /// Red, green and blue of the bars, 0 to 1: as their elements in pictures, see ColorMaps.h.
  std::vector<std::array<double, 3>> colors;
  std::vector<HistogramTick> values, counts;
  std::vector<HistogramMark> marks; ///< from the left to the right
  std::string title;                ///< of the axis of values: label and unit
  std::string countTitle;           ///< of the axis of counts
};

TAUTLINEQUALITY_EXPORT HistogramLayout layoutOf(const MetricHistogram& histogram,
  const std::vector<HistogramLimit>& limits, const HistogramView& view);

/// Sentences on the colors, with the acceptable range. @param other drawn beside it; may be null
TAUTLINEQUALITY_EXPORT std::string describeColors(
  const MetricHistogram& histogram, const MetricHistogram* other = nullptr);

} // namespace tautline

#endif
