// SPDX-License-Identifier: BSD-3-Clause
#include "QuadraticFit.h"

#include "tautline/Elements/ElementPlacement.h"

#include <Eigen/QR>

#include <algorithm>

namespace tautline
{
namespace
{
/// Directions in which the neighbors extend less than this, relative to the longest, are ignored.
constexpr double flattestSpread = 1e-6;
constexpr double rankTolerance = 1e-8;

/// Coordinates x . rows[k] in which the point and its neighbors extend equally far.
std::vector<Vec3> evenDirections(int dimension, const std::vector<Vec3>& offsets)
{
  const double share = 1.0 / (static_cast<double>(offsets.size()) + 1.0);
  Vec3 mean = { 0, 0, 0 };
  for (const Vec3& x : offsets)
  {
    mean += share * x;
  }
  MetricTensor spread = {};
  const auto add = [&spread, share](const Vec3& x)
  {
    const MetricTensor square = { x[0] * x[0], x[1] * x[1], x[2] * x[2], x[0] * x[1], x[1] * x[2],
      x[0] * x[2] };
    for (std::size_t k = 0; k < spread.size(); ++k)
    {
      spread[k] += share * square[k];
    }
  };
  // The point itself is the origin, at the offset -mean from the mean.
  add(mean);
  for (const Vec3& x : offsets)
  {
    add(x - mean);
  }
  if (dimension == 2)
  {
    spread[2] = 2.0 * (spread[0] + spread[1]); // z is the last axis
  }
  const MetricAxes axes = principalAxes(spread);
  const double limit = flattestSpread * flattestSpread * axes.values[dimension - 1];
  std::vector<Vec3> rows;
  for (int k = 0; k < dimension; ++k)
  {
    if (axes.values[k] > limit)
    {
      rows.push_back((1.0 / std::sqrt(axes.values[k])) * axes.axes[k]);
    }
  }
  return rows;
}

/// Adds the next ring of neighbors to points in increasing order.
void growRing(const AdaptationMesh& mesh, Index point, std::vector<Index>& found)
{
  const std::vector<Index> front = found;
  for (const Index p : front)
  {
    const AdaptationMesh::List next = mesh.neighbors(p);
    found.insert(found.end(), next.begin(), next.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  found.erase(std::remove(found.begin(), found.end(), point), found.end());
}
}

//------------------------------------------------------------------------------
QuadraticFit fitQuadratic(
  int dimension, const std::vector<Vec3>& offsets, const std::vector<double>& values)
{
  QuadraticFit fit;
  fit.rank = 0;
  const std::vector<Vec3> rows =
    offsets.empty() ? std::vector<Vec3>() : evenDirections(dimension, offsets);
  const int directions = static_cast<int>(rows.size());
  if (directions == 0)
  {
    return fit;
  }
  const auto count = static_cast<Eigen::Index>(offsets.size());
  Eigen::MatrixXd linear(count, directions);
  Eigen::MatrixXd quadratic(count, unknownsOf(directions) - directions);
  Eigen::VectorXd right(count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    std::array<double, 3> y = { 0, 0, 0 };
    double length2 = 0.0;
    for (int k = 0; k < directions; ++k)
    {
      y[k] = dot(rows[k], offsets[i]);
      length2 += y[k] * y[k];
    }
    // Weights decrease with the distance, because third derivatives disturb far neighbors most.
    const double weight = length2 > 0.0 ? 1.0 / std::sqrt(length2) : 0.0;
    int column = 0;
    for (int k = 0; k < directions; ++k)
    {
      linear(i, k) = weight * y[k];
      for (int l = k; l < directions; ++l)
      {
        quadratic(i, column++) = (k == l ? 0.5 : 1.0) * weight * y[k] * y[l];
      }
    }
    right[i] = weight * values[i];
  }

  // If several second derivatives fit equally well, the smallest are taken: in a single layer of
  // cells, the transverse ones are 0. The gradient follows from them.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> first(linear);
  // Below the triangular factor of the linear terms, the rows contain second derivatives only.
  const Eigen::MatrixXd left = first.householderQ().adjoint() * quadratic;
  const Eigen::VectorXd rotated = first.householderQ().adjoint() * right;
  const Eigen::Index more = std::max<Eigen::Index>(count - directions, 0);
  Eigen::VectorXd second = Eigen::VectorXd::Zero(quadratic.cols());
  fit.rank = static_cast<int>(first.rank());
  if (more > 0)
  {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
    factors.setThreshold(rankTolerance);
    factors.compute(left.bottomRows(more));
    second = factors.solve(rotated.tail(more));
    fit.rank += static_cast<int>(factors.rank());
  }
  const Eigen::VectorXd slope = first.solve(right - quadratic * second);
  fit.determined = directions == dimension && fit.rank == unknownsOf(dimension);

  int column = 0;
  for (int k = 0; k < directions; ++k)
  {
    const Vec3& a = rows[k];
    fit.gradient += slope[k] * a;
    for (int l = k; l < directions; ++l)
    {
      const Vec3& b = rows[l];
      const double s = (k == l ? 0.5 : 1.0) * second[column++];
      constexpr int firsts[] = { 0, 1, 2, 0, 1, 0 }, seconds[] = { 0, 1, 2, 1, 2, 2 };
      for (std::size_t c = 0; c < fit.hessian.size(); ++c)
      {
        fit.hessian[c] += s * (a[firsts[c]] * b[seconds[c]] + a[seconds[c]] * b[firsts[c]]);
      }
    }
  }
  return fit;
}

//------------------------------------------------------------------------------
QuadraticFit fitField(const AdaptationMesh& mesh, Index point, const std::vector<double>& values)
{
  const int dimension = mesh.dimension();
  std::array<Vec3, 3> axes = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
  if (dimension == 2)
  {
    const auto [t1, t2] = frameOfPlane(mesh.normals()[point]);
    axes = { t1, t2, mesh.normals()[point] };
  }
  const AdaptationMesh::List ring = mesh.neighbors(point);
  QuadraticFit fit = fitRings(
    { ring.begin(), ring.end() }, static_cast<std::size_t>(unknownsOf(dimension)) + 1,
    [&](std::vector<Index>& found) { growRing(mesh, point, found); },
    [&](const std::vector<Index>& found)
    {
      std::vector<Vec3> offsets;
      std::vector<double> differences;
      for (const Index p : found)
      {
        const Vec3 e = mesh.point(p) - mesh.point(point);
        offsets.push_back(
          { dot(axes[0], e), dot(axes[1], e), dimension == 2 ? 0.0 : dot(axes[2], e) });
        differences.push_back(values[p] - values[point]);
      }
      return fitQuadratic(dimension, offsets, differences);
    });
  const Vec3 g = fit.gradient;
  fit.gradient = g[0] * axes[0] + g[1] * axes[1] + g[2] * axes[2];
  fit.hessian = outOf(fit.hessian, axes);
  return fit;
}

//------------------------------------------------------------------------------
MetricTensor outOf(const MetricTensor& m, const std::array<Vec3, 3>& axes)
{
  const auto column = [&](int k) { return Vec3{ axes[0][k], axes[1][k], axes[2][k] }; };
  return turned(m, { column(0), column(1), column(2) });
}
}
