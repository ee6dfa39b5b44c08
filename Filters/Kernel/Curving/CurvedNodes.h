// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedNodes.h
 * @brief The positions of the nodes of a curved cell on its edges and faces, and how inner nodes
 * follow the nodes on edges and faces.
 * Internal: not installed.
 */
#ifndef tautline_CurvedNodes_h
#define tautline_CurvedNodes_h

#include "tautline/Elements/ElementType.h"
#include "tautline/Mesh/CellTopology.h"

#include <vector>

namespace tautline
{
/// A VTK type with its number of nodes; also used for lines.
struct VtkCellType
{
  int vtkType = 0, nodes = 0;
};

/**
 * @brief The cells of an order: for order 2, VTK's quadratic cells with full polynomials or its
 * serendipity cells; for higher orders, Lagrange cells.
 * @throws Error for pyramids of order 3 and above, which VTK does not support
 */
VtkCellType curvedType(CellType corners, int order, bool serendipity);
/// The same for lines.
VtkCellType curvedLine(int order);

/// A value at a node as a sum over other nodes.
struct NodeWeight
{
  int node;
  double weight;
};
using NodeWeights = std::vector<NodeWeight>;

/// A part of a node's name: the weight of a corner in the linear cell, as a multiple of 1 /
/// NameUnits. These parts, keyed by corner ids, are the same in all cells that share the node.
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
  std::vector<CornerShare> corners; ///< corners with nonzero weight; empty inside
  std::vector<double> linear;       ///< the share of each corner, 0 to 1
  Vec3 at;                          ///< reference coordinates
  /// For nodes on faces and inside: the displacement in terms of the edge and face nodes.
  NodeWeights follows;
};

/**
 * @brief The nodes of a type; built once per type.
 *
 * The displacement of an edge is extended over a triangle, with barycentric coordinates a and b of
 * its ends, by (a + b)^p d(b / (a + b)), which is a polynomial of the order p of the edge; and over
 * a quadrilateral linearly to the opposite side. Displacements of faces, minus the displacements of
 * their edges, are extended over cells in the same way: transfinite interpolation (W. Gordon, C.
 * Hall, "Transfinite element methods", Numer. Math. 21, 1973; for simplices, P. Solin, K. Segeth,
 * I. Dolezel, "Higher-Order Finite Element Methods", 2003).
 */
std::vector<CurvedNode> curvedNodes(CellType corners, const VtkCellType& type);
/// The same for lines.
std::vector<CurvedNode> curvedLineNodes(int order);

/// The values at t, 0 to 1, of the polynomials of an order on a line with nodes in VTK's order: the
/// ends, then the inner nodes.
std::vector<double> lineFunctions(int order, double t);
}
#endif
