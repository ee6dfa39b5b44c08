// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleMetrics.h"

namespace tautline
{
namespace
{
/**
 * @brief A function of a tensor in the xy plane: f(M) = c I + d (M - m I) with the mean m of the
 * eigenvalues, half the sum c and the divided difference d of f at them.
 */
template <class Function>
MetricTensor planeFunction(const MetricTensor& t, const Function& f)
{
  const double mean = 0.5 * (t[0] + t[1]), difference = 0.5 * (t[0] - t[1]);
  const double radius = std::hypot(difference, t[3]);
  const auto [middle, slope] = f(mean, radius, t);
  return { middle + slope * difference, middle - slope * difference, 0.0, slope * t[3], 0.0, 0.0 };
}

MetricTensor planeLogarithm(const MetricTensor& m)
{
  return planeFunction(m,
    [](double mean, double radius, const MetricTensor& t)
    {
      const double large = mean + radius;
      // Use the determinant: mean - radius would lose digits.
      const double small = (t[0] * t[1] - t[3] * t[3]) / large;
      const double a = std::log(large), b = std::log(small);
      return std::array<double, 2>{ 0.5 * (a + b), radius > 0.0 ? 0.5 * (a - b) / radius : 0.0 };
    });
}

MetricTensor planeExponential(const MetricTensor& l)
{
  return planeFunction(l,
    [](double mean, double radius, const MetricTensor&)
    {
      const double e = std::exp(mean);
      return std::array<double, 2>{ e * std::cosh(radius),
        radius > 0.0 ? e * std::sinh(radius) / radius : 0.0 };
    });
}
}

TriangleMetrics::TriangleMetrics(const TriangleMesh& mesh, const TriangleInput& input)
  : Input(input)
  , Locator(mesh, input)
{
  this->Logarithms.reserve(input.metrics.size());
  for (const MetricTensor& metric : input.metrics)
  {
    this->Logarithms.push_back(input.planar
        ? planeLogarithm(metric)
        : functionOf(metric, [](double value) { return std::log(value); }));
  }
}

PointMetric TriangleMetrics::at(const Vec3& x, TriId start) const
{
  TrianglePlace place;
  PointMetric result;
  result.place = this->Locator.walk(x, start, place);
  MetricTensor mean = {};
  for (int k = 0; k < 3; ++k)
  {
    const MetricTensor& logarithm = this->Logarithms[this->Input.cells[result.place][k]];
    for (std::size_t i = 0; i < mean.size(); ++i)
    {
      mean[i] += place.weights[k] * logarithm[i];
    }
  }
  result.tensor = this->Input.planar
    ? planeExponential(mean)
    : functionOf(mean, [](double value) { return std::exp(value); });
  return result;
}

TriId TriangleMetrics::locate(const Vec3& x, TriId start) const
{
  TrianglePlace place;
  return this->Locator.walk(x, start, place);
}
}
