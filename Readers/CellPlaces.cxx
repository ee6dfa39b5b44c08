// SPDX-License-Identifier: BSD-3-Clause
#include "CellPlaces.h"

#include "tautline/Elements/ElementType.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tautline
{
namespace
{
bool isLine(unsigned char type)
{
  return type == FileLine || type == FileLine3 || type == FileLagrangeLine;
}

/// The type of a cell for ElementType; null for cells that it does not support.
const ElementType* elementType(unsigned char type, Index nodes)
{
  try
  {
    return &ElementType::ofVtk(type, static_cast<int>(nodes));
  }
  catch (const Error&)
  {
    return nullptr;
  }
}

/// Whether all nodes are on the lattice of the order; false for cells with bubble nodes.
bool isOnLattice(const ElementType& element)
{
  const int order = element.orders()[0];
  const auto& nodes = element.coordinates();
  return std::all_of(nodes.begin(), nodes.end(),
    [order](const Vec3& node)
    {
      return std::all_of(node.begin(), node.end(),
        [order](double x) { return std::abs(x * order - std::round(x * order)) < 1e-9; });
    });
}

}

//------------------------------------------------------------------------------
int cellOrder(unsigned char type, Index nodes)
{
  if (isLine(type))
  {
    return nodes >= 2 && nodes <= MaxElementOrder + 1 ? static_cast<int>(nodes) - 1 : 0;
  }
  constexpr Index most = (MaxElementOrder + 1) * (MaxElementOrder + 1) * (MaxElementOrder + 1);
  if (cellDimension(type) < 2 || nodes > most)
  {
    return 0;
  }
  const ElementType* element = elementType(type, nodes);
  const bool hasOne = element && element->shape() != ElementShape::Pyramid && isOnLattice(*element);
  return hasOne ? element->orders()[0] : 0;
}

//------------------------------------------------------------------------------
std::vector<LatticePoint> cellPlaces(unsigned char type, Index nodes)
{
  const int order = cellOrder(type, nodes);
  std::vector<LatticePoint> places;
  if (isLine(type))
  {
    places = { { 0, 0, 0 }, { order, 0, 0 } };
    for (int i = 1; i < order; ++i)
    {
      places.push_back({ i, 0, 0 });
    }
    return places;
  }
  const ElementType& element = ElementType::ofVtk(type, static_cast<int>(nodes));
  const bool mirrored = element.shape() == ElementShape::Wedge && type != FileLagrangeWedge;
  for (const Vec3& node : element.coordinates())
  {
    const auto nearest = [order](double x) { return static_cast<int>(std::lround(x * order)); };
    places.push_back({ nearest(node[0]), nearest(node[1]), nearest(node[2]) });
    if (mirrored)
    {
      std::swap(places.back()[0], places.back()[1]);
    }
  }
  return places;
}

//------------------------------------------------------------------------------
unsigned char linearType(unsigned char type)
{
  switch (type)
  {
    case FileLine3:
    case FileLagrangeLine:
      return FileLine;
    case FileTriangle6:
    case FileLagrangeTriangle:
      return FileTriangle;
    case FileQuadrilateral8:
    case FileQuadrilateral9:
    case FileLagrangeQuadrilateral:
      return FileQuadrilateral;
    case FileTetrahedron10:
    case FileLagrangeTetrahedron:
      return FileTetrahedron;
    case FileHexahedron20:
    case FileHexahedron27:
    case FileLagrangeHexahedron:
      return FileHexahedron;
    case FileWedge15:
    case FileWedge18:
    case FileLagrangeWedge:
      return FileWedge;
    case FilePyramid13:
      return FilePyramid;
    default:
      return type;
  }
}
}
