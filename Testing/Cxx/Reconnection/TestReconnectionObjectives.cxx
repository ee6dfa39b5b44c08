// SPDX-License-Identifier: BSD-3-Clause
// improveConnectivity() for the worst values of a metric, and for the sum over all tetrahedra.

#include "Reconnecting.h"
#include "Registry.h"

using namespace tautline;

namespace
{
ReconnectionOptions metricOptions(Metric metric)
{
  ReconnectionOptions options = optionsOf(ReconnectionPreset::Aggressive);
  TAUTLINE_SET(options, objective = ReconnectionObjective::Metric, metric = metric);
  return options;
}

double worstOf(const MeshData& data, const MetricInfo& info)
{
  const std::vector<double> values = valuesOf(data, info.metric);
  return info.direction == Direction::LargerIsBetter
    ? *std::min_element(values.begin(), values.end())
    : *std::max_element(values.begin(), values.end());
}

/// Every metric that has an order and no orientation: its worst value improves, and is reported.
TAUTLINE_PART(testEveryMetric)
{
  const MeshData data = sliverBlock(3, 7, 0.9);
  int improved = 0;
  for (const MetricInfo& info : elementMetrics())
  {
    const Context context(info.name);
    if (!info.in3D || !info.definedOn(CellType::Tetrahedron))
    {
      TAUTLINE_CHECK_THROWS(
        reconnect(data, metricOptions(info.metric)), wording("is-not-defined-on-tetrahedra"));
      continue;
    }
    if (info.direction == Direction::Neutral || !info.rotationInvariant)
    {
      TAUTLINE_CHECK_THROWS(
        reconnect(data, metricOptions(info.metric)), wording("choose-another-metric"));
      continue;
    }
    // Every valid tetrahedron has the value 0 of these.
    if (worstOf(data, info) == 0.0 && info.direction == Direction::SmallerIsBetter)
    {
      continue;
    }
    const ReconnectionResult result = reconnect(data, metricOptions(info.metric));
    checkResult(data, result);
    const double before = worstOf(data, info), after = worstOf(outputOf(result), info);
    TAUTLINE_CHECK_RELATIVE(result.worstMetricBefore, before, 1e-6);
    TAUTLINE_CHECK_RELATIVE(result.worstMetricAfter, after, 1e-6);
    const bool larger = info.direction == Direction::LargerIsBetter;
    TAUTLINE_CHECK(larger ? after >= before : after <= before);
    improved += larger ? after > before : after < before;
  }
  TAUTLINE_CHECK(improved >= 20);
}

/// For the radius ratio better than by angles and shape, in units of any size, also in blocks.
TAUTLINE_PART(testMetric)
{
  const MeshData data = sliverBlock(5, 3, 0.9);
  const MetricInfo& info = metricInfo(Metric::RadiusRatio);
  ReconnectionOptions options = metricOptions(info.metric);
  constexpr double HighTarget = 50.0; // for a radius ratio of 3 / sin(50 degrees)
  options.targetAngle = HighTarget;
  const ReconnectionResult result = reconnect(data, options);
  const MeshData usual = outputOf(reconnect(data, optionsOf(ReconnectionPreset::Aggressive)));
  std::cout << "radius ratio: worst " << worstOf(data, info) << ", by the metric "
            << worstOf(outputOf(result), info) << ", by angles and shape " << worstOf(usual, info)
            << "\n";
  TAUTLINE_CHECK(worstOf(outputOf(result), info) < 0.5 * worstOf(data, info));
  TAUTLINE_CHECK(worstOf(outputOf(result), info) < worstOf(usual, info));
  MeshData scaled = data;
  for (double& x : scaled.points)
  {
    x *= 1024.0;
  }
  // Scaling by a power of two changes nothing; a metric may also depend on the size.
  TAUTLINE_CHECK(reconnect(scaled, options).tetrahedra == result.tetrahedra);
  options.metric = Metric::ConditioningSizeShape;
  checkResult(data, reconnect(data, options));
  TAUTLINE_SET(options, metric = info.metric, blockSize = 200, threads = 1);
  const ReconnectionResult one = reconnect(data, options);
  options.threads = 3;
  TAUTLINE_CHECK(reconnect(data, options).points == one.points);
  checkResult(data, one);
}

double excessOf(const MeshData& data)
{
  const std::vector<double> values = valuesOf(data, Metric::InverseMeanRatio);
  return std::accumulate(values.begin(), values.end(), 0.0) - static_cast<double>(values.size());
}

TAUTLINE_PART(testSum)
{
  const MeshData data = sliverBlock(6, 9, 0.9);
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    ReconnectionOptions options = optionsOf(ReconnectionPreset::Aggressive);
    options.boundary = boundary;
    const MeshData worstFirst = outputOf(reconnect(data, options));
    options.objective = ReconnectionObjective::Sum;
    const ReconnectionResult result = reconnect(data, options);
    checkResult(data, result);
    const MeshData output = outputOf(result);
    TAUTLINE_CHECK(excessOf(output) < 0.5 * excessOf(data));
    TAUTLINE_CHECK(excessOf(output) < excessOf(worstFirst));
    const auto count = static_cast<double>(output.numberOfCells());
    TAUTLINE_CHECK_RELATIVE(result.meanAfter, 1.0 + excessOf(output) / count, 1e-9);
    const ReconnectionRecord& last = result.history.back();
    TAUTLINE_CHECK(last.edgeRemovals > 0 && last.faceRemovals > 0 && last.moves > 0);
    TAUTLINE_CHECK(count >= 0.9 * static_cast<double>(data.numberOfCells()));
    TAUTLINE_SET(options, blockSize = 200, threads = 1);
    const ReconnectionResult one = reconnect(data, options);
    options.threads = 3;
    TAUTLINE_CHECK(reconnect(data, options).points == one.points);
    checkResult(data, one);
  }
}
}
