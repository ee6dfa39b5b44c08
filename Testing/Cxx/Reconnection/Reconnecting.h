// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Reconnecting.h
 * @brief Meshes of tetrahedra to be reconnected, and what the checks of results compare.
 */
#ifndef tautline_Reconnecting_h
#define tautline_Reconnecting_h

#include "Blocks.h"
#include "Check.h"

#include "tautline/Reconnection/Reconnection.h"

namespace tautline
{
inline double volumeOf(const MeshData& data, Index cell)
{
  const Index* v = &data.connectivity[data.offsets[cell]];
  const Vec3 p = data.point(v[0]);
  return dot(cross(data.point(v[1]) - p, data.point(v[2]) - p), data.point(v[3]) - p) / 6.0;
}

inline double volumeOf(const MeshData& data)
{
  long double sum = 0.0;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    sum += volumeOf(data, c);
  }
  return static_cast<double>(sum);
}

/**
 * @brief Moves inner points at random, as far as the cells around them stay good.
 * @param good whether a cell is, by its number
 * @param stays whether a point inside is not moved, by its coordinates
 */
template <class Good, class Stays>
void moveInside(
  MeshData& data, unsigned seed, double amplitude, const Good& good, const Stays& stays)
{
  const Mesh before(data.view());
  const bool planar = before.dimension() == Dimension::Planar;
  const std::vector<char> boundary = before.boundary().isBoundaryPoint;
  const VertexCells cells = before.vertexCells();
  Random random(seed);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    Vec3 d = random.vector(-amplitude, amplitude);
    d[2] = planar ? 0.0 : d[2];
    const Vec3 start = data.point(i);
    bool valid = boundary[i] != 0 || stays(start);
    while (!valid)
    {
      data.setPoint(i, start + d);
      const auto begin = cells.cells.begin();
      valid = std::all_of(begin + cells.offsets[i], begin + cells.offsets[i + 1], good);
      d = 0.7 * d;
    }
  }
}

template <class Good>
void moveInside(MeshData& data, unsigned seed, double amplitude, const Good& good)
{
  moveInside(data, seed, amplitude, good, [](const Vec3&) { return false; });
}

/// A block of n x n x n cubes of tetrahedra; inner points moved at random as far as all cells stay
/// valid: slivers included.
inline MeshData sliverBlock(Index n, unsigned seed = 3, double amplitude = 0.6)
{
  MeshData data = blockMesh(CellType::Tetrahedron, n, n, n);
  moveInside(data, seed, amplitude, [&](Index cell) { return volumeOf(data, cell) > 1e-3; });
  return data;
}

/// Along an edge of roundMesh().
constexpr Index RoundCubes = 8;

/// A block of cubes made round: in three directions a ball, in two a cylinder of height 2, both of
/// radius 1; inner points moved at random.
inline MeshData roundMesh(int directions, unsigned seed = 7, Index cubes = RoundCubes)
{
  MeshData data = blockMesh(CellType::Tetrahedron, cubes, cubes, cubes);
  const double half = 0.5 * static_cast<double>(cubes);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 x = (1.0 / half) * (data.point(i) - Vec3{ half, half, half });
    double largest = 0.0, square = 0.0;
    for (int k = 0; k < directions; ++k)
    {
      largest = std::max(largest, std::abs(x[k]));
      square += x[k] * x[k];
    }
    Vec3 y = x;
    for (int k = 0; k < directions && square > 0.0; ++k)
    {
      y[k] = x[k] * largest / std::sqrt(square);
    }
    data.setPoint(i, y);
  }
  moveInside(data, seed, 0.6 / half, [&](Index cell) { return volumeOf(data, cell) > 1e-6; });
  return data;
}

inline MeshData outputOf(const ReconnectionResult& result)
{
  TAUTLINE_LET(MeshData, data, points = result.points);
  for (std::size_t i = 0; i < result.tetrahedra.size(); i += 4)
  {
    const Index* v = &result.tetrahedra[i];
    data.addCell(CellType::Tetrahedron, { v[0], v[1], v[2], v[3] });
  }
  return data;
}

/// The facets used by one cell of a region (0: of all), as sorted triples of corner coordinates.
inline std::set<std::array<Vec3, 3>> outerFacets(
  const MeshData& data, const std::vector<Index>& regions = {}, Index region = 0)
{
  constexpr int faces[4][3] = { { 1, 2, 3 }, { 0, 2, 3 }, { 0, 1, 3 }, { 0, 1, 2 } };
  std::map<std::array<Vec3, 3>, int> uses;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    if (!regions.empty() && regions[c] != region)
    {
      continue;
    }
    for (const auto& f : faces)
    {
      std::array<Vec3, 3> key;
      for (int k = 0; k < 3; ++k)
      {
        key[k] = data.point(data.connectivity[4 * c + f[k]]);
      }
      std::sort(key.begin(), key.end());
      ++uses[key];
    }
  }
  std::set<std::array<Vec3, 3>> facets;
  for (const auto& use : uses)
  {
    if (use.second == 1)
    {
      facets.insert(use.first);
    }
  }
  return facets;
}

/// Valid cells, consistent arrays.
inline void checkArrays(const MeshData& output, const ReconnectionResult& result)
{
  TAUTLINE_CHECK_EQUAL(result.originalPoints.size(), output.points.size() / 3);
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(result.originalCells.size()), output.numberOfCells());
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(result.obstacles.size()), output.numberOfCells());
  TAUTLINE_EACH_OF(signed char v, validityOf(output),
    TAUTLINE_CHECK_EQUAL(static_cast<int>(v), static_cast<int>(Valid)));
}

/// Valid cells, consistent arrays, worst values not worse and as the history states.
inline void checkResult(const MeshData& input, const ReconnectionResult& result)
{
  const MeshData output = outputOf(result);
  checkArrays(output, result);
  const auto worst = [](const MeshData& data, Metric metric, bool largest)
  {
    const std::vector<double> q = valuesOf(data, metric);
    return largest ? *std::max_element(q.begin(), q.end()) : *std::min_element(q.begin(), q.end());
  };
  const double imr = worst(output, Metric::InverseMeanRatio, true);
  TAUTLINE_CHECK(imr <= worst(input, Metric::InverseMeanRatio, true) * (1.0 + 1e-12));
  TAUTLINE_CHECK_RELATIVE(imr, result.history.back().worstInverseMeanRatio, 1e-9);
  TAUTLINE_CHECK(result.history.back().smallestAngle >= result.history.front().smallestAngle);
  TAUTLINE_CHECK(result.history.back().worstQuality >= result.history.front().worstQuality);
  TAUTLINE_CHECK_EQUAL(result.history.back().tetrahedra, output.numberOfCells());
  TAUTLINE_CHECK_RELATIVE(volumeOf(output), volumeOf(input), 1e-14);
}

inline ReconnectionResult reconnect(const MeshData& data, const ReconnectionOptions& options)
{
  return improveConnectivity(Mesh(data.view()), options);
}

inline ReconnectionOptions optionsOf(ReconnectionPreset preset)
{
  ReconnectionOptions options;
  applyPreset(preset, options);
  return options;
}
}
#endif
