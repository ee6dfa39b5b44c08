// SPDX-License-Identifier: BSD-3-Clause
#include "MfemNumbering.h"

#include <algorithm>
#include <tuple>

namespace tautline
{
namespace
{
constexpr std::array<int, 3> NoAxes = { 0, 0, 0 };

/// The shapes by MFEM's numbers, with the order of edges and faces used in its numbering.
const std::array<MfemShape, 8>& shapes()
{
  static const std::array<MfemShape, 8> table = { {
    { "point", ElementShape::Triangle, 0, { { 0, 0, 0 } }, {}, {}, NoAxes },
    { "segment", ElementShape::Triangle, 1, { { 0, 0, 0 }, { 1, 0, 0 } }, { { 0, 1 } }, {},
      NoAxes },
    { "triangle", ElementShape::Triangle, 2, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } },
      { { 0, 1 }, { 1, 2 }, { 2, 0 } }, {}, { 1, 1, 0 } },
    { "square", ElementShape::Quadrilateral, 2,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } },
      { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } }, {}, NoAxes },
    { "tetrahedron", ElementShape::Tetrahedron, 3,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
      { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } },
      { { 3, { 1, 2, 3 } }, { 3, { 0, 3, 2 } }, { 3, { 0, 1, 3 } }, { 3, { 0, 2, 1 } } },
      { 1, 1, 1 } },
    { "cube", ElementShape::Hexahedron, 3,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 },
        { 0, 1, 1 } },
      { { 0, 1 }, { 1, 2 }, { 3, 2 }, { 0, 3 }, { 4, 5 }, { 5, 6 }, { 7, 6 }, { 4, 7 }, { 0, 4 },
        { 1, 5 }, { 2, 6 }, { 3, 7 } },
      { { 4, { 3, 2, 1, 0 } }, { 4, { 0, 1, 5, 4 } }, { 4, { 1, 2, 6, 5 } }, { 4, { 2, 3, 7, 6 } },
        { 4, { 3, 0, 4, 7 } }, { 4, { 4, 5, 6, 7 } } },
      NoAxes },
    { "prism", ElementShape::Wedge, 3,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } },
      { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 }, { 0, 3 }, { 1, 4 }, { 2, 5 } },
      { { 3, { 0, 2, 1 } }, { 3, { 3, 4, 5 } }, { 4, { 0, 1, 4, 3 } }, { 4, { 1, 2, 5, 4 } },
        { 4, { 2, 0, 3, 5 } } },
      { 1, 1, 0 } },
    { "pyramid", ElementShape::Pyramid, 3,
      { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
      { { 0, 1 }, { 1, 2 }, { 3, 2 }, { 0, 3 }, { 0, 4 }, { 1, 4 }, { 2, 4 }, { 3, 4 } },
      { { 4, { 3, 2, 1, 0 } }, { 3, { 0, 1, 4 } }, { 3, { 1, 2, 4 } }, { 3, { 2, 3, 4 } },
        { 3, { 3, 0, 4 } } },
      { 1, 1, 1 } },
  } };
  return table;
}

/// Whether the first-order basis function of a corner is positive at a position.
bool hasShare(
  const MfemShape& shape, const LatticePoint& corner, const LatticePoint& place, int order)
{
  int sum = 0;
  bool isOrigin = true;
  bool positive = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (shape.simplexAxes[axis])
    {
      sum += place[axis];
      isOrigin = isOrigin && corner[axis] == 0;
      positive = positive && (corner[axis] == 0 || place[axis] > 0);
    }
    else if (static_cast<int>(axis) < shape.dimension)
    {
      positive = positive && (corner[axis] ? place[axis] > 0 : place[axis] < order);
    }
  }
  const bool hasSimplex = shape.simplexAxes[0] != 0;
  return positive && (!hasSimplex || !isOrigin || sum < order);
}

