// SPDX-License-Identifier: BSD-3-Clause
#include "CellTopology.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace tautline
{
namespace
{
struct Shape
{
  CellType type;
  const char* name;
  const char* plural;
  int dimension;
  double sizePerDeterminant;
  bool simplex;
  std::vector<Vec3> ideal;
  std::vector<std::array<int, 2>> edges;
  std::vector<std::vector<int>> faces;
  std::vector<std::array<int, 4>> corners;
};

std::array<double, 9> inverse(const double (&w)[3][3], double det)
{
  std::array<double, 9> result{};
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      // Cyclic indices yield cofactors with their signs.
      const int a = (c + 1) % 3, b = (c + 2) % 3, d = (r + 1) % 3, e = (r + 2) % 3;
      result[3 * r + c] = (w[a][d] * w[b][e] - w[a][e] * w[b][d]) / det;
    }
  }
  return result;
}

CellTopology complete(const Shape& s)
{
  CellTopology t{};
  t.type = s.type;
  t.name = s.name;
  t.plural = s.plural;
  t.dimension = s.dimension;
  t.nodes = static_cast<int>(s.ideal.size());
  t.edges = static_cast<int>(s.edges.size());
  t.faces = static_cast<int>(s.faces.size());
  t.corners = static_cast<int>(s.corners.size());
  t.samples = s.simplex ? 1 : t.corners;
  t.sizePerDeterminant = s.sizePerDeterminant;
  std::copy(s.edges.begin(), s.edges.end(), t.edgeNodes.begin());
  std::copy(s.corners.begin(), s.corners.end(), t.cornerNodes.begin());
  for (int f = 0; f < t.faces; ++f)
  {
    t.faceSizes[f] = static_cast<int>(s.faces[f].size());
    std::copy(s.faces[f].begin(), s.faces[f].end(), t.faceNodes[f].begin());
  }
  for (int e = 0; e < t.edges && t.faces > 0; ++e)
  {
    int found = 0;
    for (int f = 0; f < t.faces; ++f)
    {
      const auto& nodes = s.faces[f];
      const bool first = std::count(nodes.begin(), nodes.end(), s.edges[e][0]) > 0;
      const bool second = std::count(nodes.begin(), nodes.end(), s.edges[e][1]) > 0;
      if (first && second)
      {
        t.edgeFaces[e][found++] = f;
      }
    }
  }
  for (int c = 0; c < t.corners; ++c)
  {
    // In 2D, the third column is the normal, so that one 3 x 3 inverse serves both dimensions.
    double w[3][3] = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 1 } };
    double lengths = 1.0;
    for (int k = 0; k < s.dimension; ++k)
    {
      const Vec3 column = s.ideal[s.corners[c][k + 1]] - s.ideal[s.corners[c][0]];
      lengths *= norm(column);
      for (int row = 0; row < 3; ++row)
      {
        w[row][k] = column[row];
      }
    }
    const double det = dot({ w[0][0], w[1][0], w[2][0] },
      cross({ w[0][1], w[1][1], w[2][1] }, { w[0][2], w[1][2], w[2][2] }));
    t.idealInverse[c] = inverse(w, det);
    // With this factor, the scaled Jacobian of the ideal cell is 1.
    t.scaledJacobianFactor = lengths / det;
  }
  return t;
}

