// SPDX-License-Identifier: BSD-3-Clause
#include "HistogramBars.h"

#include "tautline/Quality/Metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{

constexpr const char* ValidityArray = "Validity";
constexpr double ValidValue = 1, DegenerateValue = 0, InvertedValueOfArray = -1;
constexpr double Largest = std::numeric_limits<double>::max();

bool ordersInverted(const MetricHistogram& histogram)
{
  const MetricInfo* info = findMetric(histogram.metric);
  return info && info->inverted == InvertedValue::Larger;
}

} // anonymous namespace

//------------------------------------------------------------------------------
CellCondition conditionOf(const MetricHistogram& histogram, int first, int last)
{
  CellCondition condition;
  double low = Largest, high = -Largest;
  for (int i = first; i <= last; ++i)
  {
    const HistogramBar& bar = histogram.bars[i];
    if (!hasValues(bar))
    {
      const double value =
        bar.kind == HistogramBar::Inverted ? InvertedValueOfArray : DegenerateValue;
      condition.push_back({ { ValidityArray, value, value } });
      continue;
    }
    // Bins are half-open, intervals of a selection are closed.
    const bool open = bar.kind == HistogramBar::Bin || bar.kind == HistogramBar::Below;
    low = std::min(low,
      bar.kind == HistogramBar::Below     ? -Largest
        : bar.kind == HistogramBar::Above ? std::nextafter(bar.low, Largest)
                                          : bar.low);
    high = std::max(high,
      bar.kind == HistogramBar::Above ? Largest
        : open                        ? std::nextafter(bar.high, -Largest)
                                      : bar.high);
  }
  if (low <= high)
  {
    const double least = ordersInverted(histogram) ? InvertedValueOfArray : ValidValue;
    condition.push_back({ { histogram.metric, low, high }, { ValidityArray, least, ValidValue } });
  }
  return condition;
}

} // namespace tautline
