// SPDX-License-Identifier: BSD-3-Clause
#include "DistanceMetric.h"

#include "FieldDerivatives.h"
#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/FacetTable.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
constexpr Index pointsPerSearch = 256; // in a chunk
/// The gradient of a distance has length 1; a shorter gradient is a mean of several directions.
constexpr double clearGradient = 0.5;

/// The walls as triangles, or as edges with the last corner twice.
SurfacePart wallsOf(const AdaptationMesh& mesh, const std::vector<unsigned char>& marks)
{
  SurfacePart part;
  part.curve = mesh.dimension() == 2;
  FacetTable facets(mesh.mesh());
  facets.forEachFacet(
    [&](Index first, const FacetUse* uses, Index count)
    {
      // In cyclic order around the facet: the first point, its neighbor, the opposite point (of
      // quadrilaterals), the other neighbor.
      const auto& others = uses->others;
      const std::array<Index, MaxFaceNodes> nodes = { first, others[0],
        others[2] >= 0 ? others[2] : others[1], others[2] >= 0 ? others[1] : -1 };
      const auto isWall = [&](Index p) { return p < 0 || marks.empty() || marks[p]; };
      if (count != 1 || !std::all_of(nodes.begin(), nodes.end(), isWall))
      {
        return;
      }
      const auto at = [&](int k) { return mesh.point(nodes[k]); };
      part.pieces.push_back({ at(0), at(1), nodes[2] < 0 ? at(1) : at(2) });
      if (nodes[3] >= 0)
      {
        part.pieces.push_back({ at(0), at(2), at(3) });
      }
    });
  return part;
}
}

//------------------------------------------------------------------------------
std::vector<double> wallDistances(
  const AdaptationMesh& mesh, const std::vector<unsigned char>& marks)
{
  const SurfacePart walls = wallsOf(mesh, marks);
  if (walls.pieces.empty())
  {
    throw Error(marks.empty()
        ? "The mesh is closed and has no boundary to measure the distance from: choose an array "
          "with the distance."
        : "No boundary facet has all its points marked as wall: mark the points of whole "
          "facets.");
  }
  const SurfaceProjection projection(walls, nullptr);
  std::vector<double> result(mesh.numberOfPoints());
  parallelFor(mesh.numberOfPoints(), pointsPerSearch, mesh.threads(),
    [&](Index p)
    {
      std::int32_t piece = 0;
      result[p] =
        projection.distanceOf(mesh.point(p), 0.0, std::numeric_limits<double>::infinity(), piece);
    });
  return result;
}

//------------------------------------------------------------------------------
std::vector<MetricTensor> distanceMetrics(
  const AdaptationMesh& mesh, const std::vector<double>& distances, const LayerSizes& sizes)
{
  // Signed distances are symmetric: sizes grow on both sides of a wall.
  std::vector<double> absolute(distances.size());
  std::transform(distances.begin(), distances.end(), absolute.begin(),
    [](double distance) { return std::abs(distance); });
  const std::vector<Vec3> gradients = recoverGradients(mesh, absolute);
  std::vector<MetricTensor> result(absolute.size());
  parallelFor(mesh.numberOfPoints(), ChunkSize, mesh.threads(),
    [&](Index p)
    {
      // In layers with the ratio g between successive sizes, the size at the distance d is first +
      // (g - 1) d.
      const double across = sizes.first + (sizes.growth - 1.0) * absolute[p];
      const double along = std::max(sizes.ratio * sizes.first, across);
      const double length = norm(gradients[p]);
      // The metric is I / along^2 + (1 / across^2 - 1 / along^2) d d^T, with the direction d of the
      // distance.
      const double difference = 1.0 / (across * across) - 1.0 / (along * along);
      if (!(length > clearGradient) || !(difference > 0.0))
      {
        result[p] = isotropicMetric(across);
        return;
      }
      const Vec3 d = (1.0 / length) * gradients[p];
      MetricTensor m = isotropicMetric(along);
      const MetricTensor square = { d[0] * d[0], d[1] * d[1], d[2] * d[2], d[0] * d[1], d[1] * d[2],
        d[0] * d[2] };
      for (std::size_t k = 0; k < m.size(); ++k)
      {
        m[k] += difference * square[k];
      }
      result[p] = m;
    });
  return result;
}
}
