// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedCells.h"

#include "CellOrder.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Elements/JacobianCertifier.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace tautline
{
namespace
{
using CellKey = std::tuple<int, int, ElementOrders>; // VTK type, nodes, orders

constexpr int firstBezier = 75, lastBezier = 81; // of VTK
constexpr int lagrangeWedge = 73, bezierWedge = 80;

/// The curved cells of each type and order.
std::map<CellKey, std::vector<Index>> sortCells(
  const Mesh& mesh, const CurvedCellFacts& facts, bool linear)
{
  const MeshView& view = mesh.view();
  std::map<CellKey, std::vector<Index>> cells;
  for (Index c = 0; c < view.numberOfCells; ++c)
  {
    const int type = view.cellTypes[c];
    const bool rational = facts.rational && type >= firstBezier && type <= lastBezier;
    const bool wanted = isHigherOrder(type) ||
      (linear && cornerType(static_cast<unsigned char>(type)) != CellType::Unsupported);
    if (!wanted || rational)
    {
      continue;
    }
    ElementOrders orders = { 0, 0, 0 };
    for (std::size_t axis = 0; axis < orders.size() && facts.degrees; ++axis)
    {
      const double degree = facts.degrees[3 * c + static_cast<Index>(axis)];
      orders[axis] = degree >= 1 && degree <= MaxElementOrder ? static_cast<int>(degree) : 0;
    }
    cells[{ type, static_cast<int>(view.offsets[c + 1] - view.offsets[c]), orders }].push_back(c);
  }
  return cells;
}

/// The type of some cells, or null if it is not supported. Orders that do not match the number of
/// nodes are ignored: special node counts have none.
const ElementType* typeOf(const CellKey& key)
{
  const auto& [type, nodes, given] = key;
  for (const ElementOrders& orders : { given, ElementOrders{ 0, 0, 0 } })
  {
    try
    {
      return &ElementType::ofVtk(type, nodes, orders);
    }
    catch (const Error&)
    {
    }
  }
  return nullptr;
}

/// The nodes of a cell in the order of the file.
void restore(unsigned char vtkType, bool isReversed, bool turned, Index* nodes)
{
  if (isReversed)
  {
    reverseCell(cornerType(vtkType), nodes);
  }
  if (turned)
  {
    std::swap(nodes[1], nodes[2]);
    std::swap(nodes[4], nodes[5]);
  }
}

CurvedBlock blockOf(const Mesh& mesh, int vtkType, const ElementType& type,
  const std::vector<Index>& cells, const CurvedCellFacts& facts)
{
  const MeshView& view = mesh.view();
  const bool turned = facts.wedgesTurned && (vtkType == lagrangeWedge || vtkType == bezierWedge);
  const auto reversed = [&](Index cell) { return facts.reversed && facts.reversed[cell]; };
  const auto changed = [&](Index cell) { return turned || reversed(cell); };
  CurvedBlock block;
  block.type = &type;
  block.cells = cells;
  block.normal = mesh.dimension() == Dimension::Planar ? mesh.normal() : Vec3{ 0, 0, 0 };
  for (Index c : cells)
  {
    const Index* nodes = view.connectivity + view.offsets[c];
    block.nodes.push_back(nodes);
    if (changed(c))
    {
      block.restored.insert(block.restored.end(), nodes, nodes + type.nodes());
    }
  }
  // In file order, reversed cells have the opposite sign.
  Index* own = block.restored.data();
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    if (changed(cells[i]))
    {
      restore(view.cellTypes[cells[i]], reversed(cells[i]), turned, own);
      block.nodes[i] = own;
      own += type.nodes();
    }
  }
  const bool mirrored = type.shape() == ElementShape::Wedge
    ? orientationOf(type, view.points, block.nodes.data(), block.count()).mirrored()
    : mesh.mirrored();
  const bool byCoordinates = vtkType == lagrangeWedge || vtkType == bezierWedge;
  block.turned =
    type.shape() == ElementShape::Wedge && isHigherOrder(vtkType) && mirrored == byCoordinates;
  for (Index c : cells)
  {
    block.mirrored.push_back(mirrored != reversed(c));
  }
  return block;
}

void certifyCells(const CurvedBlock& block, JacobianCertifier& certifier, const double* points,
  const std::vector<Index>& positions, signed char* validity, CurvedMinimum* minima)
{
  std::vector<const Index*> nodes;
  for (Index i : positions)
  {
    nodes.push_back(block.nodes[i]);
  }
  std::vector<ElementValidity> verdicts(nodes.size());
  if (!minima)
  {
    certifier.classify(points, nodes.data(), static_cast<Index>(nodes.size()), verdicts.data());
  }
  MinimumTolerance tolerance;
  tolerance.relative = 1e-8;
  for (std::size_t n = 0; n < nodes.size(); ++n)
  {
    const Index cell = block.cells[positions[n]];
    if (minima)
    {
      const JacobianBound bound = certifier.minimum(points, nodes[n], tolerance);
      verdicts[n] = bound.validity;
      // The bounds of a minimum near 0 may have different signs.
      const bool below = bound.validity == ElementValidity::Invalid && !(bound.upper < 0);
      minima[cell].value = bound.validity == ElementValidity::NonFinite ? 0
        : below                                                         ? bound.lower
                                                                        : bound.upper;
      minima[cell].lower = bound.validity == ElementValidity::NonFinite ? 0 : bound.lower;
      minima[cell].at = bound.at;
    }
    validity[cell] = static_cast<signed char>(verdicts[n]);
  }
}

static_assert(static_cast<int>(ElementValidity::Valid) == Valid &&
    static_cast<int>(ElementValidity::Degenerate) == Degenerate &&
    static_cast<int>(ElementValidity::Invalid) == Inverted &&
    static_cast<int>(ElementValidity::NonFinite) == NonFinite,
  "both use the same codes");
}

