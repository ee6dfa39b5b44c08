// SPDX-License-Identifier: BSD-3-Clause
#include "VtkNodes.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// A node by its integer coordinates on the lattice of a cell.
using LatticeNode = std::array<int, 3>;
using LatticeNodes = std::vector<LatticeNode>;

/// The nodes strictly between two nodes.
void addEdge(LatticeNodes& nodes, LatticeNode from, LatticeNode to, int order)
{
  for (int n = 1; n < order; ++n)
  {
    LatticeNode& node = nodes.emplace_back();
    for (std::size_t c = 0; c < node.size(); ++c)
    {
      node[c] = (from[c] * (order - n) + to[c] * n) / order;
    }
  }
}

/// Vertices and edges, then recursively the inner triangle, between three corners `order` steps
/// apart.
void addTriangle(LatticeNodes& nodes, std::array<LatticeNode, 3> corners, int order)
{
  for (; order > 0; order -= 3)
  {
    nodes.insert(nodes.end(), corners.begin(), corners.end());
    for (int e = 0; e < 3; ++e)
    {
      addEdge(nodes, corners[e], corners[(e + 1) % 3], order);
    }
    std::array<LatticeNode, 3> inner = corners;
    for (std::size_t c = 0; c < inner[0].size(); ++c)
    {
      for (int k = 0; k < 3; ++k)
      {
        // One step towards each of the other corners.
        inner[k][c] +=
          (corners[(k + 1) % 3][c] + corners[(k + 2) % 3][c] - 2 * corners[k][c]) / order;
      }
    }
    corners = inner;
  }
  if (order == 0)
  {
    nodes.push_back(corners[0]);
  }
}

/// The part of addTriangle() inside the edges.
void addTriangleInside(LatticeNodes& nodes, const std::array<LatticeNode, 3>& corners, int order)
{
  LatticeNodes all;
  addTriangle(all, corners, order);
  nodes.insert(nodes.end(), all.begin() + 3 * order, all.end());
}

