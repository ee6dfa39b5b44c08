// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeMetric.h"

#include "tautline/Core/Memory.h"

#include <limits>
#include <sstream>

namespace tautline
{
void requireRoom(double elements, const char* kind, double bytesPerElement)
{
  constexpr double most =
    std::numeric_limits<std::int32_t>::max() / 8; // faces are coded in 31 bits
  std::ostringstream text;
  text << "an adaptation to about " << elements << " " << kind;
  if (!(elements < most))
  {
    throw Error(text.str() + " is too large: choose larger target lengths");
  }
  requireMemory(bytesPerElement * elements, text.str(), "choose larger target lengths");
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
  // Points are in units of 2^exponent, so that lengths are divided by it and metrics multiplied by
  // its square, exactly.
  const auto converted = [&](double length) { return std::ldexp(length, -exponent); };
  if (options.size == ReconnectionSize::None)
  {
    return {};
  }
  if (options.size == ReconnectionSize::Input)
  {
    std::vector<EdgeMetric> metrics(lengths.size());
    std::transform(lengths.begin(), lengths.end(), metrics.begin(), isotropicMetric);
    return metrics;
  }
  if (options.size == ReconnectionSize::Length)
  {
    return std::vector<EdgeMetric>(count, isotropicMetric(converted(options.edgeLength)));
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
      metrics[v] = isotropicMetric(converted(options.sizes[v]));
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
