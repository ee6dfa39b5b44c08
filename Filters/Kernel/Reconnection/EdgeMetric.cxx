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

/// The mean length of the edges at each point; edges count once per tetrahedron.
std::vector<EdgeMetric> metricsOfInput(const ReconnectionInput& input)
{
  std::vector<double> sums(input.points.size(), 0.0);
  std::vector<int> counts(input.points.size(), 0);
  for (const TetVertices& cell : input.cells)
  {
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < 4; ++j)
      {
        sums[cell[i]] += norm(input.points[cell[j]] - input.points[cell[i]]);
        counts[cell[i]] += i != j;
      }
    }
  }
  std::vector<EdgeMetric> metrics;
  for (std::size_t v = 0; v < sums.size(); ++v)
  {
    metrics.push_back(metricOf(counts[v] > 0 ? sums[v] / counts[v] : 1.0));
  }
  return metrics;
}
}

std::vector<EdgeMetric> edgeMetrics(
  const ReconnectionInput& input, const ReconnectionOptions& options)
{
  const std::size_t count = input.points.size();
  const auto converted = [&](double length) { return std::ldexp(length, -input.exponent); };
  if (options.size == ReconnectionSize::None)
  {
    return {};
  }
  if (options.size == ReconnectionSize::Input)
  {
    return metricsOfInput(input);
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
      m = std::ldexp(m, 2 * input.exponent);
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
