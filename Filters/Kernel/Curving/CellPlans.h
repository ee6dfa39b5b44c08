// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellPlans.h
 * @brief How each cell type is converted when a mesh is curved.
 * Internal: not installed.
 */
#ifndef tautline_CellPlans_h
#define tautline_CellPlans_h

#include "CurvedNodes.h"
#include "tautline/Mesh/CurvedCells.h"

#include <map>
#include <tuple>

namespace tautline
{
/// The nodes of converted cells. Positions are indices in the node list of the given cell.
struct CellPlan
{
  VtkCellType type;
  std::vector<CurvedNode> nodes;
  std::vector<int> corners; ///< per corner of the new cell: its position
  /// Per node: the shape function values of the given cell there, by position.
  std::vector<NodeWeights> given;
  bool curved = false;     ///< whether the given cell is curved
  bool reversible = false; ///< whether the cell has one of topologies()
};

class CellPlans
{
public:
  CellPlans(const MeshView& cells, const CurvedCellFacts& facts, int order, bool serendipity)
    : View(cells)
    , Facts(facts)
    , Order(order)
    , Serendipity(serendipity)
  {
  }

  /// Throws Error for cells that cannot be curved.
  void requireSupported() const;
  const CellPlan& of(Index cell);

private:
  using Key = std::tuple<int, int, ElementOrders>; // VTK type, nodes, orders

  ElementOrders ordersOf(Index cell) const;
  CellPlan make(int vtkType, int nodes, const ElementOrders& orders) const;
  CellPlan makeLine(int nodes) const;

  const MeshView& View;
  const CurvedCellFacts& Facts;
  int Order;
  bool Serendipity;
  std::map<Key, CellPlan> Plans;
};
}
#endif
