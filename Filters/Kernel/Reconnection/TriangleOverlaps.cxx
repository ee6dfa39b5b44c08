// SPDX-License-Identifier: BSD-3-Clause Areas of the intersections of output and input triangles.
#include "Constants.h"
#include "ReconnectionOutput.h"
#include "TriangleInput.h"

#include "tautline/Core/Parallel.h"

#include <unordered_set>

namespace tautline
{
namespace
{
constexpr Index TrianglesPerChunk = 1024;

/// A triangle in the plane of another one.
using PlanarTriangle = std::array<Vec2, 3>;

double areaOf(const std::vector<Vec2>& polygon)
{
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
  {
    const Vec2 u = polygon[i] - polygon[0], v = polygon[i + 1] - polygon[0];
    sum += u[0] * v[1] - u[1] * v[0];
  }
  return 0.5 * sum;
}

/// The common area of two positive triangles: one is cut along the edges of the other.
double sharedArea(const PlanarTriangle& x, const PlanarTriangle& y)
{
  std::vector<Vec2> polygon(x.begin(), x.end()), rest;
  for (int i = 0; i < 3 && !polygon.empty(); ++i)
  {
    const Vec2 a = y[i], e = y[Next[i]] - a;
    const auto side = [&](const Vec2& p) { return e[0] * (p[1] - a[1]) - e[1] * (p[0] - a[0]); };
    rest.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k)
    {
      const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      const double from = side(p), to = side(q);
      if (from >= 0.0)
      {
        rest.push_back(p);
      }
      if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0))
      {
        rest.push_back(p + (from / (from - to)) * (q - p));
      }
    }
    polygon.swap(rest);
  }
  return areaOf(polygon);
}

/// The directions of the plane of a triangle.
struct Frame
{
  Vec3 origin, first, second, normal;

  Frame(const std::array<Vec3, 3>& x)
    : origin(x[0])
    , first((1.0 / norm(x[1] - x[0])) * (x[1] - x[0]))
  {
    const Vec3 n = cross(this->first, x[2] - x[0]);
    this->normal = (1.0 / norm(n)) * n;
    this->second = cross(this->normal, this->first);
  }
  PlanarTriangle project(const std::array<Vec3, 3>& x) const
  {
    PlanarTriangle result;
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 d = x[k] - this->origin;
      result[k] = { dot(d, this->first), dot(d, this->second) };
    }
    return result;
  }
};

std::array<Vec3, 3> cornersOf(const std::vector<Vec3>& points, const Corners& v)
{
  return { points[v[0]], points[v[1]], points[v[2]] };
}

/// The triangles of the input, of its region and patch, that a triangle overlaps, searched from
/// `start`; on a surface, in projection along its normal.
OverlapRow overlapsOf(const std::array<Vec3, 3>& corners, TriId start, const TriangleMesh& before,
  const TriangleInput& input)
{
  const Frame frame(corners);
  const PlanarTriangle own = frame.project(corners);
  const double least = RoundingFraction * areaOf({ own.begin(), own.end() });
  OverlapRow row;
  std::vector<TriId> queue = { start };
  std::unordered_set<TriId> known = { start };
  for (std::size_t i = 0; i < queue.size(); ++i)
  {
    const TriId t = queue[i];
    const PlanarTriangle other = frame.project(cornersOf(input.points, input.cells[t]));
    // A triangle facing away belongs to another part of the surface.
    const double area = areaOf({ other.begin(), other.end() }) > 0.0 ? sharedArea(own, other) : 0.0;
    if (area > least)
    {
      row.push_back({ t, area });
    }
    if (area <= least && i > 0)
    {
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      const std::int32_t n = before.triangle(t).neighbors[k];
      if (!before.isWall(t, k) && known.insert(n >> 2).second)
      {
        queue.push_back(n >> 2);
      }
    }
  }
  std::sort(row.begin(), row.end());
  return row;
}
}

void computeOverlaps(const TriangleInput& input, const TriangleMesh& before,
  const TriangleMesh& changed, int threads, ReconnectionResult& result)
{
  std::vector<TriId> triangles;
  for (TriId t = 0; t < changed.slots(); ++t)
  {
    if (changed.alive(t))
    {
      triangles.push_back(t);
    }
  }
  std::vector<OverlapRow> rows(triangles.size());
  parallelFor(static_cast<Index>(triangles.size()), TrianglesPerChunk, threads,
    [&](Index c)
    {
      const Corners& v = changed.triangle(triangles[c]).vertices;
      if (!isUnchanged(input, changed, triangles[c]))
      {
        rows[c] = overlapsOf({ changed.point(v[0]), changed.point(v[1]), changed.point(v[2]) },
          static_cast<TriId>(result.originalCells[c]), before, input);
      }
    });
  takeOverlaps(rows, result);
}
}
