// SPDX-License-Identifier: BSD-3-Clause
#include "MetricGroups.h"

#include "tautline/Quality/Metrics.h"

#include <algorithm>

namespace tautline
{
namespace
{
using M = Metric;

struct Purpose
{
  const char* title;
  const char* text;
  std::vector<Metric> metrics;
};

/// All built-in metrics, except the metrics of finite volumes.
const std::vector<Purpose>& purposes()
{
  static const std::vector<Purpose> all = {
    { "Shape", "How far the element is from the ideal one, whatever its size.",
      { M::InverseMeanRatio, M::MeanRatio, M::RadiusRatio, M::NormalizedRadiusRatio,
        M::ConditionNumber, M::EdgeRatio, M::AspectRatio, M::WidthRatio } },
    { "Angles", "The angles of the element, in volumes dihedral angles.",
      { M::MinimumAngle, M::MaximumAngle, M::EquiangleSkew } },
    { "Validity", "Whether the element is valid: its Jacobian determinant.",
      { M::ScaledJacobian, M::MinimumJacobian, M::UntangleBeta } },
    { "Size", "The area or volume of the element.", { M::Size } },
    { "Solver", "The condition number of the stiffness matrix and the error of interpolation.",
      { M::ConditioningScaleInvariant, M::ConditioningSizeShape, M::InterpolationScaleInvariant,
        M::InterpolationSizeShape } },
    { "Target, shape", "The shape, compared with a target element.",
      { M::ShapeSimilarity, M::ShapeBarrier, M::ShapeNonBarrier, M::ShapeCondition,
        M::ShapeConditionSquared, M::ShapeSquared, M::ShapeProduct, M::ShapeCubic } },
    { "Target, size", "The size, compared with a target element.",
      { M::SizeBarrier, M::SizeNonBarrier, M::SizeBarrierSquared, M::SizeUntangle } },
    { "Target, shape and size", "The shape and the size, compared with a target element.",
      { M::ShapeSizeBarrier, M::ShapeSizeAdjugate, M::ShapeSizeWeighted, M::ShapeSizeLogarithm } },
    { "Target, with orientation", "The orientation in space, compared with a target element.",
      { M::ShapeOrientationBarrier, M::ShapeOrientation, M::ShapeSizeOrientationBarrier,
        M::ShapeSizeOrientation } },
  };
  return all;
}

bool isOfFaces(int metric)
{
  return metric >= 0 && metric < numberOfBuiltInMetrics() &&
    metricInfo(static_cast<Metric>(metric)).family == MetricFamily::Faces;
}
}

//------------------------------------------------------------------------------
std::vector<MetricGroup> groupMetrics(const std::vector<int>& metrics)
{
  std::vector<int> left = metrics;
  std::vector<MetricGroup> groups;
  const auto take = [&left](int metric)
  {
    const auto found = std::find(left.begin(), left.end(), metric);
    const bool present = found != left.end();
    if (present)
    {
      left.erase(found);
    }
    return present;
  };
  const auto append = [&groups](const char* title, const char* text, const std::vector<int>& some)
  {
    if (!some.empty())
    {
      groups.push_back({ title, text, some });
    }
  };
  for (const Purpose& purpose : purposes())
  {
    std::vector<int> some;
    for (const Metric metric : purpose.metrics)
    {
      if (take(static_cast<int>(metric)))
      {
        some.push_back(static_cast<int>(metric));
      }
    }
    append(purpose.title, purpose.text, some);
  }
  const auto faces =
    std::stable_partition(left.begin(), left.end(), [](int metric) { return isOfFaces(metric); });
  append("Finite volumes", "The faces of a cell and the cells across them, as OpenFOAM has them.",
    { left.begin(), faces });
  append(
    "Registered", "Metrics that were registered by a library or by Python.", { faces, left.end() });
  return groups;
}

} // namespace tautline
