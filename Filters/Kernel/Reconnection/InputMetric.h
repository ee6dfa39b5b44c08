// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InputMetric.h
 * @brief The metric of the input points, interpolated at any position.
 * Internal: not installed.
 */
#ifndef tautline_InputMetric_h
#define tautline_InputMetric_h

#include "ReconnectionOutput.h"

namespace tautline
{
/// Interpolates the logarithms of metric tensors linearly in the tetrahedra of the input
/// (log-Euclidean). Threads share it.
class TAUTLINE_RECONNECTIONKERNEL_EXPORT InputMetric
{
public:
  /// @param metrics one per point of the input, positive definite
  /// @param locator of the input; must outlive this object
  InputMetric(const std::vector<MetricTensor>& metrics, const ReconnectionInput& input,
    const InputLocator& locator, int threads);

  /// @param cell a cell of the input near x; set to the one that contains x, or the nearest of
  /// those on the path
  MetricTensor at(const Vec3& x, TetId& cell) const;

private:
  const ReconnectionInput& Input;
  const InputLocator& Locator;
  std::vector<MetricTensor> Logarithms; ///< per point
};
}
#endif
