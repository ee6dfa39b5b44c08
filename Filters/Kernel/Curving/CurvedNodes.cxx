// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedNodes.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
constexpr double rounding = 1e-12;
constexpr int quadraticEdge = 21, lagrangeCurve = 68; // of VTK
constexpr int line = 3;

int count(int n, int p)
{
  int product = 1;
  for (int k = 0; k < n; ++k)
  {
    product *= p + 1;
  }
  return product;
}

/// The order-2 types with full polynomials, and the serendipity types.
struct QuadraticTypes
{
  CellType corners;
  VtkCellType full, serendipity;
};
constexpr QuadraticTypes quadraticTypes[] = {
  { CellType::Triangle, { 22, 6 }, { 22, 6 } },
  { CellType::Quadrilateral, { 28, 9 }, { 23, 8 } },
  { CellType::Tetrahedron, { 24, 10 }, { 24, 10 } },
  { CellType::Hexahedron, { 29, 27 }, { 25, 20 } },
  { CellType::Wedge, { 32, 18 }, { 26, 15 } },
  { CellType::Pyramid, { 37, 19 }, { 27, 13 } },
};

/// The corner weights of a cell at a reference position.
std::vector<double> cornerShares(CellType corners, const Vec3& at)
{
  const CellTopology& t = topology(corners);
  return ElementType::ofVtk(static_cast<int>(corners), t.nodes).shapeFunctions(at);
}

/// The projection of a position in a cell onto an edge or face of the cell.
struct Shadow
{
  double size = 0;            ///< the sum of the sizes of its corners
  std::vector<double> shares; ///< weights of its corners, which add up to 1
};

Shadow shadowOn(const std::vector<double>& shares, const std::vector<int>& corners)
{
  Shadow shadow;
  for (int c : corners)
  {
    shadow.shares.push_back(shares[c]);
    shadow.size += shares[c];
  }
  for (double& share : shadow.shares)
  {
    share = shadow.size > rounding ? share / shadow.size : 0;
  }
  return shadow;
}

class Follower
{
public:
  Follower(CellType corners, int order, std::vector<CurvedNode>& nodes)
    : Topology(topology(corners))
    , Order(order)
    , Nodes(nodes)
  {
  }

  void setAll()
  {
    for (NodePlace place : { NodePlace::Face, NodePlace::Inside })
    {
      for (CurvedNode& node : this->Nodes)
      {
        if (node.place == place)
        {
          this->set(node);
        }
      }
    }
  }

private:
  void set(CurvedNode& node) const;
  std::vector<double> ofEdges(const CurvedNode& node) const;
  double factorOf(const CurvedNode& node, const std::vector<int>& part) const;
  int find(const std::vector<CornerShare>& name) const;
  void addFace(const CurvedNode& node, int face, std::vector<double>& row) const;

  const CellTopology& Topology;
  int Order;
  std::vector<CurvedNode>& Nodes;
};

/// The node with a name; -1 if the type lacks it, as serendipity types do.
int Follower::find(const std::vector<CornerShare>& name) const
{
  for (std::size_t n = 0; n < this->Nodes.size(); ++n)
  {
    const std::vector<CornerShare>& own = this->Nodes[n].corners;
    const auto same = [](const CornerShare& a, const CornerShare& b)
    { return a.corner == b.corner && a.share == b.share; };
    if (std::is_permutation(own.begin(), own.end(), name.begin(), name.end(), same))
    {
      return static_cast<int>(n);
    }
  }
  return -1;
}

/**
 * @brief The factor of the displacement of an edge or face at a node: the sum of the weights of its
 * corners, to the p-th power across triangles and to the first power across quadrilaterals.
 *
 * A wedge needs both factors: horizontally it is a triangle.
 */
double Follower::factorOf(const CurvedNode& node, const std::vector<int>& part) const
{
  const auto power = [this](double s) { return std::pow(s, this->Order); };
  const double size = shadowOn(node.linear, part).size;
  switch (this->Topology.type)
  {
    case CellType::Triangle:
    case CellType::Tetrahedron:
      return power(size);
    case CellType::Wedge:
    {
      constexpr int levels = 3; // corners 0 1 2 are below 3 4 5
      std::array<bool, levels> column = { false, false, false };
      std::array<bool, 2> level = { false, false };
      for (int c : part)
      {
        column[c % levels] = level[c / levels] = true;
      }
      double across = 0, along = 0;
      int columns = 0;
      for (int c = 0; c < levels; ++c)
      {
        across += column[c] ? node.linear[c] + node.linear[c + levels] : 0;
        columns += column[c];
        for (int k = 0; k < 2; ++k)
        {
          along += level[k] ? node.linear[c + levels * k] : 0;
        }
      }
      return (columns == 2 ? power(across) : across) * along;
    }
    default:
      return size;
  }
}