/// The corners that contribute to a position: one at a vertex, two on an edge, ...
std::vector<int> cornersAt(const MfemShape& shape, const LatticePoint& place, int order)
{
  std::vector<int> corners;
  for (std::size_t corner = 0; corner < shape.corners.size(); ++corner)
  {
    // With order 1 each position is a corner, the only contribution, also for a pyramid.
    if (order == 1 ? shape.corners[corner] == place
                   : hasShare(shape, shape.corners[corner], place, order))
    {
      corners.push_back(static_cast<int>(corner));
    }
  }
  return corners;
}

/// The steps from one corner of an element to a position, along an edge to another corner.
int stepsAlong(const MfemShape& shape, int from, int to, const LatticePoint& place, int order)
{
  int product = 0, square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const int start = shape.corners[static_cast<std::size_t>(from)][axis];
    const int direction = shape.corners[static_cast<std::size_t>(to)][axis] - start;
    product += (place[axis] - order * start) * direction;
    square += direction * direction;
  }
  return product / square;
}
}

//------------------------------------------------------------------------------
const MfemShape& mfemShape(int geometry)
{
  return shapes()[static_cast<std::size_t>(geometry)];
}

//------------------------------------------------------------------------------
bool MfemShape::isInside(const LatticePoint& place, int order) const
{
  int sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    sum += this->simplexAxes[axis] ? place[axis] : 0;
  }
  return sum <= order;
}

//------------------------------------------------------------------------------
std::vector<LatticePoint> MfemShape::lattice(int order) const
{
  if (order == 1)
  {
    std::vector<LatticePoint> sorted = this->corners;
    std::sort(sorted.begin(), sorted.end(),
      [](const LatticePoint& a, const LatticePoint& b)
      { return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]); });
    return sorted;
  }
  std::vector<LatticePoint> places;
  for (int k = 0; k <= (this->dimension > 2 ? order : 0); ++k)
  {
    for (int j = 0; j <= (this->dimension > 1 ? order : 0); ++j)
    {
      for (int i = 0; i <= (this->dimension > 0 ? order : 0); ++i)
      {
        if (this->isInside({ i, j, k }, order))
        {
          places.push_back({ i, j, k });
        }
      }
    }
  }
  return places;
}

//------------------------------------------------------------------------------
MfemNumbering::Key MfemNumbering::keyOf(const Index* vertices, const int* corners, int count)
{
  Key key = { -1, -1, -1, -1 };
  for (int c = 0; c < count; ++c)
  {
    key[static_cast<std::size_t>(c)] = vertices[corners[c]];
  }
  std::sort(key.begin(), key.end());
  return key;
}

//------------------------------------------------------------------------------
MfemNumbering::MfemNumbering(Index vertices, const MfemElements& elements, int order)
  : Elements(elements)
  , Order(order)
  , Total(vertices)
{
  std::array<Index, 8> inside{};
  for (std::size_t geometry = 0; geometry < inside.size(); ++geometry)
  {
    const MfemShape& shape = shapes()[geometry];
    for (const LatticePoint& place : shape.lattice(order))
    {
      this->Places[geometry].push_back({ place, cornersAt(shape, place, order) });
      inside[geometry] += this->Places[geometry].back().corners.size() == shape.corners.size();
    }
  }
  if (order == 1)
  {
    return;
  }
  const Index insideEdge = order - 1;
  for (std::size_t element = 0; element < elements.size(); ++element)
  {
    for (const auto& edge : mfemShape(elements.geometries[element]).edges)
    {
      const Key key = keyOf(elements.verticesOf(element), edge.data(), 2);
      this->Total += this->Edges.emplace(key, this->Total).second ? insideEdge : 0;
    }
  }
  constexpr std::size_t triangle = 2, square = 3;
  for (std::size_t element = 0; element < elements.size(); ++element)
  {
    const Index* own = elements.verticesOf(element);
    for (const MfemShape::Face& face : mfemShape(elements.geometries[element]).faces)
    {
      Face entry = { this->Total, { -1, -1, -1, -1 } };
      for (std::size_t c = 0; c < static_cast<std::size_t>(face.corners); ++c)
      {
        entry.vertices[c] = own[face.corner[c]];
      }
      const Key key = keyOf(own, face.corner.data(), face.corners);
      const Index nodes = inside[face.corners == 3 ? triangle : square];
      this->Total += this->Faces.emplace(key, entry).second ? nodes : 0;
    }
  }
  for (const unsigned char geometry : elements.geometries)
  {
    this->Interiors.push_back(this->Total);
    this->Total += inside[geometry];
  }
}

