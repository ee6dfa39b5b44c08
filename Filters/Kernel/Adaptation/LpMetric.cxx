// SPDX-License-Identifier: BSD-3-Clause
#include "LpMetric.h"

#include "MetricFields.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/VectorAlgebra.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Eigenvalues are at least this fraction of the largest one of the field.
constexpr double leastOfField = 1e-12;

/// The largest absolute value.
double magnitudeOf(const std::vector<double>& values)
{
  double largest = 0.0;
  for (const double value : values)
  {
    largest = std::max(largest, std::abs(value));
  }
  return largest;
}

/// |H| of one component; zero where it is rounding.
std::vector<MetricTensor> magnitudesOf(const AdaptationMesh& mesh,
  const std::vector<double>& values, HessianRecovery recovery, double precision, double ratio)
{
  std::vector<MetricTensor> result = recoverHessians(mesh, values, recovery);
  const std::vector<double> noise = hessianNoise(mesh, values, precision);
  parallelFor(mesh.numberOfPoints(), ChunkSize, mesh.threads(),
    [&](Index p)
    {
      MetricTensor& m = result[p];
      // The absolute values of the eigenvalues turn an indefinite Hessian into a metric.
      m = functionOf(m, [](double value) { return std::abs(value); });
      const double largest = principalAxes(m).values[2];
      if (!(largest > noise[p]) || !std::isfinite(largest))
      {
        m = {};
        return;
      }
      m = mesh.dimension() == 2 ? flattened(m, mesh.normals()[p]) : m;
      m = limited(m, { 0.0, std::numeric_limits<double>::infinity(), ratio });
    });
  return result;
}
}

//------------------------------------------------------------------------------
HessianMagnitudes hessianMagnitudes(const AdaptationMesh& mesh, const std::vector<double>& values,
  int components, HessianRecovery recovery, double precision, double ratio)
{
  HessianMagnitudes result;
  const double magnitude = magnitudeOf(values);
  // Relative to the largest value, the Hessians of fields of any size stay in range.
  result.unit = magnitude > 0.0 ? magnitude : 1.0;
  const auto count = static_cast<std::size_t>(mesh.numberOfPoints());
  for (int c = 0; c < components; ++c)
  {
    std::vector<double> own(count);
    for (std::size_t p = 0; p < count; ++p)
    {
      own[p] = values[components * p + c] / result.unit;
    }
    const std::vector<MetricTensor> next = magnitudesOf(mesh, own, recovery, precision, ratio);
    result.tensors.resize(count, MetricTensor{});
    for (std::size_t p = 0; p < count; ++p)
    {
      pollInterruption(static_cast<Index>(p));
      MetricTensor& m = result.tensors[p];
      // A zero tensor means no information, so it does not take part in the intersection.
      const bool both = next[p] != MetricTensor{} && m != MetricTensor{};
      m = both ? intersection(m, next[p]) : m == MetricTensor{} ? next[p] : m;
    }
  }
  double largest = 0.0;
  for (const MetricTensor& m : result.tensors)
  {
    largest = std::max({ largest, m[0], m[1], m[2] });
  }
  result.vanish = !(largest > 0.0);
  if (result.vanish)
  {
    result.tensors.clear();
    return result;
  }
  // The largest size corresponds to the smallest eigenvalue allowed.
  const MetricLimits limits = { 0.0, 1.0 / std::sqrt(leastOfField * largest), ratio };
  limitMetrics(mesh, limits, result.tensors);
  return result;
}

