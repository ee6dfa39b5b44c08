// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricQuality.h
 * @brief A metric of the registry as the quality that reconnection maximizes.
 * Internal: not installed.
 */
#ifndef tautline_MetricQuality_h
#define tautline_MetricQuality_h

#include "tautline/Quality/Batch.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief Maps the values x of a metric on tetrahedra to qualities q from 0 to 1, preserving the
 * order from worst to best: with the ideal value I, q = x / I if larger is better, I / x if smaller
 * is better and I is above 0, and 1 / (1 + x) for I = 0. Without an ideal value (it depends on the
 * size), x / (x + u) or u / (x + u) with the mean u of the input. At most 0 for tetrahedra that are
 * degenerate or inverted.
 *
 * Threads share it.
 */
class TAUTLINE_RECONNECTIONKERNEL_EXPORT MetricQuality
{
public:
  /**
   * @brief Throws Error, with a remedy, for metrics that are not defined on tetrahedra, have no
   * derivatives, depend on the orientation in space, or have no direction of improvement.
   * @param exponent the metric is evaluated for the points times 2^exponent
   * @param mean of the metric values in the input
   */
  MetricQuality(Metric metric, int exponent, double mean);
  MetricQuality(const MetricQuality&) = delete;
  void operator=(const MetricQuality&) = delete;

  const MetricInfo& info() const { return this->Info; }
  double quality(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) const;
  /**
   * @brief The qualities of several tetrahedra with the vertex p.
   * @param faces a, b, c in the order that makes (p, a, b, c) positive
   * @param values one per face
   * @param gradients with respect to p, one per face; null: not needed
   */
  void evaluate(const Vec3& p, const std::array<Vec3, 3>* faces, int count, double* values,
    Vec3* gradients) const;
  /// The value of the metric that has a quality.
  double valueOf(double quality) const;

private:
  double qualityOf(double value, double& slope) const;

  const MetricInfo& Info;
  double Scale = 1, Unit = 1; ///< of the points, and of the values
  bool Reciprocal = false;    ///< whether q = Unit / x or x / Unit, without a sum
  // The mesh for an evaluator: one tetrahedron.
  std::array<double, 12> Points = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  std::array<unsigned char, 1> Types;
  std::array<Index, 2> Offsets = { 0, 4 };
  std::array<Index, 4> Connectivity = { 0, 1, 2, 3 };
  std::unique_ptr<Mesh> One;
  EvaluationOptions Options;
  BatchContext Context;
  BatchEvaluator Value = nullptr, Gradient = nullptr;
};
}
#endif