/// A tetrahedron whose lowest corner has the coordinates `low`, then recursively the inner one.
void addTetrahedron(LatticeNodes& nodes, int low, int p)
{
  const std::array<LatticeNode, 4> v = { { { low, low, low }, { low + p, low, low },
    { low, low + p, low }, { low, low, low + p } } };
  if (p <= 0)
  {
    nodes.insert(nodes.end(), v.begin(), v.begin() + (p == 0));
    return;
  }
  constexpr int edges[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
  constexpr int faces[4][3] = { { 0, 1, 3 }, { 2, 3, 1 }, { 0, 3, 2 }, { 0, 2, 1 } };
  nodes.insert(nodes.end(), v.begin(), v.end());
  for (const auto& e : edges)
  {
    addEdge(nodes, v[e[0]], v[e[1]], p);
  }
  for (const auto& f : faces)
  {
    addTriangleInside(nodes, { v[f[0]], v[f[1]], v[f[2]] }, p);
  }
  addTetrahedron(nodes, low + 1, p - 4);
}

/// The corners of a square, counterclockwise.
constexpr int squareCorners[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
/// Edges of a square in the order of VTK's Lagrange cells, each in the direction of its axis.
constexpr int squareEdges[4][2] = { { 0, 1 }, { 1, 2 }, { 3, 2 }, { 0, 3 } };

LatticeNodes quadrilateralNodes(int p, int q)
{
  LatticeNodes nodes;
  for (const auto& c : squareCorners)
  {
    nodes.push_back({ p * c[0], q * c[1], 0 });
  }
  for (int e = 0; e < 4; ++e)
  {
    addEdge(nodes, nodes[squareEdges[e][0]], nodes[squareEdges[e][1]], e % 2 == 0 ? p : q);
  }
  for (int j = 1; j < q; ++j)
  {
    addEdge(nodes, { 0, j, 0 }, { p, j, 0 }, p);
  }
  return nodes;
}

LatticeNodes hexahedronNodes(const ElementOrders& p)
{
  LatticeNodes nodes;
  for (int k = 0; k < 2; ++k)
  {
    for (const auto& c : squareCorners)
    {
      nodes.push_back({ p[0] * c[0], p[1] * c[1], p[2] * k });
    }
  }
  for (int base = 0; base < 8; base += 4)
  {
    for (int e = 0; e < 4; ++e)
    {
      addEdge(nodes, nodes[base + squareEdges[e][0]], nodes[base + squareEdges[e][1]], p[e % 2]);
    }
  }
  for (int c = 0; c < 4; ++c)
  {
    addEdge(nodes, nodes[c], nodes[c + 4], p[2]);
  }
  // The faces u = 0, u = 1, v = 0, v = 1, w = 0, w = 1: the first of the other axes runs faster.
  for (int axis = 0; axis < 3; ++axis)
  {
    const int fast = axis == 0, slow = axis == 2 ? 1 : 2;
    for (int side = 0; side < 2; ++side)
    {
      for (int n = 1; n < p[slow]; ++n)
      {
        LatticeNode from = { 0, 0, 0 };
        from[axis] = side * p[axis];
        from[slow] = n;
        LatticeNode to = from;
        to[fast] = p[fast];
        addEdge(nodes, from, to, p[fast]);
      }
    }
  }
  for (int k = 1; k < p[2]; ++k)
  {
    for (int j = 1; j < p[1]; ++j)
    {
      addEdge(nodes, { 0, j, k }, { p[0], j, k }, p[0]);
    }
  }
  return nodes;
}

/// The nodes inside a triangle of a wedge: row by row, unlike in a triangle.
void addRowsInside(LatticeNodes& nodes, int p, int k)
{
  for (int j = 1; j < p; ++j)
  {
    for (int i = 1; i < p - j; ++i)
    {
      nodes.push_back({ i, j, k });
    }
  }
}

LatticeNodes wedgeNodes(int p, int q)
{
  LatticeNodes nodes;
  const auto corner = [&](int c, int k) {
    return LatticeNode{ c == 1 ? p : 0, c == 2 ? p : 0, k };
  };
  for (int n = 0; n < 6; ++n)
  {
    nodes.push_back(corner(n % 3, n / 3 * q));
  }
  for (int n = 0; n < 6; ++n)
  {
    addEdge(nodes, corner(n % 3, n / 3 * q), corner((n + 1) % 3, n / 3 * q), p);
  }
  for (int c = 0; c < 3; ++c)
  {
    addEdge(nodes, corner(c, 0), corner(c, q), q);
  }
  for (int k = 0; k <= q; k += q)
  {
    addRowsInside(nodes, p, k);
  }
  for (int c = 0; c < 3; ++c)
  {
    for (int k = 1; k < q; ++k)
    {
      addEdge(nodes, corner(c, k), corner((c + 1) % 3, k), p);
    }
  }
  for (int k = 1; k < q; ++k)
  {
    addRowsInside(nodes, p, k);
  }
  return nodes;
}

LatticeNodes integerNodes(ElementShape shape, const ElementOrders& p)
{
  LatticeNodes nodes;
  switch (shape)
  {
    case ElementShape::Triangle:
      addTriangle(nodes, { { { 0, 0, 0 }, { p[0], 0, 0 }, { 0, p[0], 0 } } }, p[0]);
      return nodes;
    case ElementShape::Quadrilateral:
      return quadrilateralNodes(p[0], p[1]);
    case ElementShape::Tetrahedron:
      addTetrahedron(nodes, 0, p[0]);
      return nodes;
    case ElementShape::Wedge:
      return wedgeNodes(p[0], p[2]);
    default:
      return hexahedronNodes(p);
  }
}
}

//------------------------------------------------------------------------------
ElementOrders uniformOrders(ElementShape shape, int p)
{
  return { p, p, dimensionOf(shape) == 2 ? 0 : p };
}

//------------------------------------------------------------------------------
int latticeSize(ElementShape shape, const ElementOrders& p)
{
  switch (shape)
  {
    case ElementShape::Triangle:
      return (p[0] + 1) * (p[0] + 2) / 2;
    case ElementShape::Quadrilateral:
      return (p[0] + 1) * (p[1] + 1);
    case ElementShape::Tetrahedron:
      return (p[0] + 1) * (p[0] + 2) * (p[0] + 3) / 6;
    case ElementShape::Wedge:
      return (p[0] + 1) * (p[0] + 2) / 2 * (p[2] + 1);
    default:
      return (p[0] + 1) * (p[1] + 1) * (p[2] + 1);
  }
}

//------------------------------------------------------------------------------
std::vector<Vec3> latticeNodes(ElementShape shape, const ElementOrders& orders)
{
  std::vector<Vec3> coordinates;
  for (const LatticeNode& n : integerNodes(shape, orders))
  {
    Vec3& at = coordinates.emplace_back(Vec3{ 0, 0, 0 });
    for (std::size_t c = 0; c < at.size(); ++c)
    {
      at[c] = orders[c] > 0 ? static_cast<double>(n[c]) / orders[c] : 0;
    }
  }
  return coordinates;
}

//------------------------------------------------------------------------------
CornerPatterns edgePatterns(ElementShape shape)
{
  switch (shape)
  {
    case ElementShape::Triangle:
      return { { 0, 1 }, { 1, 2 }, { 2, 0 } };
    case ElementShape::Quadrilateral:
      return { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } };
    case ElementShape::Tetrahedron:
      return { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
    case ElementShape::Wedge:
      return { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 }, { 0, 3 }, { 1, 4 },
        { 2, 5 } };
    default:
      return { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 5 }, { 5, 6 }, { 6, 7 }, { 7, 4 },
        { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } };
  }
}

//------------------------------------------------------------------------------
std::vector<Vec3> meansOf(const std::vector<Vec3>& corners, const CornerPatterns& patterns)
{
  std::vector<Vec3> coordinates = corners;
  for (const std::vector<int>& pattern : patterns)
  {
    Vec3& at = coordinates.emplace_back(Vec3{ 0, 0, 0 });
    for (int c : pattern)
    {
      at += (1.0 / static_cast<double>(pattern.size())) * corners[c];
    }
  }
  return coordinates;
}
}
