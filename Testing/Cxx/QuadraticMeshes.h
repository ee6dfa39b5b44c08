// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QuadraticMeshes.h
 * @brief Meshes of quadratic triangles and tetrahedra, made of linear ones; disks and balls.
 */
#ifndef tautline_QuadraticMeshes_h
#define tautline_QuadraticMeshes_h

#include "Blocks.h"

#include <functional>
#include <map>
#include <set>

namespace tautline
{
constexpr int QuadraticTriangle = 22, QuadraticTetrahedron = 24, SevenNodeTriangle = 34;

/** Numbers of points in the middle of edges, which are made when they are first asked for. */
class Middles
{
public:
  explicit Middles(MeshData& mesh)
    : Mesh(mesh)
  {
  }

  Index of(Index a, Index b)
  {
    const auto found = this->Points.emplace(std::minmax(a, b), this->Mesh.numberOfPoints());
    return found.second ? this->Mesh.addPoint(0.5 * (this->Mesh.point(a) + this->Mesh.point(b)))
                        : found.first->second;
  }

  /** The ends of each edge, and the point in its middle. */
  const std::map<std::pair<Index, Index>, Index>& points() const { return this->Points; }

private:
  MeshData& Mesh;
  std::map<std::pair<Index, Index>, Index> Points;
};

/** Straight quadratic cells instead of triangles (with a node at the center if asked) and
    tetrahedra. Points keep their numbers. */
inline MeshData quadraticOf(const MeshData& linear, bool center = false)
{
  MeshData result;
  result.points = linear.points;
  Middles middles(result);
  for (Index cell = 0; cell < linear.numberOfCells(); ++cell)
  {
    std::vector<Index> n = linear.nodes(cell);
    const CellTopology& t = topology(static_cast<CellType>(linear.types[cell]));
    for (int e = 0; e < t.edges; ++e)
    {
      n.push_back(middles.of(n[t.edgeNodes[e][0]], n[t.edgeNodes[e][1]]));
    }
    if (t.dimension == 2 && center)
    {
      n.push_back(result.addPoint(
        (1.0 / 3) * (linear.point(n[0]) + linear.point(n[1]) + linear.point(n[2]))));
    }
    result.addCell(t.dimension == 3 ? QuadraticTetrahedron
        : center                    ? SevenNodeTriangle
                                    : QuadraticTriangle,
      n);
  }
  return result;
}

/** Each triangle cut into four, each tetrahedron into eight. */
inline MeshData refined(const MeshData& coarse)
{
  MeshData result;
  result.points = coarse.points;
  Middles middles(result);
  for (Index cell = 0; cell < coarse.numberOfCells(); ++cell)
  {
    std::vector<Index> n = coarse.nodes(cell);
    const auto type = static_cast<CellType>(coarse.types[cell]);
    if (type == CellType::Tetrahedron)
    {
      // So that the shortest diagonal is taken: others degenerate from level to level.
      const auto diagonal = [&coarse](const std::vector<Index>& of)
      {
        return norm(
          coarse.point(of[0]) + coarse.point(of[2]) - coarse.point(of[1]) - coarse.point(of[3]));
      };
      std::vector<Index> turned = n;
      for (int i = 0; i < 2; ++i)
      {
        std::rotate(turned.begin() + 1, turned.begin() + 2, turned.end());
        n = diagonal(turned) < diagonal(n) ? turned : n;
      }
    }
    const auto m = [&](int a, int b) { return middles.of(n[a], n[b]); };
    if (type == CellType::Triangle)
    {
      result.addCell(type, { n[0], m(0, 1), m(0, 2) });
      result.addCell(type, { m(0, 1), n[1], m(1, 2) });
      result.addCell(type, { m(0, 2), m(1, 2), n[2] });
      result.addCell(type, { m(0, 1), m(1, 2), m(0, 2) });
      continue;
    }
    result.addCell(type, { n[0], m(0, 1), m(0, 2), m(0, 3) });
    result.addCell(type, { m(0, 1), n[1], m(1, 2), m(1, 3) });
    result.addCell(type, { m(0, 2), m(1, 2), n[2], m(2, 3) });
    result.addCell(type, { m(0, 3), m(1, 3), m(2, 3), n[3] });
    // The octahedron inside, along the diagonal from edge 02 to edge 13.
    result.addCell(type, { m(0, 1), m(0, 2), m(0, 3), m(1, 3) });
    result.addCell(type, { m(0, 1), m(1, 2), m(0, 2), m(1, 3) });
    result.addCell(type, { m(0, 2), m(2, 3), m(0, 3), m(1, 3) });
    result.addCell(type, { m(0, 2), m(1, 2), m(2, 3), m(1, 3) });
  }
  return result;
}

/**
 * The unit disk or ball of quadratic cells: the octants, refined this many times; edges inside are
 * straight, and the boundary has its nodes on the circle or sphere.
 */
inline MeshData quadraticBall(CellType type, int refinements, bool center = false)
{
  const bool solid = topology(type).dimension == 3;
  MeshData data;
  data.addPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 } });
  if (solid)
  {
    data.addPoints({ { 0, 0, 1 }, { 0, 0, -1 } });
  }
  for (Index k = 0; k < 4; ++k)
  {
    const Index a = 1 + k, b = 1 + (k + 1) % 4;
    if (solid)
    {
      data.addCell(type, { 0, a, b, 5 });
      data.addCell(type, { 0, b, a, 6 });
    }
    else
    {
      data.addCell(type, { 0, a, b });
    }
  }
  for (int i = 0; i < refinements; ++i)
  {
    data = refined(data);
  }
  const auto level = [](const Vec3& p) { return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]); };
  // Octants of the cube to octants of the ball.
  std::set<Index> onSphere;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i);
    if (level(p) > 1 - 1e-9)
    {
      onSphere.insert(i);
    }
    if (norm(p) > 0)
    {
      data.setPoint(i, (level(p) / norm(p)) * p);
    }
  }
  MeshData result = quadraticOf(data, center);
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const std::vector<Index> n = result.nodes(cell);
    const CellTopology& t = topology(type);
    for (int e = 0; e < t.edges; ++e)
    {
      const Index a = n[t.edgeNodes[e][0]], b = n[t.edgeNodes[e][1]], m = n[t.nodes + e];
      if (onSphere.count(a) && onSphere.count(b))
      {
        const Vec3 middle = 0.5 * (result.point(a) + result.point(b));
        result.setPoint(m, (1 / norm(middle)) * middle);
      }
    }
  }
  return result;
}
}

#endif
