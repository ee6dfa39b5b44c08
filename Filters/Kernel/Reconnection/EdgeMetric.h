// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EdgeMetric.h
 * @brief The metric of each point, in which target edges have length 1.
 * Internal: not installed.
 */
#ifndef tautline_EdgeMetric_h
#define tautline_EdgeMetric_h

#include "ReconnectionInput.h"
#include "tautline/Adaptation/MetricTensor.h"

namespace tautline
{
using EdgeMetric = MetricTensor;

/**
 * @brief The metrics requested by the options, in the units of the converted input; empty for
 * ReconnectionSize::None. Throws Error for lengths and tensors that are not positive.
 */
std::vector<EdgeMetric> edgeMetrics(
  const ReconnectionInput& input, const ReconnectionOptions& options);

/**
 * @brief The same for other cells.
 * @param points converted: times 2^-exponent
 * @param lengths the mean length of the edges at each point, with ReconnectionSize::Input
 */
std::vector<EdgeMetric> edgeMetrics(const std::vector<Vec3>& points, int exponent,
  const std::vector<double>& lengths, const ReconnectionOptions& options);

/// Throws Error if an adaptation would create more elements than fit into memory.
void requireRoom(double elements, const char* kind, double bytesPerElement);

/// The mean length of the edges at each point, 1 if there are none; edges are counted once per
/// cell.
template <class Cells>
std::vector<double> meanEdgeLengths(const std::vector<Vec3>& points, const Cells& cells)
{
  std::vector<double> sums(points.size(), 0.0);
  std::vector<int> counts(points.size(), 0);
  for (const auto& cell : cells)
  {
    for (const auto v : cell)
    {
      for (const auto w : cell)
      {
        sums[v] += norm(points[w] - points[v]);
        counts[v] += v != w;
      }
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v)
  {
    sums[v] = counts[v] > 0 ? sums[v] / counts[v] : 1.0;
  }
  return sums;
}
}
#endif
