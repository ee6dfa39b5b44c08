// SPDX-License-Identifier: BSD-3-Clause
#include "CellPlans.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <iterator>

namespace tautline
{
namespace
{
constexpr int vertex = 1, polyVertex = 2; // of VTK
constexpr int lines[] = { 3, 21, 35, 68 };
constexpr int lagrangeWedge = 73, bezierWedge = 80;
constexpr int firstBezier = 75, lastBezier = 81;

bool isLine(int vtkType)
{
  return std::find(std::begin(lines), std::end(lines), vtkType) != std::end(lines);
}

/// Lagrange and Bezier wedges list their triangles from inside, unlike other wedges.
bool isFromInside(int vtkType)
{
  return vtkType == lagrangeWedge || vtkType == bezierWedge;
}

/// A corner of a wedge that lists its triangles from the other side.
int turned(int corner)
{
  constexpr int other[] = { 0, 2, 1, 3, 5, 4 };
  return corner < static_cast<int>(std::size(other)) ? other[corner] : corner;
}

std::string nameOf(int vtkType)
{
  switch (vtkType)
  {
    case 4:
      return "polylines";
    case 6:
      return "triangle strips";
    case 7:
      return "polygons";
    case 42:
      return "polyhedra";
    default:
      return "cells of the VTK type " + std::to_string(vtkType);
  }
}

NodeWeights weightsOf(const std::vector<double>& functions)
{
  NodeWeights weights;
  for (std::size_t n = 0; n < functions.size(); ++n)
  {
    // At the nodes of the given cell all functions but one vanish up to rounding; dropping them
    // keeps the lists short.
    constexpr double rounding = 1e-14;
    if (std::abs(functions[n]) > rounding)
    {
      weights.push_back({ static_cast<int>(n), functions[n] });
    }
  }
  return weights;
}
}

//------------------------------------------------------------------------------
void CellPlans::requireSupported() const
{
  std::map<int, Index> refused;
  Index rational = 0;
  for (Index cell = 0; cell < this->View.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const int type = this->View.cellTypes[cell];
    if (type != vertex && type != polyVertex && type != 0 && !isLine(type) &&
      cornerType(type) == CellType::Unsupported)
    {
      ++refused[type];
    }
    rational += this->Facts.rational && type >= firstBezier && type <= lastBezier;
  }
  if (!refused.empty())
  {
    const auto& [type, number] = *refused.begin();
    throw Error(std::to_string(number) + " " + nameOf(type) +
      " cannot be curved: divide them into triangles or tetrahedra first (Tetrahedralize), or "
      "remove them (Extract Cells By Type).");
  }
  if (rational > 0)
  {
    throw Error(std::to_string(rational) +
      " cells are rational: they have weights (RationalWeights), which polynomial cells do not "
      "support. Convert them to Lagrange cells first.");
  }
}

//------------------------------------------------------------------------------
ElementOrders CellPlans::ordersOf(Index cell) const
{
  ElementOrders orders = { 0, 0, 0 };
  for (std::size_t axis = 0; axis < orders.size() && this->Facts.degrees; ++axis)
  {
    const double degree = this->Facts.degrees[3 * cell + static_cast<Index>(axis)];
    // An order that is not valid becomes 0, which means unknown: the array may contain anything.
    orders[axis] = degree >= 1 && degree <= MaxElementOrder ? static_cast<int>(degree) : 0;
  }
  return orders;
}

//------------------------------------------------------------------------------
const CellPlan& CellPlans::of(Index cell)
{
  const int type = this->View.cellTypes[cell];
  const int nodes = static_cast<int>(this->View.offsets[cell + 1] - this->View.offsets[cell]);
  const ElementOrders orders =
    isHigherOrder(type) ? this->ordersOf(cell) : ElementOrders{ 0, 0, 0 };
  const Key key = { type, nodes, orders };
  auto at = this->Plans.find(key);
  if (at == this->Plans.end())
  {
    at = this->Plans.emplace(key, this->make(type, nodes, orders)).first;
  }
  return at->second;
}

//------------------------------------------------------------------------------
CellPlan CellPlans::makeLine(int nodes) const
{
  CellPlan plan;
  plan.type = curvedLine(this->Order);
  plan.nodes = curvedLineNodes(this->Order);
  plan.corners = { 0, 1 };
  plan.curved = nodes > 2;
  for (const CurvedNode& node : plan.nodes)
  {
    plan.given.push_back(weightsOf(lineFunctions(nodes - 1, node.at[0])));
  }
  return plan;
}

//------------------------------------------------------------------------------
CellPlan CellPlans::make(int vtkType, int nodes, const ElementOrders& orders) const
{
  if (isLine(vtkType))
  {
    return this->makeLine(nodes);
  }
  CellPlan plan;
  const CellType corners = cornerType(vtkType);
  if (corners == CellType::Unsupported)
  {
    // Vertices and cells without points stay unchanged.
    plan.type = { vtkType, nodes };
    for (int n = 0; n < nodes; ++n)
    {
      plan.nodes.push_back({ NodePlace::Corner, { { n, NameUnits } }, {}, {}, {} });
      plan.corners.push_back(n);
      plan.given.push_back({ { n, 1.0 } });
    }
    return plan;
  }
  plan.type = curvedType(corners, this->Order, this->Serendipity);
  plan.nodes = curvedNodes(corners, plan.type);
  plan.curved = isHigherOrder(vtkType);
  plan.reversible = true;
  const ElementType* given = nullptr;
  try
  {
    given = &ElementType::ofVtk(vtkType, nodes, orders);
  }
  catch (const Error&)
  {
    given = &ElementType::ofVtk(vtkType, nodes); // special node counts have no orders
  }
  // `turns` converts between the numberings of wedges of the input and output types; `changed`
  // undoes a conversion of the cells that the caller has made.
  const bool turns = isFromInside(vtkType) != isFromInside(plan.type.vtkType);
  const bool changed = isFromInside(vtkType) && this->Facts.wedgesTurned;
  const auto position = [&](int node) { return changed ? turned(node) : node; };
  for (int c = 0; c < topology(corners).nodes; ++c)
  {
    plan.corners.push_back(position(turns ? turned(c) : c));
  }
  for (const CurvedNode& node : plan.nodes)
  {
    const Vec3& x = node.at;
    // Exchanging corners 1 and 2 of both triangles exchanges the first two reference coordinates.
    NodeWeights weights = weightsOf(given->shapeFunctions(turns ? Vec3{ x[1], x[0], x[2] } : x));
    for (NodeWeight& weight : weights)
    {
      weight.node = position(weight.node);
    }
    plan.given.push_back(std::move(weights));
  }
  return plan;
}
}
