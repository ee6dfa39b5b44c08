// SPDX-License-Identifier: BSD-3-Clause
#include "ElementMatrices.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

namespace tautline
{
namespace
{
const char* const curvingRemedy =
  "Convert the mesh to quadratic triangles or tetrahedra, or to linear cells, by Curve Mesh (order "
  "2 or 1); Tessellate cuts curved cells into linear ones.";

std::string counted(Index n, const CellTopology& t)
{
  return std::to_string(n) + " " + (n == 1 ? t.name : t.plural);
}

/**
 * Edges of quadratic elements must have one common middle node in all elements; otherwise functions
 * would be discontinuous there. Merging coincident points only merges corners.
 */
void requireOneMiddle(const MeshView& view, const unsigned char* skip)
{
  constexpr int triangleEdges[3][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 } };
  constexpr int tetrahedronEdges[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 },
    { 2, 3 } };
  std::vector<std::array<Index, 3>> edges; // ends in increasing order, middle
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const ElementKind kind = elementKind(view, cell);
    if (!isQuadratic(kind) || (skip && skip[cell]))
    {
      continue;
    }
    const bool solid = kind == ElementKind::QuadraticTetrahedron;
    const Index* node = view.connectivity + view.offsets[cell];
    for (int e = 0; e < (solid ? 6 : 3); ++e)
    {
      const int* ends = solid ? tetrahedronEdges[e] : triangleEdges[e];
      const auto [low, high] = std::minmax(node[ends[0]], node[ends[1]]);
      edges.push_back({ low, high, node[(solid ? 4 : 3) + e] });
    }
  }
  std::sort(edges.begin(), edges.end());
  Index several = 0;
  for (std::size_t e = 1; e < edges.size(); ++e)
  {
    const auto &a = edges[e - 1], &b = edges[e];
    several += a[0] == b[0] && a[1] == b[1] && a[2] != b[2];
  }
  if (several > 0)
  {
    throw Error(std::to_string(several) + (several == 1 ? " edge has" : " edges have") +
      " several nodes between the same ends: the elements are not connected there. Run Clean "
      "to Grid first, which merges coincident points.");
  }
}
}

//------------------------------------------------------------------------------
void refuseMixedOrders(Index linear, Index quadratic)
{
  throw Error("The mesh has " + std::to_string(linear) + " linear and " +
    std::to_string(quadratic) +
    " quadratic elements, which do not fit together: the solution would be discontinuous "
    "between them. " +
    curvingRemedy);
}

//------------------------------------------------------------------------------
void requireElements(const Mesh& mesh, const unsigned char* skip)
{
  const MeshView& view = mesh.view();
  const auto counts = [skip](Index cell) { return !(skip && skip[cell]); };
  // Counts the cells of a wrong type and finds the first.
  const auto find = [&](auto wrong, Index& number)
  {
    Index first = -1;
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      if (counts(cell) && wrong(view.cellTypes[cell]))
      {
        first = first < 0 ? cell : first;
        ++number;
      }
    }
    return first < 0 ? ""
                     : "the first is cell " + std::to_string(first) + ", VTK cell type " +
        std::to_string(static_cast<int>(view.cellTypes[first]));
  };
  Index all = 0, unsupported = 0, higherOrder = 0;
  if (mesh.dimension() == Dimension::None)
  {
    find([](int) { return true; }, all);
    if (all > 0 || !skip)
    {
      throw Error("The mesh has no cells that finite elements support: triangles, quadrilaterals, "
                  "tetrahedra, hexahedra, wedges or pyramids.");
    }
  }
  if (mesh.unsupportedCells() > 0)
  {
    const std::string first =
      find([](int type) { return cornerType(type) == CellType::Unsupported; }, unsupported);
    if (unsupported > 0)
    {
      throw Error(std::to_string(unsupported) +
        " cells are not triangles, quadrilaterals, tetrahedra, hexahedra, wedges or pyramids (" +
        first +
        "). Extract the others, or run Tetrahedralize, which cuts all cells into triangles or "
        "tetrahedra.");
    }
  }
  Index quadratic = 0, linear = 0, first = -1;
  for (Index cell = 0; mesh.higherOrderCells() > 0 && cell < view.numberOfCells; ++cell)
  {
    const ElementKind kind = elementKind(view, cell);
    if (counts(cell))
    {
      quadratic += isQuadratic(kind);
      linear += kind != ElementKind::None && !isQuadratic(kind);
      first = kind == ElementKind::None && higherOrder++ == 0 ? cell : first;
    }
  }
  if (higherOrder > 0)
  {
    throw Error(std::to_string(higherOrder) + " cells are of higher order (the first is cell " +
      std::to_string(first) + ", VTK cell type " +
      std::to_string(static_cast<int>(view.cellTypes[first])) +
      "). Only triangles and tetrahedra of order 2 are supported as curved elements. " +
      curvingRemedy);
  }
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    Index flat = 0;
    for (Index i = 0; mesh.dimension() == Dimension::Volume && t.dimension == 2 && i < block.count;
         ++i)
    {
      flat += counts(block.cell(i));
    }
    if (flat > 0)
    {
      throw Error("The mesh has " + counted(flat, t) +
        " beside its volume cells. Extract the volume cells: flat elements would stiffen them.");
    }
  }
  if (linear > 0 && quadratic > 0)
  {
    refuseMixedOrders(linear, quadratic);
  }
  if (quadratic > 0)
  {
    requireOneMiddle(view, skip);
  }
  // Uses are kept in 32 bits, see AssemblyPattern.
  const Index maximumCells = Index(1) << (quadratic > 0 ? 28 : 29);
  if (view.numberOfCells >= maximumCells ||
    view.numberOfPoints > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("The mesh is too large for one process: distribute it over several ranks.");
  }
}
}
