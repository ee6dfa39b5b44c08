/**
 * @file EdgeMetric.h
 * @brief The metric in which edges have the length 1, of each point. Internal: not installed.
 */
#ifndef tautline_EdgeMetric_h
#define tautline_EdgeMetric_h

#include "ReconnectionInput.h"

namespace tautline
{
/// xx yy zz xy yz xz of a positive definite tensor.
using EdgeMetric = std::array<double, 6>;

/// The square of the length of an edge in the mean of two metrics.
inline double squaredLength(const Vec3& e, const EdgeMetric& a, const EdgeMetric& b)
{
  const auto m = [&](int k) { return 0.5 * (a[k] + b[k]); };
  return m(0) * e[0] * e[0] + m(1) * e[1] * e[1] + m(2) * e[2] * e[2] +
    2.0 * (m(3) * e[0] * e[1] + m(4) * e[1] * e[2] + m(5) * e[0] * e[2]);
}

/**
 * @brief The metrics that the options ask for, in the units of the input as converted; empty for
 * ReconnectionSize::None. Throws Error for lengths and tensors that are not positive.
 */
std::vector<EdgeMetric> edgeMetrics(
  const ReconnectionInput& input, const ReconnectionOptions& options);
}
#endif
