// SPDX-License-Identifier: BSD-3-Clause
#include "HistogramLayout.h"

#include "ColorMaps.h"
#include "CriteriaGrader.h"
#include "tautline/Quality/Criteria.h"
#include "tautline/Quality/Metrics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

namespace tautline
{
namespace
{

constexpr double OutsideWidth = 2;  // of the bars outside the acceptable range, in bins
constexpr double OutsideGap = 0.75; // beside these bars, in bins
constexpr double LogBase = 0.5;     // the count at the lower end of a logarithmic axis
constexpr double HeadRoom = 1.3;    // of a logarithmic axis, above the fullest bar
constexpr double ClosestTicks = 0.07;
constexpr std::array<double, 3> NoMapColor = { 0.59, 0.63, 0.67 };
constexpr std::array<double, 3> OutsideColor = { 0.30, 0.0, 0.05 };

bool insideRange(const HistogramBar& bar)
{
  return bar.kind == HistogramBar::Bin || bar.kind == HistogramBar::LastBin;
}

std::string shortNumber(double value)
{
  constexpr int digits = 4;
  std::ostringstream text;
  text.precision(digits);
  text << value;
  return text.str();
}

/// "4000", "20k", "3M".
std::string shortCount(double count)
{
  constexpr double thousand = 1e3, million = 1e6, longest = 1e4;
  return count < longest ? shortNumber(count)
    : count < million    ? shortNumber(count / thousand) + "k"
                         : shortNumber(count / million) + "M";
}

/// 1, 2 or 5 times a power of ten: at most `most` steps.
double niceStep(double length, int most)
{
  const double rough = length / std::max(1, most);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : { 1.0, 2.0, 5.0 })
  {
    if (factor * power >= rough * (1 - 1e-9))
    {
      return factor * power;
    }
  }
  return 10 * power;
}

/// The multiples of a step between two values.
std::vector<double> multiples(double low, double high, double step)
{
  constexpr double rounding = 1e-9;
  std::vector<double> values;
  const auto first = static_cast<long long>(std::ceil(low / step - rounding));
  const auto last = static_cast<long long>(std::floor(high / step + rounding));
  for (long long i = first; i <= last; ++i)
  {
    values.push_back(static_cast<double>(i) * step);
  }
  return values;
}

void placeBars(const MetricHistogram& histogram, HistogramLayout& layout)
{
  double position = 0;
  for (std::size_t i = 0; i < histogram.bars.size(); ++i)
  {
    const bool inside = insideRange(histogram.bars[i]);
    position += i > 0 && !(inside && insideRange(histogram.bars[i - 1])) ? OutsideGap : 0.0;
    layout.left.push_back(position);
    position += inside ? 1 : OutsideWidth;
    layout.right.push_back(position);
  }
  for (std::size_t i = 0; i < layout.left.size(); ++i)
  {
    layout.left[i] /= position;
    layout.right[i] /= position;
  }
}

/// The bins over the acceptable range: their values and places.
struct BinRange
{
  double low = 0, high = 0, left = 0, right = 0;
  bool empty = true;

