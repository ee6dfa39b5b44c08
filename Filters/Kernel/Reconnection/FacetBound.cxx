// SPDX-License-Identifier: BSD-3-Clause
#include "FacetBound.h"

namespace tautline
{
namespace
{
/// The number of steps of the fourth point, and of runs that start where the previous one ended.
constexpr int Steps = 60, Runs = 4;
constexpr double LeastGain = 1e-5;
/// Square of the height with the best mean ratio, relative to the sum of the squared edges.
constexpr double Height2 = 2.0 / 9.0;
}

double facetMeanRatio(const Vec3& a, const Vec3& b, const Vec3& c)
{
  const double sum = dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c);
  return 2.0 * std::sqrt(3.0) * norm(cross(b - a, c - a)) / sum;
}

double facetQuality(const Vec3& a, const Vec3& b, const Vec3& c, const QualityWeights& weights,
  StarSmoothing& smoothing)
{
  const double sum = dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c);
  const Vec3 n = cross(b - a, c - a);
  const double area = norm(n);
  if (!(area > 0.0))
  {
    return 0.0;
  }
  smoothing.clear();
  smoothing.weights = weights; // before faces are added
  // Only here, smaller gains than usual count.
  const double leastGain = smoothing.leastGain;
  smoothing.leastGain = LeastGain;
  smoothing.addFace(a, b, c);
  // Positive on the side that the normal points to.
  Vec3 p = (1.0 / 3.0) * (a + b + c) + (std::sqrt(Height2 * sum) / area) * n;
  if (smoothing.evaluate(p) < 0.0)
  {
    p = (2.0 / 3.0) * (a + b + c) - p;
  }
  double best = smoothing.evaluate(p);
  for (int run = 0; run < Runs; ++run)
  {
    best = std::max(best, smoothing.maximize(p, Steps));
  }
  smoothing.leastGain = leastGain;
  return std::min(best, weights.meanRatio * facetMeanRatio(a, b, c));
}
}