//------------------------------------------------------------------------------
LpMetric::LpMetric(const AdaptationMesh& mesh, const std::vector<MetricTensor>& hessians,
  double norm, const MetricLimits& limits)
  : TheMesh(mesh)
  , Norm(norm)
  , Limits(limits)
  , Axes(hessians.size())
  , Determinants(hessians.size())
{
  // The optimal metric for the L^p norm is det(|H|)^(-1 / (2 p + d)) |H|, up to a factor.
  const double exponent = -1.0 / (2.0 * norm + mesh.dimension());
  parallelFor(mesh.numberOfPoints(), ChunkSize, mesh.threads(),
    [&](Index p)
    {
      MetricAxes& axes = this->Axes[p];
      axes = principalAxes(hessians[p]);
      this->Determinants[p] = metricDeterminant(axes.values, mesh.dimension());
      const double scale = std::pow(this->Determinants[p], exponent);
      for (double& value : axes.values)
      {
        value *= scale;
      }
    });
}

//------------------------------------------------------------------------------
std::vector<MetricTensor> LpMetric::at(double factor) const
{
  std::vector<MetricTensor> result(this->Axes.size());
  parallelFor(this->TheMesh.numberOfPoints(), ChunkSize, this->TheMesh.threads(),
    [&](Index p)
    {
      MetricAxes axes = this->Axes[p];
      for (double& value : axes.values)
      {
        value *= factor;
      }
      axes.values = limitedValues(axes.values, this->Limits);
      result[p] = tensorOf(axes);
    });
  return result;
}

//------------------------------------------------------------------------------
double LpMetric::integralAt(const std::vector<double>& weights, double factor) const
{
  const VectorAlgebra algebra(this->Axes.size(), this->TheMesh.threads());
  return algebra.sum(
    [&](Index p)
    {
      std::array<double, 3> values = this->Axes[p].values;
      for (double& value : values)
      {
        value *= factor;
      }
      values = limitedValues(values, this->Limits);
      return weights[p] * std::sqrt(metricDeterminant(values, this->TheMesh.dimension()));
    });
}

//------------------------------------------------------------------------------
double LpMetric::factorFor(const std::vector<double>& weights, double target) const
{
  // The integral grows with the factor: without size limits, as its power d / 2.
  constexpr double step = 16.0, precision = 1e-12;
  constexpr int maximumSteps = 64;
  double low = 1.0;
  const double first = this->integralAt(weights, low);
  low = std::pow(target / first, 2.0 / this->TheMesh.dimension());
  double high = low;
  // First bracket the factor in both directions, then bisect its logarithm.
  for (int i = 0; i<maximumSteps&& this->integralAt(weights, low)> target; ++i)
  {
    low /= step;
  }
  for (int i = 0; i < maximumSteps && this->integralAt(weights, high) < target; ++i)
  {
    high *= step;
  }
  while (high > (1.0 + precision) * low)
  {
    // The geometric mean; separate roots avoid overflow.
    const double middle = std::sqrt(low) * std::sqrt(high);
    if (!(middle > low) || !(middle < high))
    {
      break;
    }
    (this->integralAt(weights, middle) < target ? low : high) = middle;
  }
  return high;
}

//------------------------------------------------------------------------------
double LpMetric::factorForError(double error) const
{
  const int dimension = this->TheMesh.dimension();
  const bool largest = !(this->Norm < std::numeric_limits<double>::max());
  if (largest)
  {
    // The largest error of |x|^2 / 2 is half of the squared circumradius: 1/6 and 3/16 for ideal
    // elements with edges of length 1.
    return (dimension == 3 ? 3.0 / 16.0 : 1.0 / 6.0) / error;
  }
  // Per dimension, the mean interpolation error of |x|^2 / 2 over an ideal element with edges of
  // length 1.
  const double meanOfTrace = dimension == 3 ? 1.0 / 20.0 : 1.0 / 16.0;
  const double exponent = 1.0 / (2.0 + dimension / this->Norm);
  double sum = 0.0;
  for (std::size_t p = 0; p < this->Determinants.size(); ++p)
  {
    sum += this->TheMesh.volumes()[p] * std::pow(this->Determinants[p], exponent);
  }
  return meanOfTrace * dimension * std::pow(sum, 1.0 / this->Norm) / error;
}
}
