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

/// The cells of each type and order.
std::map<CellKey, std::vector<Index>> sortCells(
  const Mesh& mesh, const CurvedCellFacts& facts, bool linear)
{
  const MeshView& view = mesh.view();
  std::map<CellKey, std::vector<Index>> cells;
  for (Index c = 0; c < view.numberOfCells; ++c)
  {
    const int type = view.cellTypes[c];
    const bool rational = facts.rational && type >= firstBezier && type <= lastBezier;
    const bool wanted =
      isHigherOrder(type) || (linear && cornerType(type) != CellType::Unsupported);
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

/// The type of some cells, or null where it is not supported. Orders that do not fit the number of
/// nodes are ignored: special numbers of nodes have none.
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

void certifyCells(JacobianCertifier& certifier, const Mesh& mesh, const CurvedGroup& group,
  const std::vector<Index>& positions, signed char* validity, double* minimum)
{
  const double* points = mesh.view().points;
  std::vector<const Index*> nodes;
  for (Index i : positions)
  {
    nodes.push_back(group.nodes(i));
  }
  std::vector<ElementValidity> verdicts(nodes.size());
  if (!minimum)
  {
    certifier.classify(points, nodes.data(), static_cast<Index>(nodes.size()), verdicts.data());
  }
  MinimumTolerance tolerance;
  tolerance.relative = 1e-8;
  for (std::size_t n = 0; n < nodes.size(); ++n)
  {
    const Index cell = group.cell(positions[n]);
    if (minimum)
    {
      const JacobianBound bound = certifier.minimum(points, nodes[n], tolerance);
      verdicts[n] = bound.validity;
      // The bounds of a minimum near 0 may have different signs.
      const bool below = bound.validity == ElementValidity::Invalid && !(bound.upper < 0);
      minimum[cell] = bound.validity == ElementValidity::NonFinite ? 0
        : below                                                    ? bound.lower
                                                                   : bound.upper;
    }
    validity[cell] = static_cast<signed char>(verdicts[n]);
  }
}

void certifyGroup(
  const Mesh& mesh, const CurvedGroup& group, signed char* validity, double* minimum, int threads)
{
  forEachChunk(group.count(), threads,
    [&](Index, Index begin, Index end)
    {
      for (bool mirrored : { false, true })
      {
        std::vector<Index> positions;
        for (Index i = begin; i < end; ++i)
        {
          if (group.mirrored(i) == mirrored)
          {
            positions.push_back(i);
          }
        }
        if (!positions.empty())
        {
          JacobianCertifier certifier(group.type(), group.normal(), mirrored);
          certifyCells(certifier, mesh, group, positions, validity, minimum);
        }
      }
    });
}

static_assert(static_cast<int>(ElementValidity::Valid) == Valid &&
    static_cast<int>(ElementValidity::Degenerate) == Degenerate &&
    static_cast<int>(ElementValidity::Invalid) == Inverted &&
    static_cast<int>(ElementValidity::NonFinite) == NonFinite,
  "both have the same codes");
}

//------------------------------------------------------------------------------
CurvedGroup::CurvedGroup(const Mesh& mesh, int vtkType, const ElementType& type,
  std::vector<Index> cells, const CurvedCellFacts& facts)
  : Type(&type)
  , Cells(std::move(cells))
  , Reversed(facts.reversed)
  , Turned(facts.wedgesTurned && (vtkType == lagrangeWedge || vtkType == bezierWedge))
  , Normal(mesh.dimension() == Dimension::Planar ? mesh.normal() : Vec3{ 0, 0, 0 })
  , Mirrored(mesh.mirrored())
{
  const MeshView& view = mesh.view();
  for (Index c : this->Cells)
  {
    const Index* nodes = view.connectivity + view.offsets[c];
    this->Nodes.push_back(nodes);
    if (this->changed(c))
    {
      this->Restored.insert(this->Restored.end(), nodes, nodes + type.nodes());
    }
  }
  // In the order of the file; reversed cells have the opposite sign there.
  Index* own = this->Restored.data();
  for (std::size_t i = 0; i < this->Cells.size(); ++i)
  {
    if (this->changed(this->Cells[i]))
    {
      this->restore(cornerType(vtkType), this->Cells[i], own);
      this->Nodes[i] = own;
      own += type.nodes();
    }
  }
  if (type.shape() == ElementShape::Wedge)
  {
    this->Mirrored = orientationOf(type, view.points, this->Nodes.data(), this->count()).mirrored();
  }
}

//------------------------------------------------------------------------------
void CurvedGroup::restore(CellType corners, Index cell, Index* nodes) const
{
  if (this->reversed(cell))
  {
    reverseCell(corners, nodes);
  }
  if (this->Turned)
  {
    std::swap(nodes[1], nodes[2]);
    std::swap(nodes[4], nodes[5]);
  }
}

//------------------------------------------------------------------------------
std::vector<CurvedGroup> curvedGroups(const Mesh& mesh, const CurvedCellFacts& facts, bool linear)
{
  std::vector<CurvedGroup> groups;
  for (auto& [key, cells] : sortCells(mesh, facts, linear))
  {
    if (const ElementType* type = typeOf(key))
    {
      groups.emplace_back(mesh, std::get<0>(key), *type, std::move(cells), facts);
    }
  }
  return groups;
}

//------------------------------------------------------------------------------
Index certifyCurvedCells(const Mesh& mesh, const CurvedCellFacts& facts, signed char* validity,
  double* minimum, int threads)
{
  Index certified = 0;
  if (mesh.higherOrderCells() == 0)
  {
    return certified;
  }
  for (const CurvedGroup& group : curvedGroups(mesh, facts))
  {
    certifyGroup(mesh, group, validity, minimum, threads);
    certified += group.count();
  }
  return certified;
}
}