//------------------------------------------------------------------------------
Index MfemNumbering::nodeOfEdge(const MfemShape& shape, const Index* vertices, const int* corners,
  const LatticePoint& place) const
{
  const auto found = this->Edges.find(keyOf(vertices, corners, 2));
  if (found == this->Edges.end())
  {
    return -1;
  }
  const bool forward = vertices[corners[0]] < vertices[corners[1]];
  const int from = corners[forward ? 0 : 1], to = corners[forward ? 1 : 0];
  return found->second + stepsAlong(shape, from, to, place, this->Order) - 1;
}

//------------------------------------------------------------------------------
Index MfemNumbering::nodeOfFace(const MfemShape& shape, const Index* vertices, const int* corners,
  int count, const LatticePoint& place) const
{
  const auto found = this->Faces.find(keyOf(vertices, corners, count));
  if (found == this->Faces.end())
  {
    return -1;
  }
  // The corner of this element at each vertex of the face, in the order of the first element.
  const Face& face = found->second;
  std::array<int, 4> local{};
  for (std::size_t c = 0; c < static_cast<std::size_t>(count); ++c)
  {
    local[c] = *std::find_if(
      corners, corners + count, [&](int corner) { return vertices[corner] == face.vertices[c]; });
  }
  const int last = local[static_cast<std::size_t>(count - 1)];
  const int order = this->Order;
  if (count == 4)
  {
    const int i = stepsAlong(shape, local[0], local[1], place, order);
    const int j = stepsAlong(shape, local[0], last, place, order);
    return face.firstNode + (i - 1) + Index{ j - 1 } * (order - 1);
  }
  // On a triangle, the steps toward a corner are the contribution of the corner.
  const auto share = [&](int corner)
  {
    int others = 0;
    const LatticePoint& at = shape.corners[static_cast<std::size_t>(corner)];
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      if (shape.simplexAxes[axis] && at[axis])
      {
        return place[axis];
      }
      others += shape.simplexAxes[axis] ? place[axis] : 0;
    }
    return order - others;
  };
  const int i = share(local[1]), j = share(last);
  Index node = face.firstNode + i - 1;
  for (int row = 1; row < j; ++row)
  {
    node += order - 1 - row;
  }
  return node;
}

//------------------------------------------------------------------------------
bool MfemNumbering::nodesOf(
  std::size_t element, const MfemElements* boundary, std::vector<Index>& nodes) const
{
  const MfemElements& from = boundary ? *boundary : this->Elements;
  const MfemShape& shape = mfemShape(from.geometries[element]);
  const Index* vertices = from.verticesOf(element);
  nodes.clear();
  Index inside = 0;
  for (const Place& at : this->Places[from.geometries[element]])
  {
    const int* corners = at.corners.data();
    const int count = static_cast<int>(at.corners.size());
    Index node = vertices[corners[0]];
    if (count > 1 && at.corners.size() == shape.corners.size() && !boundary)
    {
      node = this->Interiors[element] + inside++;
    }
    else if (count > 1)
    {
      node = count == 2 ? this->nodeOfEdge(shape, vertices, corners, at.place)
                        : this->nodeOfFace(shape, vertices, corners, count, at.place);
    }
    if (node < 0)
    {
      return false;
    }
    nodes.push_back(node);
  }
  return true;
}
}
