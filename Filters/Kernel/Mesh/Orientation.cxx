// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh.h"

#include "CellOrder.h"
#include "FacetTable.h"
#include "PartSign.h"
#include "tautline/Core/UnionFind.h"

#include <utility>

namespace tautline
{
namespace
{
/// Counts the parts, which `sets` has by cell, and those that are reversed: the signed size of a
/// part decides, tangled or not; where it is lost to rounding (a vertex far out), the majority.
void countParts(const Mesh& mesh, const signed char* validity, UnionFind& sets, Orientation& result)
{
  const MeshView& view = mesh.view();
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  const bool haveSigns = mesh.dimension() != Dimension::Surface;
  std::vector<PartSign> parts(view.numberOfCells);
  const Vec3 origin = finitePoint(view);
  for (const CellBlock& block : mesh.blocks())
  {
    if (topology(block.type).dimension == dimension)
    {
      for (Index i = 0; i < block.count; ++i)
      {
        const Index cell = block.cell(i);
        if (haveSigns && validity[cell] >= Inverted) // flat ones, too: they may be long
        {
          const double size =
            signedSize(mesh, topology(block.type), view.connectivity + view.offsets[cell], origin);
          parts[sets.find(cell)].add(size, validity[cell]);
        }
        result.parts += sets.find(cell) == cell;
      }
    }
  }
  if (haveSigns)
  {
    const double sign = mesh.mirrored() ? -1 : 1;
    result.reversedParts = std::count_if(
      parts.begin(), parts.end(), [=](const PartSign& p) { return p.reversed(sign); });
  }
}
}

//------------------------------------------------------------------------------
Orientation Mesh::orientation(const signed char* validity) const
{
  Orientation result;
  const int dimension = this->Dim == Dimension::Volume ? 3 : 2;
  Index cells = 0;
  for (const CellBlock& block : this->Blocks)
  {
    if (topology(block.type).dimension == dimension)
    {
      cells += block.count;
      for (Index i = 0; i < block.count; ++i)
      {
        result.positiveCells += validity[block.cell(i)] == Valid;
        result.negativeCells += validity[block.cell(i)] == Inverted;
      }
    }
  }
  if (cells == 0)
  {
    return result;
  }
  const bool haveSigns = this->Dim != Dimension::Surface;
  if (haveSigns && result.negativeCells == 0)
  {
    return result;
  }
  if (haveSigns && result.positiveCells == 0)
  {
    result.state = Orientation::Reversed;
    return result;
  }

  // Signs differ (a tangled or a mixed mesh), or there are none (a surface): compare neighbours.
  UnionFind sets(this->View.numberOfCells);
  FacetTable(*this).forEachFacet(
    [&](Index, const FacetUse* uses, Index count)
    {
      if (count == 2)
      {
        result.disagreeing += uses[0].forward == uses[1].forward;
        sets.join(uses[0].cell, uses[1].cell);
      }
    });

  countParts(*this, validity, sets, result);
  if (result.disagreeing > 0 || (result.reversedParts > 0 && result.reversedParts < result.parts))
  {
    result.state = Orientation::Mixed;
  }
  else if (result.reversedParts > 0)
  {
    result.state = Orientation::Reversed;
  }
  return result;
}

//------------------------------------------------------------------------------
CellOrder consistentOrder(const Mesh& mesh, const signed char* validity)
{
  const MeshView& view = mesh.view();
  const Index n = view.numberOfCells;
  // Cell c in the order it has is c, in the opposite order c + n. Orders that agree are in one set;
  // where a cell is in one set with its own opposite, its part has no consistent order.
  UnionFind sets(2 * n);
  FacetTable(mesh).forEachFacet(
    [&](Index, const FacetUse* uses, Index count)
    {
      if (count == 2)
      {
        const Index a = uses[0].cell, b = uses[1].cell;
        const Index other = uses[0].forward == uses[1].forward ? n : 0;
        sets.join(a, b + other);
        sets.join(a + n, b + n - other);
      }
    });

  CellOrder order;
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  const bool haveSigns = mesh.dimension() != Dimension::Surface;
  const double sign = mesh.mirrored() ? -1 : 1;
  constexpr Index enough = 10; // cells of a part, so that it is not a piece of inverted ones
  const Vec3 origin = finitePoint(view);
  // By the first cell of each part: sizes, cells in the order of that one less those in the
  // opposite order, and all cells.
  std::vector<PartSign> signs(n);
  std::vector<Index> alike(n, 0), size(n, 0);
  std::vector<unsigned char> opposite(n, 0);
  std::vector<std::pair<Index, CellType>> ofDimension;
  for (const CellBlock& block : mesh.blocks())
  {
    for (Index i = 0; i < block.count && topology(block.type).dimension == dimension; ++i)
    {
      ofDimension.emplace_back(block.cell(i), block.type);
    }
  }
  order.cells = static_cast<Index>(ofDimension.size());
  for (const auto& [cell, type] : ofDimension)
  {
    const Index as = sets.find(cell), against = sets.find(cell + n);
    if (as == against)
    {
      order.ambiguous += as == cell;
      order.firstAmbiguous = order.firstAmbiguous < 0 ? cell : order.firstAmbiguous;
      continue;
    }
    const Index part = std::min(as, against);
    opposite[cell] = as != part;
    ++size[part];
    alike[part] += opposite[cell] ? -1 : 1;
    if (haveSigns && validity[cell] >= Inverted)
    {
      const double own =
        signedSize(mesh, topology(type), view.connectivity + view.offsets[cell], origin);
      signs[part].add(opposite[cell] ? -own : own,
        opposite[cell] ? -static_cast<int>(validity[cell]) : validity[cell]);
    }
  }
  for (const auto& item : ofDimension)
  {
    const Index cell = item.first;
    const Index as = sets.find(cell), against = sets.find(cell + n);
    if (as != against)
    {
      const Index part = std::min(as, against);
      bool turn = !haveSigns ? alike[part] < 0 : signs[part].reversed(sign);
      if (haveSigns && alike[part] == size[part])
      {
        // Nothing but the sign of the part tells its order. A few cells may be inverted ones.
        turn = turn && size[part] >= enough && signs[part].majority == -size[part];
      }
      opposite[cell] = opposite[cell] != turn;
      order.reversed += opposite[cell];
    }
  }
  if (order.reversed > 0)
  {
    order.reverse = std::move(opposite);
  }
  return order;
}

//------------------------------------------------------------------------------
void reverseCell(CellType type, Index* nodes)
{
  switch (type)
  {
    case CellType::Triangle:
    case CellType::Tetrahedron:
      std::swap(nodes[1], nodes[2]);
      return;
    case CellType::Quadrilateral:
    case CellType::Pyramid:
      std::swap(nodes[1], nodes[3]);
      return;
    case CellType::Hexahedron:
      std::swap_ranges(nodes, nodes + 4, nodes + 4);
      return;
    case CellType::Wedge:
      std::swap_ranges(nodes, nodes + 3, nodes + 3);
      return;
    default:
      throw Error("Only triangles, quadrilaterals, tetrahedra, hexahedra, wedges and pyramids can "
                  "be listed in the opposite order.");
  }
}
}
