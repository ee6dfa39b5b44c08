// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedNodes.h
 * @brief Where the nodes of a curved cell are: on which of its edges and faces, and how the nodes
 * inside follow those on its edges and faces.
 * Internal: not installed.
 */
#ifndef tautline_CurvedNodes_h
#define tautline_CurvedNodes_h

#include "tautline/Elements/ElementType.h"
#include "tautline/Mesh/CellTopology.h"

#include <vector>

namespace tautline
{
/// A VTK type with its number of nodes; of a line, too.
struct VtkCellType
{
  int vtkType = 0, nodes = 0;
};

/**
 * @brief The cells of an order: VTK's quadratic cells of all polynomials, or its serendipity cells,
 * for order 2, Lagrange cells above.
 * @throws Error for pyramids of order 3 and above, which VTK does not have
 */
VtkCellType curvedType(CellType corners, int order, bool serendipity);
/// The same of lines.
VtkCellType curvedLine(int order);

/// A value at a node as a sum over other nodes.
struct NodeWeight
{
  int node;
  double weight;
};
using NodeWeights = std::vector<NodeWeight>;

/// A part of a node's name: of how much weight a corner is in the linear cell, as a multiple of
/// 1 / NameUnits. The parts, by ids of corners, are the same in all cells that share the node.
struct CornerShare
{
  int corner, share;
};
/// A multiple of the denominators of all nodes of order 4 on edges and faces.
constexpr int NameUnits = 144;

enum class NodePlace : unsigned char
{
  Corner,
  Edge,
  Face,
  Inside
};

/// A node of the cells of a type.
struct CurvedNode
{
  NodePlace place;
  std::vector<CornerShare> corners; ///< those with a share; empty inside
  std::vector<double> linear;       ///< the share of each corner, 0 to 1
  Vec3 at;                          ///< reference coordinates
  /// The displacement that follows from those of edge and face nodes; of nodes on faces and inside.
  NodeWeights follows;
};

/**
 * @brief The nodes of a type; built once per type.
 *
 * The displacement of an edge is extended over a triangle, with barycentric coordinates a and b of
 * its ends, by (a + b)^p d(b / (a + b)), which is a polynomial of the order p of the edge; over a
 * quadrilateral linearly to the opposite side. Displacements of faces, less those of their edges,
 * are extended over cells in the same way: transfinite interpolation (W. Gordon, C. Hall,
 * "Transfinite element methods", Numer. Math. 21, 1973; of simplices P. Solin, K. Segeth,
 * I. Dolezel, "Higher-Order Finite Element Methods", 2003).
 */
std::vector<CurvedNode> curvedNodes(CellType corners, const VtkCellType& type);
/// The same of lines.
std::vector<CurvedNode> curvedLineNodes(int order);

/// The values at t, 0 to 1, of the polynomials of an order on a line with nodes in VTK's order: the
/// ends, then those between.
std::vector<double> lineFunctions(int order, double t);
}
#endif
