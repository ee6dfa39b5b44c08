// SPDX-License-Identifier: BSD-3-Clause
#include "FieldDerivatives.h"

#include "QuadraticFit.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/BoundaryPoints.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
constexpr Index pointsPerChunk = 256; // of fits, which take microseconds each

/// The gradients of the functions that are 1 at one corner of a simplex and 0 at the others, for
/// all corners except the first; false if the simplex has no volume.
bool shapeGradients(const Vec3* p, int dimension, std::array<Vec3, 3>& gradients)
{
  const Vec3 a = p[1] - p[0], b = p[2] - p[0];
  const Vec3 n = cross(a, b);
  if (dimension == 2)
  {
    // With n = a x b, a . (b x n) = |n|^2, and both vectors lie in the plane of the triangle.
    const double square = dot(n, n);
    gradients = { (1.0 / square) * cross(b, n), (1.0 / square) * cross(n, a), Vec3{ 0, 0, 0 } };
    return square > 0.0 && std::isfinite(1.0 / square);
  }
  const Vec3 c = p[3] - p[0];
  const double volume = dot(n, c);
  gradients = { (1.0 / volume) * cross(b, c), (1.0 / volume) * cross(c, a), (1.0 / volume) * n };
  return volume != 0.0 && std::isfinite(1.0 / volume);
}

/**
 * Per point the mean of the gradients of the simplices around it, weighted by volume, in the
 * tangent plane of a surface.
 */
template <class Value>
std::vector<Vec3> projectedGradients(const AdaptationMesh& mesh, const Value& value)
{
  const MeshView& view = mesh.mesh().view();
  const int dimension = mesh.dimension();
  std::vector<Vec3> result(view.numberOfPoints);
  parallelFor(view.numberOfPoints, pointsPerChunk, mesh.threads(),
    [&](Index p)
    {
      Vec3 sum = { 0, 0, 0 };
      double total = 0.0;
      for (const Index cell : mesh.elements(p))
      {
        const Index* node = view.connectivity + view.offsets[cell];
        std::array<Vec3, 4> corners;
        std::array<Vec3, 3> gradients;
        for (int k = 0; k <= dimension; ++k)
        {
          corners[k] = pointOf(view, node[k]);
        }
        if (!shapeGradients(corners.data(), dimension, gradients))
        {
          continue;
        }
        const double size = mesh.sizes()[cell];
        for (int k = 0; k < dimension; ++k)
        {
          sum += (size * (value(node[k + 1]) - value(node[0]))) * gradients[k];
        }
        total += size;
      }
      sum = total > 0.0 ? (1.0 / total) * sum : sum;
      const Vec3 normal = dimension == 2 ? mesh.normals()[p] : Vec3{ 0, 0, 0 };
      result[p] = sum - dot(sum, normal) * normal;
    });
  return result;
}

/**
 * Replaces the one-sided gradients at the boundary and next to it by the mean of the neighboring
 * points, from the inside outwards.
 */
void extendToBoundary(const AdaptationMesh& mesh, std::vector<MetricTensor>& hessians)
{
  const std::vector<char> boundary = boundaryPoints(mesh.mesh(), mesh.threads());
  std::vector<unsigned char> known(boundary.size(), 0);
  for (const bool strict : { true, false })
  {
    for (Index p = 0; p < mesh.numberOfPoints(); ++p)
    {
      pollInterruption(p);
      const AdaptationMesh::List near = mesh.neighbors(p);
      known[p] = !boundary[p] &&
        !(strict && std::any_of(near.begin(), near.end(), [&](Index q) { return boundary[q]; }));
    }
    if (std::count(known.begin(), known.end(), 1) > 0)
    {
      break; // otherwise all interior points are next to the boundary
    }
  }
  std::vector<Index> left;
  for (Index p = 0; p < mesh.numberOfPoints(); ++p)
  {
    if (!known[p])
    {
      left.push_back(p);
    }
  }
  // Points that cannot be reached from a known one keep their tensors.
  for (std::size_t before = left.size() + 1; !left.empty() && left.size() < before;)
  {
    before = left.size();
    std::vector<Index> reached, later;
    for (const Index p : left)
    {
      pollInterruption(p);
      MetricTensor sum = {};
      int count = 0;
      for (const Index q : mesh.neighbors(p))
      {
        for (std::size_t k = 0; known[q] && k < sum.size(); ++k)
        {
          sum[k] += hessians[q][k];
        }
        count += known[q];
      }
      for (std::size_t k = 0; count > 0 && k < sum.size(); ++k)
      {
        hessians[p][k] = sum[k] / count;
      }
      (count > 0 ? reached : later).push_back(p);
    }
    // Points become known only after the round, so that their order does not matter.
    for (const Index p : reached)
    {
      known[p] = 1;
    }
    left = std::move(later);
  }
}

