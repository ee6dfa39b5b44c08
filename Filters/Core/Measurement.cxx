// SPDX-License-Identifier: BSD-3-Clause
#include "Measurement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// The joint statistics of all lists. Sums are rounded once, so that the order of the values does
/// not matter.
MetricStatistics summarizeTogether(
  RankGroup& group, const MetricInfo& info, int dimension, const std::vector<double>& own)
{
  const MetricStatistics here = summarize(info, dimension, own, false);
  MetricStatistics all;
  all.measured = group.sum(here.measured);
  if (all.measured == 0)
  {
    return all;
  }
  const auto n = static_cast<double>(all.measured);
  constexpr double none = -std::numeric_limits<double>::infinity();
  all.minimum = -group.maximum(own.empty() ? none : -here.minimum);
  all.maximum = group.maximum(own.empty() ? none : here.maximum);
  all.outsideAcceptable = group.sum(here.outsideAcceptable);
  // Scaled by a power of two that brings the largest near 1, as in summarize().
  constexpr int farthest = 1000;
  const double largest = std::max(std::abs(all.minimum), std::abs(all.maximum));
  const int exponent = largest > 0 ? std::clamp(std::ilogb(largest), -farthest, farthest) : 0;
  const auto meanOf = [&](const auto& term)
  {
    std::vector<double> terms(own.size());
    std::transform(own.begin(), own.end(), terms.begin(),
      [&](double v) { return term(std::ldexp(v, -exponent)); });
    return group.orderlessSum(terms) / n;
  };
  const double mean = meanOf([](double v) { return v; });
  all.mean = std::ldexp(mean, exponent);
  all.rms = std::ldexp(std::sqrt(meanOf([](double v) { return v * v; })), exponent);
  all.standardDeviation =
    std::ldexp(std::sqrt(meanOf([mean](double v) { return (v - mean) * (v - mean); })), exponent);
  return all;
}
}

//------------------------------------------------------------------------------
Measurement measure(RankGroup* group, const Mesh& mesh, int dimension, Metric metric,
  const EvaluationOptions& options, const signed char* validity, const unsigned char* skip,
  double* values)
{
  if (mesh.view().numberOfCells > 0)
  {
    evaluateMetric(mesh, metric, options, values);
  }
  return measureValues(group, mesh.view(), dimension, metric, validity, skip, values);
}

//------------------------------------------------------------------------------
Measurement measureValues(RankGroup* group, const MeshView& view, int dimension, Metric metric,
  const signed char* validity, const unsigned char* skip, const double* values)
{
  const MetricInfo& info = metricInfo(metric);
  const CellValues data = { view.numberOfCells, values, validity, view.cellTypes, skip };
  std::vector<double> own;
  std::vector<WorstElement> worst;
  Measurement result;
  if (view.numberOfCells > 0)
  {
    own = measuredValues(info, data);
    worst = worstElements(info, data);
    result.counts = countValidity(validity, skip, view.numberOfCells);
  }
  if (group)
  {
    const auto lists = group->gatherItems(worst);
    worst.clear();
    for (const auto& list : lists)
    {
      worst.insert(worst.end(), list.begin(), list.end());
    }
    std::sort(worst.begin(), worst.end(),
      [&](const WorstElement& a, const WorstElement& b) { return isWorse(info, a, b); });
    ValidityCounts& counts = result.counts;
    for (Index* count : { &counts.valid, &counts.inverted, &counts.degenerate, &counts.notMeasured,
           &counts.nonFinite })
    {
      *count = group->sum(*count);
    }
  }
  result.statistics = group ? summarizeTogether(*group, info, dimension, own)
                            : summarize(info, dimension, own, false);
  result.worst = worstValue(info, result.statistics, worst);
  return result;
}
}
