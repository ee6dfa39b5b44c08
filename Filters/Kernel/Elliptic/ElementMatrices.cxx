// SPDX-License-Identifier: BSD-3-Clause
#include "ElementMatrices.h"

#include <limits>

namespace tautline
{
namespace
{
std::string counted(Index n, const CellTopology& t)
{
  return std::to_string(n) + " " + (n == 1 ? t.name : t.plural);
}
}

//------------------------------------------------------------------------------
void requireElements(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  // Names the first cell of a type that is not supported.
  const auto first = [&](auto wrong)
  {
    Index cell = 0;
    while (!wrong(view.cellTypes[cell]))
    {
      ++cell;
    }
    return "the first is cell " + std::to_string(cell) + ", VTK cell type " +
      std::to_string(static_cast<int>(view.cellTypes[cell]));
  };
  if (mesh.dimension() == Dimension::None)
  {
    throw Error("The mesh has no cells finite elements are made of: triangles, quadrilaterals, "
                "tetrahedra, hexahedra, wedges or pyramids.");
  }
  if (mesh.unsupportedCells() > 0)
  {
    throw Error(std::to_string(mesh.unsupportedCells()) +
      " cells are not triangles, quadrilaterals, tetrahedra, hexahedra, wedges or pyramids (" +
      first([](int type) { return cornerType(type) == CellType::Unsupported; }) +
      "). Extract the others, or run Tetrahedralize, which cuts all cells into triangles or "
      "tetrahedra.");
  }
  if (mesh.higherOrderCells() > 0)
  {
    throw Error(std::to_string(mesh.higherOrderCells()) + " cells are of higher order (" +
      first([](int type) { return isHigherOrder(type); }) +
      "). The elements here are linear: run Tessellate first.");
  }
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (mesh.dimension() == Dimension::Volume && t.dimension == 2)
    {
      throw Error("The mesh has " + counted(block.count, t) +
        " beside its volume cells. Extract the volume cells: flat elements would stiffen them.");
    }
  }
  constexpr Index maximumCells = Index(1) << 29; // uses are kept in 32 bits
  if (view.numberOfCells >= maximumCells ||
    view.numberOfPoints > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("The mesh is too large for one process: distribute it over several ranks.");
  }
}
}