std::vector<MetricTensor> projectedHessians(
  const AdaptationMesh& mesh, const std::vector<double>& values)
{
  Index others = 0;
  for (const CellBlock& block : mesh.mesh().blocks())
  {
    const bool simplex = block.type == CellType::Triangle || block.type == CellType::Tetrahedron;
    others += simplex ? 0 : block.count;
  }
  if (others > 0)
  {
    throw Error("The double projection supports only triangles and tetrahedra, but " +
      std::to_string(others) +
      " elements have other types: choose the quadratic fit, or run Tetrahedralize first.");
  }
  const std::vector<Vec3> gradients = projectedGradients(mesh, [&](Index p) { return values[p]; });
  std::array<std::vector<Vec3>, 3> rows;
  for (int c = 0; c < 3; ++c)
  {
    rows[c] = projectedGradients(mesh, [&](Index p) { return gradients[p][c]; });
  }
  std::vector<MetricTensor> result(gradients.size());
  for (std::size_t p = 0; p < result.size(); ++p)
  {
    // The rows are recovered independently, so the matrix is symmetrized.
    const auto mean = [&](int i, int j) { return 0.5 * (rows[i][p][j] + rows[j][p][i]); };
    result[p] = { mean(0, 0), mean(1, 1), mean(2, 2), mean(0, 1), mean(1, 2), mean(0, 2) };
    if (mesh.dimension() == 2)
    {
      // P H P with the projector P to the tangent plane.
      const Vec3& n = mesh.normals()[p];
      const auto row = [&n](int i) {
        return Vec3{ (i == 0) - n[i] * n[0], (i == 1) - n[i] * n[1], (i == 2) - n[i] * n[2] };
      };
      result[p] = turned(result[p], { row(0), row(1), row(2) });
    }
  }
  extendToBoundary(mesh, result);
  return result;
}
}

//------------------------------------------------------------------------------
std::vector<Vec3> recoverGradients(const AdaptationMesh& mesh, const std::vector<double>& values)
{
  std::vector<Vec3> result(values.size());
  parallelFor(mesh.numberOfPoints(), pointsPerChunk, mesh.threads(),
    [&](Index p) { result[p] = fitField(mesh, p, values).gradient; });
  return result;
}

//------------------------------------------------------------------------------
std::vector<MetricTensor> recoverHessians(
  const AdaptationMesh& mesh, const std::vector<double>& values, HessianRecovery recovery)
{
  if (recovery == HessianRecovery::DoubleProjection)
  {
    return projectedHessians(mesh, values);
  }
  std::vector<MetricTensor> result(values.size());
  parallelFor(mesh.numberOfPoints(), pointsPerChunk, mesh.threads(),
    [&](Index p) { result[p] = fitField(mesh, p, values).hessian; });
  return result;
}

//------------------------------------------------------------------------------
std::vector<double> hessianNoise(
  const AdaptationMesh& mesh, const std::vector<double>& values, double precision)
{
  // A second difference of four rounded values, and the sums of a fit.
  constexpr double roundings = 32.0;
  double largest = 0.0;
  for (const double value : values)
  {
    largest = std::max(largest, std::abs(value));
  }
  std::vector<double> result(values.size());
  parallelFor(mesh.numberOfPoints(), ChunkSize, mesh.threads(),
    [&](Index p)
    {
      // Second differences amplify rounding by 1 / h^2, most along the shortest edge.
      double shortest = std::numeric_limits<double>::infinity();
      for (const Index q : mesh.neighbors(p))
      {
        shortest = std::min(shortest, norm(mesh.point(q) - mesh.point(p)));
      }
      result[p] = largest > 0.0 ? roundings * precision * largest / (shortest * shortest) : 0.0;
    });
  return result;
}
}
