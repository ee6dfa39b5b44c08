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
void requireElements(const Mesh& mesh, const unsigned char* skip)
{
  const MeshView& view = mesh.view();
  const auto counts = [skip](Index cell) { return !(skip && skip[cell]); };
  // The cells of a wrong type, and which is the first.
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
      throw Error("The mesh has no cells finite elements are made of: triangles, quadrilaterals, "
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
  if (mesh.higherOrderCells() > 0)
  {
    const std::string first = find([](int type) { return isHigherOrder(type); }, higherOrder);
    if (higherOrder > 0)
    {
      throw Error(std::to_string(higherOrder) + " cells are of higher order (" + first +
        "). The elements here are linear: run Tessellate first.");
    }
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
  constexpr Index maximumCells = Index(1) << 29; // uses are kept in 32 bits
  if (view.numberOfCells >= maximumCells ||
    view.numberOfPoints > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("The mesh is too large for one process: distribute it over several ranks.");
  }
}
}
