// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleMetrics.h
 * @brief The metric field of the input, at any position.
 * Internal: not installed.
 */
#ifndef tautline_TriangleMetrics_h
#define tautline_TriangleMetrics_h

#include "TriangleLocator.h"

namespace tautline
{
/**
 * @brief Interpolates metrics in the triangles of the input: exp of the mean of the logarithms at
 * the corners, with the weights of the position. Not thread-safe.
 */
class TAUTLINE_RECONNECTIONKERNEL_EXPORT TriangleMetrics
{
public:
  /// @param mesh the input; both must outlive this object
  TriangleMetrics(const TriangleMesh& mesh, const TriangleInput& input);

  /// @param start a triangle of the input near x, on a surface of the same patch
  PointMetric at(const Vec3& x, TriId start) const;
  /// The triangle of the input that contains x, or the closest one.
  TriId locate(const Vec3& x, TriId start) const;

private:
  const TriangleInput& Input;
  TriangleLocator Locator;
  std::vector<MetricTensor> Logarithms; ///< for a planar mesh, in its plane with other entries 0
};
}
#endif
