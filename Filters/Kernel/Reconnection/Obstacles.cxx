// SPDX-License-Identifier: BSD-3-Clause
#include "Obstacles.h"

#include "FacetBound.h"
#include "ReconnectionInput.h"
#include "tautline/Core/Interruption.h"

namespace tautline
{
namespace
{
/// A tetrahedron this close to its bound is at it: the bounds of facets are about as accurate.
constexpr double NearBound = 2e-3;

/// The points on walls, and the bounds forced by all walls.
struct Walls
{
  std::vector<char> atSurface, atInterface; ///< one flag per point
  double meanRatio = 1, quality = 1;
};

/// Whether face i is a wall, except toward the surroundings of a part of a mesh.
bool isOwnWall(const TetrahedronMesh& mesh, TetId t, int i)
{
  const std::int32_t n = mesh.tet(t).neighbors[i];
  return mesh.isWall(t, i) && (n == NoId || mesh.region(n >> 2) != OutsideRegion);
}

Walls findWalls(const TetrahedronMesh& mesh, const TetrahedronPasses& passes)
{
  Walls walls;
  walls.atSurface.assign(mesh.pointSlots(), 0);
  walls.atInterface = walls.atSurface;
  StarSmoothing smoothing;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    pollInterruption(static_cast<Index>(t));
    const bool own = mesh.alive(t) && mesh.region(t) != OutsideRegion;
    for (int i = 0; i < 4 && own; ++i)
    {
      if (!isOwnWall(mesh, t, i))
      {
        continue;
      }
      const TriangleVertices f = mesh.face(t, i);
      const bool outer = mesh.tet(t).neighbors[i] == NoId;
      for (PointId v : f)
      {
        (outer ? walls.atSurface : walls.atInterface)[v] = 1;
      }
      const Vec3 &a = mesh.point(f[0]), &b = mesh.point(f[1]), &c = mesh.point(f[2]);
      const double meanRatio = facetMeanRatio(a, b, c);
      walls.meanRatio = std::min(walls.meanRatio, meanRatio);
      if (mesh.weights().inMetric)
      {
        continue;
      }
      // Only a facet whose tetrahedron is this bad can force a worse bound.
      if (mesh.quality(t) < walls.quality)
      {
        walls.quality = std::min(walls.quality, facetQuality(a, b, c, mesh.weights(), smoothing));
      }
    }
    if (own && !mesh.weights().inMetric)
    {
      walls.quality = std::min(walls.quality, passes.bound(t));
    }
  }
  return walls;
}

/// The bound of a tetrahedron for each of its walls, and for all of them.
double boundOf(
  const TetrahedronMesh& mesh, const TetrahedronPasses& passes, TetId t, StarSmoothing& smoothing)
{
  double bound = passes.bound(t);
  for (int i = 0; i < 4; ++i)
  {
    if (isOwnWall(mesh, t, i))
    {
      const TriangleVertices f = mesh.face(t, i);
      bound = std::min(bound,
        facetQuality(
          mesh.point(f[0]), mesh.point(f[1]), mesh.point(f[2]), mesh.weights(), smoothing));
    }
  }
  // Bounds below the quality that was reached are inaccurate.
  return std::max(bound, mesh.quality(t));
}
}

void findObstacles(const TetrahedronMesh& mesh, const TetrahedronPasses& passes,
  const ReconnectionOptions& options, const std::vector<char>& fixedPoints,
  ReconnectionResult& result)
{
  const double target = targetQuality(options);
  const Walls walls = findWalls(mesh, passes);
  result.forcedQuality = walls.quality;
  result.forcedInverseMeanRatio = std::pow(walls.meanRatio, -2.0 / 3.0);
  StarSmoothing smoothing;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    pollInterruption(static_cast<Index>(t));
    if (!mesh.alive(t))
    {
      continue;
    }
    const TetVertices& v = mesh.tet(t).vertices;
    const auto any = [&](const std::vector<char>& flags)
    {
      return std::any_of(v.begin(), v.end(),
        [&](PointId p) { return p < static_cast<PointId>(flags.size()) && flags[p]; });
    };
    using Obstacle = ReconnectionObstacle;
    Obstacle obstacle = Obstacle::None;
    const double quality = mesh.quality(t);
    double bound = 1.0;
    if (quality < target)
    {
      // No bound is known in a metric.
      bound = options.adapt ? 1.0 : boundOf(mesh, passes, t, smoothing);
      // The first reason that applies, in the order of their strength.
      obstacle = bound <= quality * (1.0 + NearBound) ? Obstacle::Facets
        : any(fixedPoints)                            ? Obstacle::FixedPoints
        : any(walls.atInterface)                      ? Obstacle::Interface
        : any(walls.atSurface)                        ? Obstacle::Surface
                                                      : Obstacle::Limit;
    }
    result.obstacles.push_back(static_cast<signed char>(obstacle));
    result.qualities.push_back(quality);
    result.bounds.push_back(bound);
  }
}
}
