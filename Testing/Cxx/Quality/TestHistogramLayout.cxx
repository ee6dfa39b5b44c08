// SPDX-License-Identifier: BSD-3-Clause
/// Layouts of histograms: bars, ticks of both axes, limits of criteria, colors.
#include "HistogramLayout.h"
#include "Registry.h"

#include "ColorMaps.h"
#include "tautline/Quality/Metrics.h"

using namespace tautline;

namespace
{
/// Four bins over 1 to 3, then values above, then inverted elements.
MetricHistogram sample(std::vector<vtkIdType> counts)
{
  MetricHistogram histogram = { "imr", "Inverse mean ratio", {} };
  for (int bin = 0; bin < 4; ++bin)
  {
    histogram.bars.push_back(
      { bin < 3 ? HistogramBar::Bin : HistogramBar::LastBin, 1 + 0.5 * bin, 1.5 + 0.5 * bin, 0 });
  }
  histogram.bars.push_back({ HistogramBar::Above, 3, 13, 0 });
  histogram.bars.push_back({ HistogramBar::Inverted, 0, 0, 0 });
  for (std::size_t i = 0; i < counts.size(); ++i)
  {
    histogram.bars[i].count = counts[i];
  }
  return histogram;
}

std::string labels(const std::vector<HistogramTick>& ticks)
{
  std::string all;
  for (const HistogramTick& tick : ticks)
  {
    all += (all.empty() ? "" : " ") + tick.label;
  }
  return all;
}

HistogramView viewOf(CountScale scale)
{
  HistogramView view;
  view.scale = scale;
  return view;
}

TAUTLINE_PART(testBars)
{
  const HistogramLayout layout =
    layoutOf(sample({ 10, 5, 0, 1, 2, 3 }), {}, viewOf(CountScale::Linear));
  TAUTLINE_CHECK_EQUAL(layout.left.size(), std::size_t(6));
  TAUTLINE_CHECK_EQUAL(layout.left.front(), 0.0);
  TAUTLINE_CHECK_NEAR(layout.right.back(), 1.0, 1e-12);
  for (std::size_t i = 1; i < layout.left.size(); ++i)
  {
    TAUTLINE_CHECK(layout.left[i] > layout.right[i - 1] - 1e-12);
  }
  // The axis ends at 10, a multiple of the step.
  TAUTLINE_CHECK_NEAR(layout.heights[0], 1.0, 1e-12);
  TAUTLINE_CHECK_NEAR(layout.heights[1], 0.5, 1e-12);
  TAUTLINE_CHECK_EQUAL(layout.heights[2], 0.0);
  TAUTLINE_CHECK_EQUAL(layout.title, std::string("Inverse mean ratio"));
}

TAUTLINE_PART(testTicks)
{
  const MetricHistogram histogram = sample({ 4000, 5, 0, 1, 2, 3 });
  const HistogramLayout linear = layoutOf(histogram, {}, viewOf(CountScale::Linear));
  TAUTLINE_CHECK_EQUAL(labels(linear.values), std::string("1 1.5 2 2.5 3"));
  TAUTLINE_CHECK_EQUAL(labels(linear.counts), std::string("0 1000 2000 3000 4000"));
  TAUTLINE_CHECK_NEAR(linear.values[2].position, linear.left[2], 1e-12);
  TAUTLINE_CHECK_NEAR(linear.counts[1].position, 0.25, 1e-12);
  const HistogramLayout logarithmic = layoutOf(histogram, {}, viewOf(CountScale::Logarithmic));
  TAUTLINE_CHECK_EQUAL(labels(logarithmic.counts), std::string("1 10 100 1000"));
  // A bar of one element is as high as the tick of one, and can be seen; none has no height.
  TAUTLINE_CHECK_NEAR(logarithmic.heights[3], logarithmic.counts[0].position, 1e-12);
  TAUTLINE_CHECK(logarithmic.heights[3] > 0.03);
  TAUTLINE_CHECK_EQUAL(logarithmic.heights[2], 0.0);
  const double decade = logarithmic.counts[2].position - logarithmic.counts[1].position;
  TAUTLINE_CHECK_NEAR(
    logarithmic.counts[3].position - logarithmic.counts[2].position, decade, 1e-12);
  TAUTLINE_CHECK(logarithmic.heights[0] < 1.0 && logarithmic.heights[0] > 0.9);
  const HistogramLayout many = layoutOf(sample({ 3000000 }), {}, viewOf(CountScale::Linear));
  TAUTLINE_CHECK_EQUAL(labels(many.counts), std::string("0 1M 2M 3M"));
  const HistogramLayout decades =
    layoutOf(sample({ 3000000 }), {}, viewOf(CountScale::Logarithmic));
  TAUTLINE_CHECK_EQUAL(labels(decades.counts), std::string("1 100 10k 1M"));
  // Few elements: no tick between whole numbers. The axis of another histogram.
  const HistogramLayout few = layoutOf(sample({ 2 }), {}, viewOf(CountScale::Linear));
  TAUTLINE_CHECK_EQUAL(labels(few.counts), std::string("0 1 2"));
  HistogramView view = viewOf(CountScale::Linear);
  view.most = 8;
  TAUTLINE_CHECK_NEAR(layoutOf(sample({ 2 }), {}, view).heights[0], 0.25, 1e-12);
  const HistogramLayout none = layoutOf(sample({}), {}, viewOf(CountScale::Logarithmic));
  TAUTLINE_CHECK_EQUAL(none.heights[0], 0.0);
}

TAUTLINE_PART(testUnit)
{
  MetricHistogram angles = { "min_angle", "Minimum angle", {} };
  angles.bars.push_back({ HistogramBar::LastBin, 30, 60, 4 });
  TAUTLINE_CHECK_EQUAL(layoutOf(angles, {}, {}).title, std::string("Minimum angle (degrees)"));
  // A range without a length has no ticks.
  angles.bars[0].high = 30;
  TAUTLINE_CHECK(layoutOf(angles, {}, {}).values.empty());
}

TAUTLINE_PART(testLimits)
{
  const std::string criteria =
    R"({ "criteria": [ { "metric": "imr", "limits": {
      "triangle": { "ideal": 1, "good": 1.5, "warn": 2, "fail": 8, "worst": 100 },
      "quadrilateral": { "ideal": 1, "good": 1.5, "warn": 2.5, "fail": 8, "worst": 100 } } } ] })";
  constexpr int triangle = 5, quadrilateral = 9;
  const auto all = histogramLimits(criteria, "imr", { triangle, quadrilateral });
  TAUTLINE_CHECK_EQUAL(all.size(), std::size_t(3));
  TAUTLINE_CHECK_EQUAL(all[1].types, std::string("quadrilateral"));
  TAUTLINE_CHECK(all[2].fail && all[2].types.empty());
  TAUTLINE_CHECK_EQUAL(histogramLimits(criteria, "imr", {}).size(), std::size_t(3));
  TAUTLINE_CHECK(histogramLimits(criteria, "min_angle", {}).empty());
  TAUTLINE_CHECK(histogramLimits("", "imr", {}).empty());
  TAUTLINE_CHECK(histogramLimits("no such file", "imr", {}).empty());
  TAUTLINE_CHECK_EQUAL(histogramLimits("fem", "imr", {}).size(), std::size_t(2));

  // The types of one dimension have one name.
  const auto angles = histogramLimits("fem", "max_angle", {});
  TAUTLINE_CHECK_EQUAL(angles.size(), std::size_t(4));
  TAUTLINE_CHECK_EQUAL(angles[0].types, std::string("shells"));
  TAUTLINE_CHECK_EQUAL(angles[3].types, std::string("solids"));
  constexpr int tetrahedron = 10;
  TAUTLINE_CHECK_EQUAL(histogramLimits("fem", "max_angle", { tetrahedron }).size(), std::size_t(2));

  const HistogramLayout layout = layoutOf(sample({ 1 }), all, {});
  TAUTLINE_CHECK_EQUAL(layout.marks.size(), std::size_t(3));
  TAUTLINE_CHECK_EQUAL(layout.marks[0].label, std::string("warn 2 (triangle)"));
  TAUTLINE_CHECK_NEAR(layout.marks[0].position, layout.left[2], 1e-12);
  // 8 is in the middle of the bar of 3 to 13.
  TAUTLINE_CHECK_EQUAL(layout.marks[2].label, std::string("fail 8"));
  TAUTLINE_CHECK_NEAR(layout.marks[2].position, 0.5 * (layout.left[4] + layout.right[4]), 1e-12);
}

TAUTLINE_PART(testColors)
{
  const MetricHistogram histogram = sample({ 1, 1, 1, 1, 1, 1 });
  const HistogramLayout layout = layoutOf(histogram, {}, {});
  const auto maps = metricColorMaps();
  const auto map = std::find_if(
    maps.begin(), maps.end(), [](const ColorMapSpec& spec) { return spec.array == "imr"; });
  TAUTLINE_CHECK(map != maps.end() && layout.colors[1] == colorOf(*map, 1.75));
  TAUTLINE_CHECK(layout.colors[4] == colorOf(*map, 1000));
  for (int channel = 0; channel < 3; ++channel)
  {
    TAUTLINE_CHECK_EQUAL(layout.colors[5].at(channel), InvertedColor[channel]);
  }
  TAUTLINE_CHECK(contains(describeColors(histogram), wording("acceptable-1-to-3")));
  TAUTLINE_CHECK(contains(describeColors(histogram), wording("blue-inverted")));
  const MetricHistogram valid = sample({ 1 });
  TAUTLINE_CHECK(!contains(describeColors(valid), wording("blue-inverted")));
  TAUTLINE_CHECK(contains(describeColors(valid, &histogram), wording("blue-inverted")));
}
}
