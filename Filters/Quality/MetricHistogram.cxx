// SPDX-License-Identifier: BSD-3-Clause
#include "MetricHistogram.h"

#include "tautline/Quality/Metrics.h"

#include "vtkDataArray.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <sstream>

namespace tautline
{
namespace
{

vtkDataArray* numbers(vtkTable* table, const std::string& column)
{
  return vtkDataArray::SafeDownCast(table->GetColumnByName(column.c_str()));
}

std::vector<HistogramBar> barsOf(vtkTable* table, const std::string& metric)
{
  vtkDataArray* from = numbers(table, metric + " from");
  vtkDataArray* to = numbers(table, metric + " to");
  vtkDataArray* count = numbers(table, metric + " count");
  std::vector<HistogramBar> bars;
  if (!from || !to || !count)
  {
    return bars;
  }
  const vtkIdType last = table->GetNumberOfRows() - 1;
  for (vtkIdType row = 0; row <= last; ++row)
  {
    const auto kind = row == 0 ? HistogramBar::Below
      : row == last            ? HistogramBar::Above
      : row == last - 1        ? HistogramBar::LastBin
                               : HistogramBar::Bin;
    bars.push_back({ kind, from->GetComponent(row, 0), to->GetComponent(row, 0),
      static_cast<vtkIdType>(count->GetComponent(row, 0)) });
  }
  return bars;
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::vector<MetricHistogram> histogramsOf(vtkTable* statistics, vtkTable* histogram)
{
  std::vector<MetricHistogram> result;
  auto* names =
    statistics ? vtkStringArray::SafeDownCast(statistics->GetColumnByName("Metric")) : nullptr;
  vtkDataArray* inverted = names ? numbers(statistics, "Inverted") : nullptr;
  vtkDataArray* degenerate = names ? numbers(statistics, "Degenerate") : nullptr;
  for (vtkIdType row = 0; inverted && degenerate && histogram && row < names->GetNumberOfValues();
       ++row)
  {
    MetricHistogram metric;
    metric.metric = names->GetValue(row);
    const MetricInfo* info = findMetric(metric.metric);
    std::vector<HistogramBar> bars = barsOf(histogram, metric.metric);
    if (!info || bars.empty())
    {
      continue;
    }
    metric.label = info->label;
    // An empty bar beyond the good end carries no information.
    const bool badIsRight = info->direction == Direction::SmallerIsBetter;
    const auto good = badIsRight ? bars.begin() : bars.end() - 1;
    if (good->count == 0)
    {
      bars.erase(good);
    }
    std::vector<HistogramBar> invalid;
    const auto number = [row](vtkDataArray* column)
    { return static_cast<vtkIdType>(column->GetComponent(row, 0)); };
    if (number(degenerate) > 0)
    {
      invalid.push_back({ HistogramBar::Degenerate, 0, 0, number(degenerate) });
    }
    // Metrics that rank inverted elements include them in their bins.
    invalid.push_back({ HistogramBar::Inverted, 0, 0, number(inverted) });
    if (badIsRight)
    {
      bars.insert(bars.end(), invalid.begin(), invalid.end());
    }
    else
    {
      bars.insert(bars.begin(), invalid.rbegin(), invalid.rend());
    }
    metric.bars = bars;
    result.push_back(metric);
  }
  return result;
}

//------------------------------------------------------------------------------
std::string describeBars(const MetricHistogram& histogram, int first, int last)
{
  std::ostringstream text;
  text.precision(4);
  std::string invalid;
  const HistogramBar* from = nullptr;
  const HistogramBar* to = nullptr;
  for (int i = first; i <= last; ++i)
  {
    const HistogramBar& bar = histogram.bars[i];
    if (hasValues(bar))
    {
      from = from ? from : &bar;
      to = &bar;
      continue;
    }
    invalid += (invalid.empty() ? "" : " or ");
    invalid += bar.kind == HistogramBar::Inverted ? "inverted" : "degenerate";
  }
  if (from && from->kind == HistogramBar::Below)
  {
    text << "below " << to->high;
  }
  else if (from && to->kind == HistogramBar::Above)
  {
    text << "above " << from->low;
  }
  else if (from)
  {
    text << from->low << " to " << to->high;
  }
  text << (from && !invalid.empty() ? " or " : "") << invalid;
  return text.str();
}

} // namespace tautline