std::array<CellTopology, NumberOfCellTypes> makeTopologies()
{
  const double h = std::sqrt(3.0) / 2.0;
  const Vec3 tetApex = { 0.5, h / 3.0, std::sqrt(2.0 / 3.0) };
  const Vec3 pyramidApex = { 0.5, 0.5, std::sqrt(0.5) };
  return { complete({ CellType::Triangle, "triangle", "triangles", 2, 0.5, true,
             { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 } }, { { 0, 1 }, { 1, 2 }, { 2, 0 } }, {},
             { { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 } } }),
    complete({ CellType::Quadrilateral, "quadrilateral", "quadrilaterals", 2, 1.0, false,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } },
      { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } }, {},
      { { 0, 1, 3 }, { 1, 2, 0 }, { 2, 3, 1 }, { 3, 0, 2 } } }),
    complete({ CellType::Tetrahedron, "tetrahedron", "tetrahedra", 3, 1.0 / 6.0, true,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 }, tetApex },
      { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } },
      { { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 }, { 0, 2, 1 } },
      { { 0, 1, 2, 3 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 }, { 3, 0, 2, 1 } } }),
    complete({ CellType::Hexahedron, "hexahedron", "hexahedra", 3, 1.0, false,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 },
        { 0, 1, 1 } },
      { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 5 }, { 5, 6 }, { 6, 7 }, { 7, 4 }, { 0, 4 },
        { 1, 5 }, { 2, 6 }, { 3, 7 } },
      { { 0, 4, 7, 3 }, { 1, 2, 6, 5 }, { 0, 1, 5, 4 }, { 3, 7, 6, 2 }, { 0, 3, 2, 1 },
        { 4, 5, 6, 7 } },
      { { 0, 1, 3, 4 }, { 1, 2, 0, 5 }, { 2, 3, 1, 6 }, { 3, 0, 2, 7 }, { 4, 7, 5, 0 },
        { 5, 4, 6, 1 }, { 6, 5, 7, 2 }, { 7, 6, 4, 3 } } }),
    // VTK's wedge: the triangle 0 1 2 is counterclockwise as seen from outside, that is, from
    // below.
    complete({ CellType::Wedge, "wedge", "wedges", 3, 0.5, false,
      { { 0, 0, 0 }, { 0.5, h, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, { 0.5, h, 1 }, { 1, 0, 1 } },
      { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 }, { 0, 3 }, { 1, 4 }, { 2, 5 } },
      { { 0, 1, 2 }, { 3, 5, 4 }, { 0, 3, 4, 1 }, { 1, 4, 5, 2 }, { 2, 5, 3, 0 } },
      { { 0, 2, 1, 3 }, { 1, 0, 2, 4 }, { 2, 1, 0, 5 }, { 3, 4, 5, 0 }, { 4, 5, 3, 1 },
        { 5, 3, 4, 2 } } }),
    complete({ CellType::Pyramid, "pyramid", "pyramids", 3, 1.0 / 3.0, false,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, pyramidApex },
      { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 0, 4 }, { 1, 4 }, { 2, 4 }, { 3, 4 } },
      { { 0, 3, 2, 1 }, { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } },
      { { 0, 1, 3, 4 }, { 1, 2, 0, 4 }, { 2, 3, 1, 4 }, { 3, 0, 2, 4 } } }) };
}
}

const std::array<CellTopology, NumberOfCellTypes>& topologies()
{
  static const auto table = makeTopologies();
  return table;
}

int topologyIndex(CellType type)
{
  const auto& table = topologies();
  for (int i = 0; i < NumberOfCellTypes; ++i)
  {
    if (table[i].type == type)
    {
      return i;
    }
  }
  return -1;
}

const CellTopology& topology(CellType type)
{
  const int index = topologyIndex(type);
  if (index < 0)
  {
    throw Error("No topology for this cell type: Tautline supports triangles, quadrilaterals, "
                "tetrahedra, hexahedra, wedges and pyramids.");
  }
  return topologies()[index];
}

namespace
{
// VTK's codes of the higher-order types, which list their corners first.
struct HigherOrder
{
  int vtkType;
  CellType corners;
};
constexpr HigherOrder higherOrderTypes[] = { { 22, CellType::Triangle }, { 34, CellType::Triangle },
  { 69, CellType::Triangle }, { 76, CellType::Triangle }, { 23, CellType::Quadrilateral },
  { 28, CellType::Quadrilateral }, { 30, CellType::Quadrilateral }, { 70, CellType::Quadrilateral },
  { 77, CellType::Quadrilateral }, { 24, CellType::Tetrahedron }, { 71, CellType::Tetrahedron },
  { 78, CellType::Tetrahedron }, { 25, CellType::Hexahedron }, { 29, CellType::Hexahedron },
  { 33, CellType::Hexahedron }, { 72, CellType::Hexahedron }, { 79, CellType::Hexahedron },
  { 26, CellType::Wedge }, { 31, CellType::Wedge }, { 32, CellType::Wedge },
  { 73, CellType::Wedge }, { 80, CellType::Wedge }, { 27, CellType::Pyramid },
  { 37, CellType::Pyramid }, { 74, CellType::Pyramid }, { 81, CellType::Pyramid } };
}

CellType cornerType(int vtkCellType)
{
  for (const CellTopology& t : topologies())
  {
    if (static_cast<int>(t.type) == vtkCellType)
    {
      return t.type;
    }
  }
  for (const HigherOrder& h : higherOrderTypes)
  {
    if (h.vtkType == vtkCellType)
    {
      return h.corners;
    }
  }
  return CellType::Unsupported;
}

bool isHigherOrder(int vtkCellType)
{
  return std::any_of(std::begin(higherOrderTypes), std::end(higherOrderTypes),
    [=](const HigherOrder& h) { return h.vtkType == vtkCellType; });
}
}
