// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceDistance.h
 * @brief The distance between the boundaries of volume meshes, measured with no code of the library
 * under test.
 */
#ifndef tautline_SurfaceDistance_h
#define tautline_SurfaceDistance_h

#include "Meshes.h"

namespace tautline
{
using Triangle = std::array<Vec3, 3>;

/// The distance of a point from a triangle, by the three edges and the plane.
inline double distanceTo(const Triangle& t, const Vec3& x)
{
  double least = 1e300;
  for (int k = 0; k < 3; ++k)
  {
    const Vec3 a = t[k], ab = t[(k + 1) % 3] - a;
    const double s = std::clamp(dot(x - a, ab) / dot(ab, ab), 0.0, 1.0);
    least = std::min(least, norm(a + s * ab - x));
  }
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const Vec3 foot = x - (dot(x - t[0], n) / dot(n, n)) * n;
  bool inside = true;
  for (int k = 0; k < 3; ++k)
  {
    inside = inside && dot(cross(t[(k + 1) % 3] - t[k], foot - t[k]), n) >= 0;
  }
  return inside ? norm(foot - x) : least;
}

/// The boundary facets of some cells of a volume mesh, quadrilaterals halved.
template <class Keep>
std::vector<Triangle> boundaryOf(
  const MeshData& data, const std::vector<double>& points, const Keep& keep)
{
  const MeshView view = data.view();
  std::map<std::set<Index>, std::vector<Index>> faces;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const CellTopology& t = topology(cornerType(view.cellTypes[cell]));
    for (int f = 0; f < t.faces && keep(cell); ++f)
    {
      auto nodes = collect<Index>(t.faceSizes[f],
        [&](int k) { return data.connectivity[data.offsets[cell] + t.faceNodes[f][k]]; });
      const std::set<Index> key(nodes.begin(), nodes.end());
      faces.count(key) ? faces[key].clear() : void(faces[key] = nodes);
    }
  }
  std::vector<Triangle> triangles;
  for (const auto& [key, nodes] : faces)
  {
    const auto at = [&](std::size_t k)
    {
      const double* p = &points[3 * nodes[k]];
      return Vec3{ p[0], p[1], p[2] };
    };
    for (std::size_t k = 2; k < nodes.size(); ++k)
    {
      triangles.push_back({ at(0), at(k - 1), at(k) });
    }
  }
  return triangles;
}

inline std::vector<Triangle> boundaryOf(const MeshData& data, const std::vector<double>& points)
{
  return boundaryOf(data, points, [](Index) { return true; });
}

/// The largest distance of places of some triangles from others.
inline double distance(const std::vector<Triangle>& from, const std::vector<Triangle>& to)
{
  constexpr int parts = 5;
  double largest = 0;
  for (const Triangle& t : from)
  {
    for (int i = 0; i <= parts; ++i)
    {
      for (int j = 0; i + j <= parts; ++j)
      {
        const Vec3 x =
          (1.0 / parts) * ((parts - i - j) * t[0] + double(i) * t[1] + double(j) * t[2]);
        double least = smallestOf<double>(
          1e300, to, [&](const Triangle& other) { return distanceTo(other, x); });
        largest = std::max(largest, least);
      }
    }
  }
  return largest;
}
}
#endif
