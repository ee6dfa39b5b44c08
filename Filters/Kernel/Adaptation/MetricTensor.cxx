// SPDX-License-Identifier: BSD-3-Clause
#include "MetricTensor.h"

#include "tautline/Elements/ElementPlacement.h"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace tautline
{
namespace
{
using Matrix = Eigen::Matrix3d;

Matrix matrixOf(const MetricTensor& m)
{
  Matrix matrix;
  matrix << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  return matrix;
}

MetricTensor tensorOfMatrix(const Matrix& m)
{
  return { m(0, 0), m(1, 1), m(2, 2), 0.5 * (m(0, 1) + m(1, 0)), 0.5 * (m(1, 2) + m(2, 1)),
    0.5 * (m(0, 2) + m(2, 0)) };
}
}

//------------------------------------------------------------------------------
double edgeLength(const Vec3& e, const MetricTensor& a, const MetricTensor& b)
{
  constexpr double nearlyEqual = 1e-4; // the next term of the series is its fourth power
  const double atA = std::sqrt(squaredLength(e, a)), atB = std::sqrt(squaredLength(e, b));
  const double mean = 0.5 * (atA + atB);
  // The logarithmic mean (a - b) / ln(a / b), as mean x / atanh(x) with x = |a - b| / (a + b): this
  // form is accurate for nearly equal lengths.
  const double x = mean > 0.0 ? std::abs(atA - atB) / (atA + atB) : 0.0;
  return mean * (x < nearlyEqual ? 1.0 - x * x / 3.0 : x / std::atanh(x));
}

//------------------------------------------------------------------------------
bool isPositiveDefinite(const MetricTensor& m)
{
  const double largest = std::max({ m[0], m[1], m[2] });
  MetricTensor s = m;
  for (double& entry : s)
  {
    entry /= largest; // products of extreme entries would overflow
  }
  // Sylvester's criterion.
  const double minor = s[0] * s[1] - s[3] * s[3];
  const double determinant =
    s[2] * minor - s[4] * (s[0] * s[4] - s[3] * s[5]) + s[5] * (s[3] * s[4] - s[1] * s[5]);
  return largest > 0.0 && std::isfinite(largest) && std::isfinite(determinant) && s[0] > 0.0 &&
    minor > 0.0 && determinant > 0.0;
}

//------------------------------------------------------------------------------
MetricAxes principalAxes(const MetricTensor& m)
{
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrixOf(m));
  MetricAxes result;
  for (int k = 0; k < 3; ++k)
  {
    result.values[k] = solver.eigenvalues()[k];
    const Eigen::Vector3d axis = solver.eigenvectors().col(k);
    result.axes[k] = { axis[0], axis[1], axis[2] };
  }
  return result;
}

//------------------------------------------------------------------------------
MetricTensor tensorOf(const MetricAxes& axes)
{
  MetricTensor m = {};
  for (int k = 0; k < 3; ++k)
  {
    const double v = axes.values[k];
    const Vec3& a = axes.axes[k];
    m[0] += v * a[0] * a[0];
    m[1] += v * a[1] * a[1];
    m[2] += v * a[2] * a[2];
    m[3] += v * a[0] * a[1];
    m[4] += v * a[1] * a[2];
    m[5] += v * a[0] * a[2];
  }
  return m;
}

//------------------------------------------------------------------------------
MetricTensor turned(const MetricTensor& m, const std::array<Vec3, 3>& axes)
{
  const auto product = [&](int i, int j)
  {
    const Vec3 &a = axes[i], &b = axes[j];
    return m[0] * a[0] * b[0] + m[1] * a[1] * b[1] + m[2] * a[2] * b[2] +
      m[3] * (a[0] * b[1] + a[1] * b[0]) + m[4] * (a[1] * b[2] + a[2] * b[1]) +
      m[5] * (a[0] * b[2] + a[2] * b[0]);
  };
  return { product(0, 0), product(1, 1), product(2, 2), product(0, 1), product(1, 2),
    product(0, 2) };
}

