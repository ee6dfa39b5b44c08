// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Triangulating.h
 * @brief Meshes of triangles to be reconnected, and what the checks of results compare.
 */
#ifndef tautline_Triangulating_h
#define tautline_Triangulating_h

#include "Reconnecting.h"
#include "Surfaces.h"

#include "tautline/Geometry/PlanarDelaunay.h"
#include "tautline/Geometry/Predicates.h"
#include "tautline/Reconnection/TriangleReconnection.h"

namespace tautline
{
using EdgeKey = std::array<Index, 2>;

inline Vec3 areaVector(const MeshData& data, Index cell)
{
  const Index* v = &data.connectivity[3 * cell];
  return 0.5 * cross(data.point(v[1]) - data.point(v[0]), data.point(v[2]) - data.point(v[0]));
}

/// The area of the cells of a region (-1: of all).
inline double areaOf(
  const MeshData& data, const std::vector<Index>& regions = {}, Index region = -1)
{
  long double sum = 0.0;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    sum += regions.empty() || region < 0 || regions[c] == region ? norm(areaVector(data, c)) : 0.0;
  }
  return static_cast<double>(sum);
}

inline MeshData trianglesOf(const ReconnectionResult& result)
{
  TAUTLINE_LET(MeshData, data, points = result.points);
  for (std::size_t i = 0; i < result.triangles.size(); i += 3)
  {
    const Index* v = &result.triangles[i];
    data.addCell(CellType::Triangle, { v[0], v[1], v[2] });
  }
  return data;
}

/// Edges with the cells that use them.
inline std::map<EdgeKey, std::vector<Index>> edgesOf(const MeshData& data)
{
  std::map<EdgeKey, std::vector<Index>> edges;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index a = data.connectivity[3 * c + k], b = data.connectivity[3 * c + (k + 1) % 3];
      edges[{ std::min(a, b), std::max(a, b) }].push_back(c);
    }
  }
  return edges;
}

/// The coordinates of the ends of edges with one cell.
inline std::set<std::array<Vec3, 2>> borderOf(const MeshData& data)
{
  std::set<std::array<Vec3, 2>> border;
  for (const auto& [edge, cells] : edgesOf(data))
  {
    if (cells.size() == 1)
    {
      const Vec3 a = data.point(edge[0]), b = data.point(edge[1]);
      border.insert({ std::min(a, b), std::max(a, b) });
    }
  }
  return border;
}

inline double smallestAngle(const MeshData& data)
{
  const std::vector<double> angles = valuesOf(data, Metric::MinimumAngle);
  return *std::min_element(angles.begin(), angles.end());
}

/// Points of the unit square and its corners; a Delaunay triangulation of these.
inline MeshData delaunaySquare(int count, unsigned seed)
{
  Random random(seed);
  std::vector<double> xy = { 0, 0, 1, 0, 1, 1, 0, 1 };
  for (int i = 0; i < count; ++i)
  {
    const Vec3 p = random.vector(0.01, 0.99);
    xy.insert(xy.end(), { p[0], p[1] });
  }
  MeshData data;
  for (std::size_t i = 0; i < xy.size(); i += 2)
  {
    data.addPoint({ xy[i], xy[i + 1], 0.0 });
  }
  for (const auto& t : constrainedDelaunay(xy, {}))
  {
    data.addCell(CellType::Triangle, { t[0], t[1], t[2] });
  }
  return data;
}

/// The mesh after edges inside convex pairs of triangles were flipped at random.
inline MeshData randomlyFlipped(const MeshData& data, int flips, unsigned seed)
{
  Random random(seed);
  std::vector<std::array<Index, 3>> cells(data.numberOfCells());
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    std::copy_n(&data.connectivity[3 * c], 3, cells[c].begin());
  }
  const auto positive = [&](Index a, Index b, Index c)
  {
    const Vec3 p = data.point(a), q = data.point(b), r = data.point(c);
    return orientation(Vec2{ p[0], p[1] }, Vec2{ q[0], q[1] }, Vec2{ r[0], r[1] }) > 0;
  };
  for (int i = 0; i < flips; ++i)
  {
    std::array<Index, 3>& t = cells[random.integer(static_cast<Index>(cells.size()))];
    const int k = static_cast<int>(random.integer(3));
    const Index a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
    for (std::array<Index, 3>& other : cells)
    {
      for (int j = 0; j < 3; ++j)
      {
        const Index d = other[j];
        if (other[(j + 1) % 3] == c && other[(j + 2) % 3] == b && positive(a, b, d) &&
          positive(a, d, c))
        {
          t = { a, b, d };
          other = { a, d, c };
          break;
        }
      }
    }
  }
  TAUTLINE_LET(MeshData, result, points = data.points);
  for (const auto& t : cells)
  {
    result.addCell(CellType::Triangle, { t[0], t[1], t[2] });
  }
  return result;
}

/// n x n squares of triangles with inner points moved at random as far as all cells stay valid.
inline MeshData sliverSheet(Index n, unsigned seed = 5, double amplitude = 0.8)
{
  MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  moveInside(data, seed, amplitude, [&](Index cell) { return areaVector(data, cell)[2] > 1e-3; });
  return data;
}

inline ReconnectionResult reconnect(const MeshData& data, const TriangleOptions& options)
{
  return improveTriangles(Mesh(data.view()), options);
}

inline TriangleOptions triangleOptions(ReconnectionPreset preset)
{
  TriangleOptions options;
  applyPreset(preset, options);
  return options;
}

/// Valid cells, consistent arrays, worst values not worse and as the history states.
inline void checkTriangles(const MeshData& input, const ReconnectionResult& result)
{
  const MeshData output = trianglesOf(result);
  checkArrays(output, result);
  const auto worstRatio = [](const MeshData& data)
  {
    const std::vector<double> q = valuesOf(data, Metric::InverseMeanRatio);
    return *std::max_element(q.begin(), q.end());
  };
  const ReconnectionRecord &first = result.history.front(), &last = result.history.back();
  TAUTLINE_CHECK(worstRatio(output) <= worstRatio(input) * (1.0 + 1e-12));
  TAUTLINE_CHECK_RELATIVE(worstRatio(output), last.worstInverseMeanRatio, 1e-9);
  TAUTLINE_CHECK_RELATIVE(smallestAngle(output), last.smallestAngle, 1e-9);
  TAUTLINE_CHECK(smallestAngle(output) >= smallestAngle(input) * (1.0 - 1e-12));
  TAUTLINE_CHECK(last.worstQuality >= first.worstQuality);
  TAUTLINE_CHECK_EQUAL(last.tetrahedra, output.numberOfCells());
}
}
#endif
