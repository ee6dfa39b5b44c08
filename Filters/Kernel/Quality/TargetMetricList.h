// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetMetricList.h
 * @brief The built-in target metrics by their numbers.
 * Internal: not installed.
 */
#ifndef tautline_TargetMetricList_h
#define tautline_TargetMetricList_h

#include "TargetMetrics.h"

namespace tautline
{
/// Calls work with the formula of a metric.
/// @return the result of work, or nothing if the metric is not a built-in target metric
template <class Work>
auto withTargetMetric(Metric metric, const Work& work) -> decltype(work(InverseMeanRatio()))
{
  switch (metric)
  {
    case Metric::InverseMeanRatio:
      return work(InverseMeanRatio());
    case Metric::MeanRatio:
      return work(MeanRatio());
    case Metric::ConditionNumber:
      return work(ConditionNumber());
    case Metric::UntangleBeta:
      return work(UntangleBeta());
    case Metric::ShapeBarrier:
      return work(ShapeBarrier());
    case Metric::ShapeNonBarrier:
      return work(ShapeNonBarrier());
    case Metric::ShapeCondition:
      return work(ShapeCondition());
    case Metric::ShapeConditionSquared:
      return work(ShapeConditionSquared());
    case Metric::ShapeSquared:
      return work(ShapeSquared());
    case Metric::ShapeProduct:
      return work(ShapeProduct());
    case Metric::ShapeCubic:
      return work(ShapeCubic());
    case Metric::ShapeSizeAdjugate:
      return work(ShapeSizeAdjugate());
    case Metric::ShapeSimilarity:
      return work(ShapeSimilarity());
    case Metric::ShapeSizeBarrier:
      return work(ShapeSizeBarrier());
    case Metric::ShapeSizeWeighted:
      return work(ShapeSizeWeighted());
    case Metric::ShapeSizeLogarithm:
      return work(ShapeSizeLogarithm());
    case Metric::SizeNonBarrier:
      return work(SizeNonBarrier());
    case Metric::SizeBarrier:
      return work(SizeBarrier());
    case Metric::SizeBarrierSquared:
      return work(SizeBarrierSquared());
    case Metric::SizeUntangle:
      return work(SizeUntangle());
    case Metric::ShapeOrientation:
      return work(ShapeOrientation());
    case Metric::ShapeOrientationBarrier:
      return work(ShapeOrientationBarrier());
    case Metric::ShapeSizeOrientation:
      return work(ShapeSizeOrientation());
    case Metric::ShapeSizeOrientationBarrier:
      return work(ShapeSizeOrientationBarrier());
    default:
      return {};
  }
}
}
#endif