//------------------------------------------------------------------------------
MetricTensor intersection(const MetricTensor& a, const MetricTensor& b, double tolerance)
{
  // In the coordinates in which `a` is the identity, the axes of b are common to both.
  const Eigen::SelfAdjointEigenSolver<Matrix> ofA(matrixOf(a));
  const Matrix root = ofA.operatorSqrt();
  const Matrix inverse = ofA.operatorInverseSqrt();
  const Eigen::SelfAdjointEigenSolver<Matrix> ofB(inverse * matrixOf(b) * inverse);
  if (ofB.eigenvalues().maxCoeff() <= 1.0 + tolerance)
  {
    return a;
  }
  if (ofB.eigenvalues().minCoeff() >= 1.0)
  {
    return b;
  }
  // Along each common axis, the larger eigenvalue is the smaller size.
  const Matrix axes = root * ofB.eigenvectors();
  return tensorOfMatrix(axes * ofB.eigenvalues().cwiseMax(1.0).asDiagonal() * axes.transpose());
}

//------------------------------------------------------------------------------
MetricTensor logEuclideanMean(
  const std::vector<MetricTensor>& metrics, const std::vector<double>& weights)
{
  MetricTensor sum = {};
  double total = 0.0;
  // The log-Euclidean mean (V. Arsigny et al., 2006) is positive definite, and averages sizes
  // geometrically.
  for (std::size_t i = 0; i < metrics.size(); ++i)
  {
    const MetricTensor logarithm =
      functionOf(metrics[i], [](double value) { return std::log(value); });
    for (std::size_t k = 0; k < sum.size(); ++k)
    {
      sum[k] += weights[i] * logarithm[k];
    }
    total += weights[i];
  }
  return functionOf(sum, [total](double value) { return std::exp(value / total); });
}

//------------------------------------------------------------------------------
std::array<double, 3> limitedValues(std::array<double, 3> values, const MetricLimits& limits)
{
  const double low = 1.0 / (limits.largest * limits.largest);
  const double high = limits.smallest > 0.0 ? 1.0 / (limits.smallest * limits.smallest)
                                            : std::numeric_limits<double>::max();
  for (double& value : values)
  {
    value = std::min(std::max(value, low), high);
  }
  // The ratio is limited by reducing the large sizes, so that requested resolution is never lost.
  const double least = values[2] / (limits.ratio * limits.ratio);
  for (double& value : values)
  {
    value = std::max(value, least);
  }
  return values;
}

//------------------------------------------------------------------------------
MetricTensor limited(const MetricTensor& m, const MetricLimits& limits)
{
  MetricAxes axes = principalAxes(m);
  const std::array<double, 3> values = limitedValues(axes.values, limits);
  // A tensor within the limits is returned unchanged, without the rounding of its decomposition.
  if (values == axes.values)
  {
    return m;
  }
  axes.values = values;
  return tensorOf(axes);
}

//------------------------------------------------------------------------------
MetricTensor grownMetric(const MetricAxes& axes, const Vec3& e, double rate)
{
  // The exponents are 1/8 for the factor of each size, and 7/8 for the common factor.
  const auto eighthRoot = [](double x) { return std::sqrt(std::sqrt(std::sqrt(x))); };
  double length2 = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    const double along = dot(axes.axes[k], e);
    length2 += axes.values[k] * along * along;
  }
  const double common = 1.0 + rate * std::sqrt(length2), distance = rate * norm(e);
  const double alike = common / eighthRoot(common);
  MetricAxes grown = axes;
  for (double& value : grown.values)
  {
    const double factor = alike * eighthRoot(1.0 + distance * std::sqrt(value));
    value /= factor * factor;
  }
  return tensorOf(grown);
}

//------------------------------------------------------------------------------
MetricTensor flattened(const MetricTensor& m, const Vec3& normal)
{
  const auto [t1, t2] = frameOfPlane(normal);
  const std::array<Vec3, 3> axes = { t1, t2, normal };
  MetricTensor plane = turned(m, axes);
  // The smaller eigenvalue follows from the determinant: mean minus radius would cancel.
  const double mean = 0.5 * (plane[0] + plane[1]);
  const double larger = mean + std::hypot(0.5 * (plane[0] - plane[1]), plane[3]);
  const double determinant = plane[0] * plane[1] - plane[3] * plane[3];
  plane[2] = larger > 0.0 ? std::max(determinant, 0.0) / larger : 0.0;
  plane[4] = plane[5] = 0.0;
  // The transposed axes turn the tensor back.
  return turned(plane,
    { Vec3{ t1[0], t2[0], normal[0] }, Vec3{ t1[1], t2[1], normal[1] },
      Vec3{ t1[2], t2[2], normal[2] } });
}
}
