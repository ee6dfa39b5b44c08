// SPDX-License-Identifier: BSD-3-Clause
#include "VtkElement.h"

#include "VtkNodes.h"

#include <iterator>

namespace tautline
{
namespace
{
constexpr int specialTriangle = 7, specialTetrahedron = 15, specialWedge = 21;
constexpr double third = 1.0 / 3;

[[noreturn]] void reject(int vtkType, int nodes)
{
  throw Error("A cell of the VTK type " + std::to_string(vtkType) + " with " +
    std::to_string(nodes) +
    " nodes is not supported; use linear, quadratic, Lagrange or Bezier cells of order 1 to " +
    std::to_string(MaxElementOrder) + ".");
}

/// The orders of a Lagrange or Bezier cell.
ElementOrders findOrders(ElementShape shape, int vtkType, int nodes, const ElementOrders& orders)
{
  if (orders[0] != 0)
  {
    ElementOrders given = orders;
    given[2] = dimensionOf(shape) == 2 ? 0 : given[2];
    if (latticeSize(shape, given) != nodes)
    {
      throw Error("A cell of the VTK type " + std::to_string(vtkType) + " and the orders " +
        std::to_string(given[0]) + ", " + std::to_string(given[1]) + ", " +
        std::to_string(given[2]) + " has " + std::to_string(latticeSize(shape, given)) +
        " nodes, not " + std::to_string(nodes) + "; correct the array HigherOrderDegrees.");
    }
    return given;
  }
  for (int p = 1; p <= MaxElementOrder; ++p)
  {
    if (latticeSize(shape, uniformOrders(shape, p)) == nodes)
    {
      return uniformOrders(shape, p);
    }
  }
  reject(vtkType, nodes);
}

/// The Lagrange cells with bubbles: sets their basis and the nodes in addition to the quadratic
/// cell.
bool setSpecial(VtkElement& e, int nodes)
{
  const ElementOrders two = uniformOrders(e.shape, 2);
  if (e.shape == ElementShape::Triangle && nodes == specialTriangle)
  {
    e.coordinates = latticeNodes(e.shape, two);
    e.coordinates.push_back({ third, third, 0 });
    e.basis = bubbleTriangle();
  }
  else if (e.shape == ElementShape::Tetrahedron && nodes == specialTetrahedron)
  {
    e.coordinates = latticeNodes(e.shape, two);
    e.coordinates.insert(e.coordinates.end(),
      { { third, third, 0 }, { third, 0, third }, { third, third, third }, { 0, third, third },
        { 0.25, 0.25, 0.25 } });
    e.basis = bubbleTetrahedron();
  }
  else if (e.shape == ElementShape::Wedge && nodes == specialWedge)
  {
    // The middles of the triangles come before the middles of the other faces; the last is the
    // center.
    constexpr int edgesEnd = 15;
    e.coordinates = latticeNodes(e.shape, two);
    e.coordinates.insert(
      e.coordinates.begin() + edgesEnd, { { third, third, 0 }, { third, third, 1 } });
    e.coordinates.push_back({ third, third, 0.5 });
    e.basis = bubbleWedge();
  }
  else
  {
    return false;
  }
  e.orders = two;
  return true;
}

/// Which cells of VTK are linear or quadratic.
struct FixedType
{
  int vtkType;
  int nodes;
  ElementShape shape;
  ElementOrders orders;
};
constexpr FixedType fixedTypes[] = { { 5, 3, ElementShape::Triangle, { 1, 1, 0 } },
  { 9, 4, ElementShape::Quadrilateral, { 1, 1, 0 } },
  { 10, 4, ElementShape::Tetrahedron, { 1, 1, 1 } },
  { 12, 8, ElementShape::Hexahedron, { 1, 1, 1 } }, { 13, 6, ElementShape::Wedge, { 1, 1, 1 } },
  { 14, 5, ElementShape::Pyramid, { 1, 1, 1 } }, { 22, 6, ElementShape::Triangle, { 2, 2, 0 } },
  { 23, 8, ElementShape::Quadrilateral, { 2, 2, 0 } },
  { 24, 10, ElementShape::Tetrahedron, { 2, 2, 2 } },
  { 25, 20, ElementShape::Hexahedron, { 2, 2, 2 } }, { 26, 15, ElementShape::Wedge, { 2, 2, 2 } },
  { 27, 13, ElementShape::Pyramid, { 2, 2, 2 } },
  { 28, 9, ElementShape::Quadrilateral, { 2, 2, 0 } },
  { 29, 27, ElementShape::Hexahedron, { 2, 2, 2 } },
  { 30, 6, ElementShape::Quadrilateral, { 2, 1, 0 } }, { 31, 12, ElementShape::Wedge, { 2, 2, 1 } },
  { 32, 18, ElementShape::Wedge, { 2, 2, 2 } }, { 33, 24, ElementShape::Hexahedron, { 2, 2, 2 } },
  { 34, specialTriangle, ElementShape::Triangle, { 2, 2, 0 } },
  { 37, 19, ElementShape::Pyramid, { 2, 2, 2 } } };

/// The polynomials of the types with incomplete polynomial spaces.
ElementBasis fixedBasis(const FixedType& type)
{
  switch (type.vtkType)
  {
    case 23:
      return serendipityQuadrilateral();
    case 25:
      return serendipityHexahedron(false);
    case 26:
      return serendipityWedge();
    case 27:
      return quadraticPyramid();
    case 33:
      return serendipityHexahedron(true);
    case 34:
      return bubbleTriangle();
    case 37:
      return triquadraticPyramid();
    default:
      return completeBasis(type.shape, type.orders);
  }
}

/// The nodes, other than corners, that are means of corners.
CornerPatterns fixedPatterns(const FixedType& type)
{
  CornerPatterns middles = type.orders[0] > 1 ? edgePatterns(type.shape) : CornerPatterns();
  const auto append = [&](const CornerPatterns& more)
  { middles.insert(middles.end(), more.begin(), more.end()); };
  const CornerPatterns sides = { { 0, 4, 7, 3 }, { 1, 2, 6, 5 }, { 0, 1, 5, 4 }, { 3, 7, 6, 2 } };
  switch (type.vtkType)
  {
    case 28:
      append({ { 0, 1, 2, 3 } });
      break;
    case 29:
      append(sides);
      append({ { 0, 3, 2, 1 }, { 4, 5, 6, 7 }, { 0, 1, 2, 3, 4, 5, 6, 7 } });
      break;
    case 30:
      middles = { { 0, 1 }, { 2, 3 } };
      break;
    case 31:
      middles.resize(6); // no nodes along w
      break;
    case 32:
      append({ { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 2, 0, 3, 5 } });
      break;
    case 33:
      append(sides);
      break;
    case 34:
      append({ { 0, 1, 2 } });
      break;
    default:
      break;
  }
  return middles;
}

VtkElement fixedElement(const FixedType& type)
{
  VtkElement e;
  e.shape = type.shape;
  e.orders = type.orders;
  e.basis = fixedBasis(type);
  if (type.shape != ElementShape::Pyramid)
  {
    const std::vector<Vec3> corners = latticeNodes(type.shape, uniformOrders(type.shape, 1));
    e.coordinates = meansOf(corners, fixedPatterns(type));
    return e;
  }
  // In the collapsed cube. The middle of an edge at the apex has the u and v of its lower end.
  e.coordinates = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  if (type.orders[0] > 1)
  {
    e.coordinates.insert(e.coordinates.end(),
      { { 0.5, 0, 0 }, { 1, 0.5, 0 }, { 0.5, 1, 0 }, { 0, 0.5, 0 }, { 0, 0, 0.5 }, { 1, 0, 0.5 },
        { 1, 1, 0.5 }, { 0, 1, 0.5 } });
  }
  if (type.vtkType == 37)
  {
    e.coordinates.insert(e.coordinates.end(),
      { { 0.5, 0.5, 0 }, { 0.5, 0, third }, { 1, 0.5, third }, { 0.5, 1, third }, { 0, 0.5, third },
        { 0.5, 0.5, 0.25 } });
  }
  return e;
}
}

//------------------------------------------------------------------------------
VtkElement vtkElement(int vtkType, int nodes, const ElementOrders& orders)
{
  for (const FixedType& type : fixedTypes)
  {
    if (type.vtkType == vtkType)
    {
      if (type.nodes != nodes)
      {
        reject(vtkType, nodes);
      }
      return fixedElement(type);
    }
  }
  constexpr int lagrange = 69, bezier = 76;
  constexpr ElementShape shapes[] = { ElementShape::Triangle, ElementShape::Quadrilateral,
    ElementShape::Tetrahedron, ElementShape::Hexahedron, ElementShape::Wedge };
  const bool controlPoints = vtkType >= bezier;
  const int position = vtkType - (controlPoints ? bezier : lagrange);
  if (position < 0 || position >= static_cast<int>(std::size(shapes)))
  {
    reject(vtkType, nodes);
  }
  VtkElement e;
  e.shape = shapes[position];
  e.controlPoints = controlPoints;
  if (!controlPoints && setSpecial(e, nodes))
  {
    return e;
  }
  e.orders = findOrders(e.shape, vtkType, nodes, orders);
  e.basis = completeBasis(e.shape, e.orders);
  e.coordinates = latticeNodes(e.shape, e.orders);
  return e;
}
}