  double place(double value) const { return left + (value - low) / (high - low) * (right - left); }
};

BinRange binRange(const MetricHistogram& histogram, const HistogramLayout& layout)
{
  BinRange range;
  for (std::size_t i = 0; i < histogram.bars.size(); ++i)
  {
    const HistogramBar& bar = histogram.bars[i];
    if (insideRange(bar))
    {
      range.low = range.empty ? bar.low : range.low;
      range.left = range.empty ? layout.left[i] : range.left;
      range.high = bar.high;
      range.right = layout.right[i];
      range.empty = false;
    }
  }
  range.empty = range.empty || !(range.high > range.low) || !std::isfinite(range.high - range.low);
  return range;
}

void addValueTicks(const BinRange& range, int most, HistogramLayout& layout)
{
  const auto free = [&layout](double position)
  {
    return std::none_of(layout.values.begin(), layout.values.end(),
      [position](const HistogramTick& tick)
      { return std::abs(tick.position - position) < ClosestTicks; });
  };
  if (!range.empty)
  {
    layout.values.push_back({ range.left, shortNumber(range.low) });
    layout.values.push_back({ range.right, shortNumber(range.high) });
    for (const double value :
      multiples(range.low, range.high, niceStep(range.high - range.low, most)))
    {
      if (free(range.place(value)))
      {
        layout.values.push_back({ range.place(value), shortNumber(value) });
      }
    }
  }
  std::sort(layout.values.begin(), layout.values.end(),
    [](const HistogramTick& a, const HistogramTick& b) { return a.position < b.position; });
}

double heightOf(double count, double top, CountScale scale)
{
  return scale == CountScale::Linear ? count / top
    : count > LogBase                ? std::log(count / LogBase) / std::log(top / LogBase)
                                     : 0.0;
}

void addCounts(const MetricHistogram& histogram, const HistogramView& view, HistogramLayout& layout)
{
  double most = std::max<double>(1, static_cast<double>(view.most));
  for (const HistogramBar& bar : histogram.bars)
  {
    most = std::max(most, static_cast<double>(bar.count));
  }
  std::vector<double> ticks;
  double top = HeadRoom * most;
  if (view.scale == CountScale::Linear)
  {
    // Whole elements.
    const double step = std::max(1.0, niceStep(most, view.countTicks));
    top = step * std::ceil(most / step - 1e-9);
    ticks = multiples(0, top, step);
  }
  else
  {
    const int decades = static_cast<int>(std::floor(std::log10(most) + 1e-9));
    const int step = 1 + decades / std::max(1, view.countTicks);
    for (int decade = 0; decade <= decades; decade += step)
    {
      ticks.push_back(std::pow(10.0, decade));
    }
  }
  for (const double tick : ticks)
  {
    layout.counts.push_back({ heightOf(tick, top, view.scale), shortCount(tick) });
  }
  for (const HistogramBar& bar : histogram.bars)
  {
    layout.heights.push_back(heightOf(static_cast<double>(bar.count), top, view.scale));
  }
}

/// The colors of the elements in pictures.
void addColors(const MetricHistogram& histogram, HistogramLayout& layout)
{
  const std::vector<ColorMapSpec> maps = metricColorMaps();
  const auto map = std::find_if(maps.begin(), maps.end(),
    [&histogram](const ColorMapSpec& spec) { return spec.array == histogram.metric; });
  const bool known = map != maps.end();
  const MetricInfo* info = findMetric(histogram.metric);
  const bool largerIsBetter = info && info->direction == Direction::LargerIsBetter;
  const bool badIsRight = known ? map->bad > map->good : !largerIsBetter;
  for (const HistogramBar& bar : histogram.bars)
  {
    const bool goodSide = bar.kind == (badIsRight ? HistogramBar::Below : HistogramBar::Above);
    const double value = goodSide && known ? map->good : 0.5 * (bar.low + bar.high);
    layout.colors.push_back(bar.kind == HistogramBar::Inverted
        ? std::array<double, 3>{ InvertedColor[0], InvertedColor[1], InvertedColor[2] }
        : insideRange(bar) || goodSide ? (known ? colorOf(*map, value) : NoMapColor)
                                       : OutsideColor);
  }
}

/// Where a value is: over its bin, or over the bar of values beyond the range.
double placeOf(double value, const MetricHistogram& histogram, const BinRange& range,
  const HistogramLayout& layout)
{
  if (value >= range.low && value <= range.high)
  {
    return range.place(value);
  }
  const auto kind = value < range.low ? HistogramBar::Below : HistogramBar::Above;
  for (std::size_t i = 0; i < histogram.bars.size(); ++i)
  {
    const HistogramBar& bar = histogram.bars[i];
    if (bar.kind == kind)
    {
      const double fraction = (value - bar.low) / (bar.high - bar.low);
      const double inside = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.5;
      return layout.left[i] + inside * (layout.right[i] - layout.left[i]);
    }
  }
  return value < range.low ? range.left : range.right;
}

std::string typeName(std::size_t gradedType)
{
  return gradedType < NumberOfCellTypes ? topologies()[gradedType].name
    : gradedType == NumberOfCellTypes   ? "polygon"
                                        : "polyhedron";
}

int dimensionOfType(std::size_t gradedType)
{
  return gradedType < NumberOfCellTypes ? topologies()[gradedType].dimension
    : gradedType == NumberOfCellTypes   ? 2
                                        : 3;
}

/// The names of cell types; all of the same dimension that are limited are shells or solids.
std::string namesOf(const std::set<std::size_t>& types, const std::set<std::size_t>& limited)
{
  std::string names;
  for (const int dimension : { 2, 3 })
  {
    std::set<std::size_t> some, all;
    const auto select = [dimension](const std::set<std::size_t>& from, std::set<std::size_t>& to)
    {
      std::copy_if(from.begin(), from.end(), std::inserter(to, to.end()),
        [dimension](std::size_t type) { return dimensionOfType(type) == dimension; });
    };
    select(types, some);
    select(limited, all);
    if (some.size() > 1 && some == all)
    {
      names += (names.empty() ? "" : ", ") + std::string(dimension == 2 ? "shells" : "solids");
      continue;
    }
    for (const std::size_t type : some)
    {
      names += (names.empty() ? "" : ", ") + typeName(type);
    }
  }
  return names;
}

/// The values of the limits, with the cell types where these have different ones.
std::vector<HistogramLimit> distinctLimits(
  const QualityCriterion& criterion, const std::vector<int>& vtkCellTypes)
{
  std::set<std::size_t> chosen;
  for (const int type : vtkCellTypes)
  {
    if (const int index = gradedTypeIndex(type); index >= 0)
    {
      chosen.insert(static_cast<std::size_t>(index));
    }
  }
  std::set<std::size_t> limited;
  for (std::size_t i = 0; i < criterion.limits.size(); ++i)
  {
    if (criterion.limits[i] && (vtkCellTypes.empty() || chosen.count(i) > 0))
    {
      limited.insert(i);
    }
  }
  std::vector<HistogramLimit> found;
  for (const bool fail : { false, true })
  {
    std::map<double, std::set<std::size_t>> types;
    for (const std::size_t type : limited)
    {
      const QualityLimits& limits = *criterion.limits[type];
      types[fail ? limits.fail : limits.warn].insert(type);
    }
    for (const auto& [value, of] : types)
    {
      found.push_back({ value, fail, types.size() > 1 ? namesOf(of, limited) : "" });
    }
  }
  return found;
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::vector<HistogramLimit> histogramLimits(
  const std::string& criteria, const std::string& metric, const std::vector<int>& vtkCellTypes)
{
  if (criteria.empty())
  {
    return {};
  }
  QualityCriteria parsed;
  try
  {
    parsed = parseCriteria(criteriaText(criteria));
  }
  catch (const Error&)
  {
    return {}; // a file on the computer of a server
  }
  for (const QualityCriterion& one : parsed.criteria)
  {
    if (one.name() == metric)
    {
      return distinctLimits(one, vtkCellTypes);
    }
  }
  return {};
}

//------------------------------------------------------------------------------
HistogramLayout layoutOf(const MetricHistogram& histogram,
  const std::vector<HistogramLimit>& limits, const HistogramView& view)
{
  HistogramLayout layout;
  const MetricInfo* info = findMetric(histogram.metric);
  const std::string unit = info ? info->unit : "";
  layout.title = histogram.label + (unit.empty() ? "" : " (" + unit + ")");
  layout.countTitle =
    std::string("Number of elements") + (view.scale == CountScale::Linear ? "" : ", logarithmic");
  placeBars(histogram, layout);
  const BinRange range = binRange(histogram, layout);
  addValueTicks(range, view.valueTicks, layout);
  addCounts(histogram, view, layout);
  addColors(histogram, layout);
  for (const HistogramLimit& limit : limits)
  {
    if (!range.empty)
    {
      layout.marks.push_back({ placeOf(limit.value, histogram, range, layout), limit.fail,
        (limit.fail ? "fail " : "warn ") + shortNumber(limit.value) +
          (limit.types.empty() ? "" : " (" + limit.types + ")") });
    }
  }
  std::stable_sort(layout.marks.begin(), layout.marks.end(),
    [](const HistogramMark& a, const HistogramMark& b) { return a.position < b.position; });
  return layout;
}

//------------------------------------------------------------------------------
std::string describeColors(const MetricHistogram& histogram, const MetricHistogram* other)
{
  const auto begin = histogram.bars.begin(), end = histogram.bars.end();
  const auto first = std::find_if(begin, end, insideRange);
  const auto last = std::find_if(histogram.bars.rbegin(), histogram.bars.rend(), insideRange);
  const auto has = [&](HistogramBar::Kind kind)
  {
    const auto counts = [kind](const HistogramBar& bar)
    { return bar.kind == kind && bar.count > 0; };
    return std::any_of(begin, end, counts) ||
      (other && std::any_of(other->bars.begin(), other->bars.end(), counts));
  };
  const MetricInfo* info = findMetric(histogram.metric);
  // Without a direction nothing is unacceptable.
  const bool judged = first != end && info && info->direction != Direction::Neutral;
  const bool degenerate = has(HistogramBar::Degenerate);
  const bool outside = judged && (has(HistogramBar::Below) || has(HistogramBar::Above));
  std::vector<std::string> sentences;
  // Where the metric has no range, the bars have that of the values.
  const auto isRange = [](const Range& range)
  { return range.low < range.high && std::isfinite(range.low) && std::isfinite(range.high); };
  if (judged && (isRange(info->acceptable2D) || isRange(info->acceptable3D)))
  {
    sentences.push_back(
      "Acceptable: " + shortNumber(first->low) + " to " + shortNumber(last->high) + ".");
  }
  if (outside || degenerate)
  {
    sentences.push_back(std::string("Darkest red: ") + (outside ? "outside" : "") +
      (outside && degenerate ? " or " : "") + (degenerate ? "degenerate" : "") + ".");
  }
  if (has(HistogramBar::Inverted))
  {
    sentences.emplace_back("Blue: inverted.");
  }
  std::string text;
  for (const std::string& sentence : sentences)
  {
    text += (text.empty() ? "" : " ") + sentence;
  }
  return text;
}

} // namespace tautline