/// The displacement of a node caused by the edges alone, as one weight per node.
std::vector<double> Follower::ofEdges(const CurvedNode& node) const
{
  std::vector<double> row(this->Nodes.size(), 0.0);
  for (int e = 0; e < this->Topology.edges; ++e)
  {
    const auto& [a, b] = this->Topology.edgeNodes[e];
    const Shadow shadow = shadowOn(node.linear, { a, b });
    const double factor = this->factorOf(node, { a, b });
    if (!(shadow.size > rounding))
    {
      continue;
    }
    const std::vector<double> functions = lineFunctions(this->Order, shadow.shares[1]);
    for (int i = 1; i < this->Order; ++i)
    {
      const int share = NameUnits * i / this->Order;
      const int at = this->find({ { a, NameUnits - share }, { b, share } });
      // The first two functions belong to the ends of the edge, hence the shift.
      row[at] += factor * functions[i + 1];
    }
  }
  return row;
}

/// Adds the displacement that a face causes in addition to its edges.
void Follower::addFace(const CurvedNode& node, int face, std::vector<double>& row) const
{
  const int size = this->Topology.faceSizes[face];
  const auto& listed = this->Topology.faceNodes[face];
  const std::vector<int> corners(listed.begin(), listed.begin() + size);
  const Shadow shadow = shadowOn(node.linear, corners);
  if (!(shadow.size > rounding))
  {
    return;
  }
  const double factor = this->factorOf(node, corners);
  const bool triangle = size == 3;
  constexpr int lagrangeTriangle = 69, lagrangeQuadrilateral = 70;
  const int nodes = triangle ? (this->Order + 1) * (this->Order + 2) / 2 : count(2, this->Order);
  const ElementType& type =
    ElementType::ofVtk(triangle ? lagrangeTriangle : lagrangeQuadrilateral, nodes);
  const std::vector<double>& s = shadow.shares;
  const Vec3 at = triangle ? Vec3{ s[1], s[2], 0 } : Vec3{ s[1] + s[2], s[2] + s[3], 0 };
  const std::vector<double> functions = type.shapeFunctions(at);
  const CellType shape = triangle ? CellType::Triangle : CellType::Quadrilateral;
  // Lagrange faces list their corners, then the nodes on edges, then the nodes inside.
  for (int n = size + size * (this->Order - 1); n < nodes; ++n)
  {
    const std::vector<double> shares = cornerShares(shape, type.coordinates()[n]);
    std::vector<CornerShare> name;
    for (int k = 0; k < size; ++k)
    {
      name.push_back({ corners[k], static_cast<int>(std::lround(NameUnits * shares[k])) });
    }
    const int found = this->find(name);
    if (found < 0)
    {
      continue;
    }
    const double weight = factor * functions[n];
    row[found] += weight;
    // The edges of the face already displace its inner node: only the difference is added, as in a
    // Boolean sum.
    for (const NodeWeight& of : this->Nodes[found].follows)
    {
      row[of.node] -= weight * of.weight;
    }
  }
}

void Follower::set(CurvedNode& node) const
{
  std::vector<double> row = this->ofEdges(node);
  for (int face = 0; node.place == NodePlace::Inside && face < this->Topology.faces; ++face)
  {
    this->addFace(node, face, row);
  }
  for (std::size_t n = 0; n < row.size(); ++n)
  {
    if (std::abs(row[n]) > rounding)
    {
      node.follows.push_back({ static_cast<int>(n), row[n] });
    }
  }
}

/// For a pyramid: the quadratic one with 13 nodes, plus the middle of the base.
void setPyramid(std::vector<CurvedNode>& nodes)
{
  constexpr int edgesEnd = 13, base = 13;
  const ElementType& type = ElementType::ofVtk(27, edgesEnd);
  const auto ofEdges = [&](const Vec3& at)
  {
    NodeWeights weights;
    const std::vector<double> functions = type.shapeFunctions(at);
    for (int n = topology(CellType::Pyramid).nodes; n < edgesEnd; ++n)
    {
      weights.push_back({ n, functions[n] });
    }
    return weights;
  };
  for (std::size_t n = edgesEnd; n < nodes.size(); ++n)
  {
    nodes[n].follows = ofEdges(nodes[n].at);
    if (nodes[n].place == NodePlace::Inside)
    {
      // The bubble of the middle of the base vanishes at the apex, quadratically in the height.
      const double share = (1 - nodes[n].at[2]) * (1 - nodes[n].at[2]);
      for (const NodeWeight& of : ofEdges(nodes[base].at))
      {
        nodes[n].follows.push_back({ of.node, -share * of.weight });
      }
      nodes[n].follows.push_back({ base, share });
    }
  }
}
}

