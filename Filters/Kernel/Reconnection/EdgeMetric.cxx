// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeMetric.h"

namespace tautline
{
namespace
{
EdgeMetric metricOf(double length)
{
  const double m = 1.0 / (length * length);
  return { m, m, m, 0.0, 0.0, 0.0 };
}

bool isPositiveDefinite(const EdgeMetric& m)
{
  const double minor = m[0] * m[1] - m[3] * m[3];
  const double determinant =
    m[2] * minor - m[4] * (m[0] * m[4] - m[3] * m[5]) + m[5] * (m[3] * m[4] - m[1] * m[5]);
  return std::isfinite(determinant) && m[0] > 0.0 && minor > 0.0 && determinant > 0.0;
}
}

EdgeMetric turned(const EdgeMetric& m, const std::array<Vec3, 3>& axes)
{
  const auto product = [&](int i, int j)
  {
    const Vec3 &a = axes[i], &b = axes[j];
    return m[0] * a[0] * b[0] + m[1] * a[1] * b[1] + m[2] * a[2] * b[2] +
      m[3] * (a[0] * b[1] + a[1] * b[0]) + m[4] * (a[1] * b[2] + a[2] * b[1]) +
      m[5] * (a[0] * b[2] + a[2] * b[0]);
  };
  return { product(0, 0), product(1, 1), product(2, 2), product(0, 1), product(1, 2),
    product(0, 2) };
}

std::vector<EdgeMetric> edgeMetrics(
  const ReconnectionInput& input, const ReconnectionOptions& options)
{
  const bool own = options.size == ReconnectionSize::Input;
  return edgeMetrics(input.points, input.exponent,
    own ? meanEdgeLengths(input.points, input.cells) : std::vector<double>(), options);
}

std::vector<EdgeMetric> edgeMetrics(const std::vector<Vec3>& points, int exponent,
  const std::vector<double>& lengths, const ReconnectionOptions& options)
{
  const std::size_t count = points.size();
  const auto converted = [&](double length) { return std::ldexp(length, -exponent); };
  if (options.size == ReconnectionSize::None)
  {
    return {};
  }
  if (options.size == ReconnectionSize::Input)
  {
    std::vector<EdgeMetric> metrics(lengths.size());
    std::transform(lengths.begin(), lengths.end(), metrics.begin(), metricOf);
    return metrics;
  }
  if (options.size == ReconnectionSize::Length)
  {
    return std::vector<EdgeMetric>(count, metricOf(converted(options.edgeLength)));
  }
  if (!options.sizes)
  {
    throw Error("the target lengths of edges are missing: choose an array of points with them");
  }
  std::vector<EdgeMetric> metrics(count);
  Index invalid = 0;
  for (std::size_t v = 0; v < count; ++v)
  {
    if (options.size == ReconnectionSize::Lengths)
    {
      metrics[v] = metricOf(converted(options.sizes[v]));
      invalid += !(options.sizes[v] > 0.0) || !std::isfinite(options.sizes[v]);
      continue;
    }
    std::copy_n(options.sizes + 6 * v, 6, metrics[v].begin());
    invalid += !isPositiveDefinite(metrics[v]);
    for (double& m : metrics[v])
    {
      m = std::ldexp(m, 2 * exponent);
    }
  }
  if (invalid > 0)
  {
    throw Error(std::to_string(invalid) +
      (options.size == ReconnectionSize::Lengths
          ? " target lengths of edges are not positive: correct the array"
          : " metric tensors are not positive definite: correct the array"));
  }
  return metrics;
}
}