//------------------------------------------------------------------------------
std::vector<Index> CurvedBlock::positions(Index begin, Index end, bool isMirrored) const
{
  std::vector<Index> found;
  for (Index i = begin; i < end; ++i)
  {
    if (static_cast<bool>(this->mirrored[i]) == isMirrored)
    {
      found.push_back(i);
    }
  }
  return found;
}

//------------------------------------------------------------------------------
std::vector<CurvedBlock> curvedBlocks(const Mesh& mesh, const CurvedCellFacts& facts, bool linear)
{
  std::vector<CurvedBlock> blocks;
  if (mesh.higherOrderCells() == 0 && !linear)
  {
    return blocks;
  }
  for (const auto& [key, cells] : sortCells(mesh, facts, linear))
  {
    if (const ElementType* type = typeOf(key))
    {
      blocks.push_back(blockOf(mesh, std::get<0>(key), *type, cells, facts));
    }
  }
  return blocks;
}

//------------------------------------------------------------------------------
void certifyBlocks(const std::vector<CurvedBlock>& blocks, const double* points,
  signed char* validity, CurvedMinimum* minima, int threads)
{
  for (const CurvedBlock& block : blocks)
  {
    forEachChunk(block.count(), threads,
      [&](Index, Index begin, Index end)
      {
        for (bool mirrored : { false, true })
        {
          const std::vector<Index> positions = block.positions(begin, end, mirrored);
          if (!positions.empty())
          {
            JacobianCertifier certifier(*block.type, block.normal, mirrored);
            certifyCells(block, certifier, points, positions, validity, minima);
          }
        }
      });
  }
}

//------------------------------------------------------------------------------
Index certifyCurvedCells(const Mesh& mesh, const CurvedCellFacts& facts, signed char* validity,
  double* minimum, int threads)
{
  const std::vector<CurvedBlock> blocks = curvedBlocks(mesh, facts);
  std::vector<CurvedMinimum> minima(minimum && !blocks.empty() ? mesh.view().numberOfCells : 0);
  certifyBlocks(
    blocks, mesh.view().points, validity, minima.empty() ? nullptr : minima.data(), threads);
  Index certified = 0;
  for (const CurvedBlock& block : blocks)
  {
    certified += block.count();
    for (Index cell : block.cells)
    {
      if (minimum)
      {
        minimum[cell] = minima[cell].value;
      }
    }
  }
  return certified;
}

//------------------------------------------------------------------------------
void boundJacobians(const Mesh& mesh, const CurvedCellFacts& facts, double* lower, int threads)
{
  const Index cells = mesh.view().numberOfCells;
  std::vector<signed char> validity(cells);
  std::vector<CurvedMinimum> minima(cells);
  certifyBlocks(
    curvedBlocks(mesh, facts, true), mesh.view().points, validity.data(), minima.data(), threads);
  std::transform(minima.begin(), minima.end(), lower,
    [](const CurvedMinimum& minimum) { return minimum.lower; });
}
}