//------------------------------------------------------------------------------
VtkCellType curvedType(CellType corners, int order, bool serendipity)
{
  constexpr int lagrange = 69;
  if (order == 1)
  {
    return { static_cast<int>(corners), topology(corners).nodes };
  }
  for (const QuadraticTypes& types : quadraticTypes)
  {
    if (order == 2 && types.corners == corners)
    {
      return serendipity ? types.serendipity : types.full;
    }
  }
  const int p = order, triangle = (p + 1) * (p + 2) / 2;
  switch (corners)
  {
    case CellType::Triangle:
      return { lagrange, triangle };
    case CellType::Quadrilateral:
      return { lagrange + 1, count(2, p) };
    case CellType::Tetrahedron:
      return { lagrange + 2, triangle * (p + 3) / 3 };
    case CellType::Hexahedron:
      return { lagrange + 3, count(3, p) };
    case CellType::Wedge:
      return { lagrange + 4, triangle * (p + 1) };
    default:
      throw Error("VTK has no pyramids of order " + std::to_string(order) +
        ": choose order 2, or divide the pyramids into tetrahedra first (Tetrahedralize).");
  }
}

//------------------------------------------------------------------------------
VtkCellType curvedLine(int order)
{
  return { order == 1 ? line : order == 2 ? quadraticEdge : lagrangeCurve, order + 1 };
}

//------------------------------------------------------------------------------
std::vector<double> lineFunctions(int order, double t)
{
  // The node order of VTK: both ends first, then the inner nodes.
  std::vector<double> places = { 0, 1 }, values;
  for (int i = 1; i < order; ++i)
  {
    places.push_back(static_cast<double>(i) / order);
  }
  for (double own : places)
  {
    double value = 1;
    for (double other : places)
    {
      value *= other == own ? 1 : (t - other) / (own - other);
    }
    values.push_back(value);
  }
  return values;
}

//------------------------------------------------------------------------------
std::vector<CurvedNode> curvedNodes(CellType corners, const VtkCellType& type)
{
  const ElementType& element = ElementType::ofVtk(type.vtkType, type.nodes);
  const int dimension = topology(corners).dimension;
  std::vector<CurvedNode> nodes;
  for (const Vec3& at : element.coordinates())
  {
    CurvedNode node = { NodePlace::Inside, {}, cornerShares(corners, at), at, {} };
    for (std::size_t c = 0; c < node.linear.size(); ++c)
    {
      if (node.linear[c] > rounding)
      {
        const int share = static_cast<int>(std::lround(NameUnits * node.linear[c]));
        node.corners.push_back({ static_cast<int>(c), share });
      }
    }
    const int count = static_cast<int>(node.corners.size());
    // A node with four corners lies in a quadrilateral face, or inside a tetrahedron.
    const bool whole = corners == CellType::Tetrahedron && count == topology(corners).nodes;
    node.place = count == 1                                 ? NodePlace::Corner
      : count == 2                                          ? NodePlace::Edge
      : dimension == 2 || (count <= MaxFaceNodes && !whole) ? NodePlace::Face
                                                            : NodePlace::Inside;
    if (node.place == NodePlace::Inside)
    {
      node.corners.clear();
    }
    nodes.push_back(node);
  }
  const int order = element.orders()[0];
  if (corners == CellType::Pyramid)
  {
    setPyramid(nodes);
  }
  else if (order > 1)
  {
    Follower(corners, order, nodes).setAll();
  }
  return nodes;
}

//------------------------------------------------------------------------------
std::vector<CurvedNode> curvedLineNodes(int order)
{
  std::vector<CurvedNode> nodes;
  for (int n = 0; n <= order; ++n)
  {
    const double t = n < 2 ? n : static_cast<double>(n - 1) / order;
    const int share = NameUnits * (n < 2 ? n * order : n - 1) / order;
    CurvedNode node = { n < 2 ? NodePlace::Corner : NodePlace::Edge, { { 0, NameUnits - share } },
      { 1 - t, t }, { t, 0, 0 }, {} };
    if (n < 2)
    {
      node.corners = { { n, NameUnits } };
    }
    else
    {
      node.corners.push_back({ 1, share });
    }
    nodes.push_back(node);
  }
  return nodes;
}
}
