// SPDX-License-Identifier: BSD-3-Clause
#include "GmshFile.h"

#include "CellPlaces.h"

#include <algorithm>
#include <array>
#include <map>

namespace tautline
{
namespace
{
using Places = std::vector<LatticePoint>;
using Corners = std::vector<int>;

LatticePoint between(const LatticePoint& from, const LatticePoint& to, int step, int order)
{
  LatticePoint place;
  for (std::size_t axis = 0; axis < place.size(); ++axis)
  {
    place[axis] = from[axis] + (to[axis] - from[axis]) / order * step;
  }
  return place;
}

/// The nodes strictly between two corners.
void addEdge(Places& nodes, const LatticePoint& from, const LatticePoint& to, int order)
{
  for (int step = 1; step < order; ++step)
  {
    nodes.push_back(between(from, to, step, order));
  }
}

/// A triangle or a square between corners `order` steps apart: corners, edges, and recursively the
/// inner one, as in Gmsh's documentation ("Node ordering").
void addFace(Places& nodes, Places corners, int order)
{
  const std::size_t count = corners.size();
  const int smaller = count == 3 ? 3 : 2; // by this much is the inner one
  for (; order > 0; order -= smaller)
  {
    nodes.insert(nodes.end(), corners.begin(), corners.end());
    for (std::size_t c = 0; c < count; ++c)
    {
      addEdge(nodes, corners[c], corners[(c + 1) % count], order);
    }
    Places inner;
    for (std::size_t c = 0; c < count; ++c)
    {
      // A step along each of the two edges of the corner.
      const LatticePoint next = between(corners[c], corners[(c + 1) % count], 1, order);
      const LatticePoint last = between(corners[c], corners[(c + count - 1) % count], 1, order);
      inner.push_back({});
      for (std::size_t axis = 0; axis < next.size(); ++axis)
      {
        inner.back()[axis] = next[axis] + last[axis] - corners[c][axis];
      }
    }
    corners = inner;
  }
  if (order == 0)
  {
    nodes.push_back(corners[0]);
  }
}

/// The nodes of addFace() inside its edges.
void addInsideOfFace(Places& nodes, const Places& corners, int order)
{
  Places all;
  addFace(all, corners, order);
  nodes.insert(
    nodes.end(), all.begin() + static_cast<std::ptrdiff_t>(corners.size()) * order, all.end());
}

/// A shape of Gmsh: its corners for order 1, and its edges and faces between them.
struct Solid
{
  Places corners;
  std::vector<std::array<int, 2>> edges;
  std::vector<Corners> faces;
  int smaller; ///< decrease of the order of the inner shape
};

const Solid tetrahedron = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
  { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 0 }, { 3, 2 }, { 3, 1 } },
  { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 3, 1, 2 } }, 4 };
const Solid hexahedron = { { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
                             { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } },
  { { 0, 1 }, { 0, 3 }, { 0, 4 }, { 1, 2 }, { 1, 5 }, { 2, 3 }, { 2, 6 }, { 3, 7 }, { 4, 5 },
    { 4, 7 }, { 5, 6 }, { 6, 7 } },
  { { 0, 3, 2, 1 }, { 0, 1, 5, 4 }, { 0, 4, 7, 3 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 },
    { 4, 5, 6, 7 } },
  2 };
const Solid prism = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
                        { 0, 1, 1 } },
  { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 4 }, { 2, 5 }, { 3, 4 }, { 3, 5 }, { 4, 5 } },
  { { 0, 2, 1 }, { 3, 4, 5 }, { 0, 1, 4, 3 }, { 0, 3, 5, 2 }, { 1, 2, 5, 4 } }, 0 };

/// The nodes inside a prism: for each interior triangle node, the nodes along the axis, ends first.
void addInsideOfPrism(Places& nodes, int order)
{
  Places triangle, line;
  addInsideOfFace(triangle, { { 0, 0, 0 }, { order, 0, 0 }, { 0, order, 0 } }, order);
  const int last = order - 1;
  line.push_back({ 0, 0, 1 });
  if (last > 1)
  {
    line.push_back({ 0, 0, last });
  }
  for (int k = 2; k < last; ++k)
  {
    line.push_back({ 0, 0, k });
  }
  for (const LatticePoint& place : triangle)
  {
    for (const LatticePoint& height : line)
    {
      nodes.push_back({ place[0], place[1], height[2] });
    }
  }
}

/// The nodes of a solid whose lowest corner has the coordinates `low`.
void addSolid(Places& nodes, const Solid& solid, int order, int low)
{
  Places corners = solid.corners;
  for (LatticePoint& corner : corners)
  {
    for (int& c : corner)
    {
      c = low + c * order;
    }
  }
  if (order <= 0)
  {
    nodes.insert(nodes.end(), corners.begin(), corners.begin() + (order == 0));
    return;
  }
  nodes.insert(nodes.end(), corners.begin(), corners.end());
  const auto corner = [&](int c) { return corners[static_cast<std::size_t>(c)]; };
  for (const auto& edge : solid.edges)
  {
    addEdge(nodes, corner(edge[0]), corner(edge[1]), order);
  }
  for (const Corners& face : solid.faces)
  {
    Places own;
    std::transform(face.begin(), face.end(), std::back_inserter(own), corner);
    addInsideOfFace(nodes, own, order);
  }
  if (&solid == &prism)
  {
    addInsideOfPrism(nodes, order);
  }
  else
  {
    addSolid(nodes, solid, order - solid.smaller, low + 1);
  }
}

/// The positions of the nodes of Gmsh's complete elements, in Gmsh's order.
Places gmshPlaces(unsigned char linear, int order)
{
  Places nodes;
  switch (linear)
  {
    case FileLine:
      nodes = { { 0, 0, 0 }, { order, 0, 0 } };
      addEdge(nodes, { 0, 0, 0 }, { order, 0, 0 }, order);
      break;
    case FileTriangle:
      addFace(nodes, { { 0, 0, 0 }, { order, 0, 0 }, { 0, order, 0 } }, order);
      break;
    case FileQuadrilateral:
      addFace(nodes, { { 0, 0, 0 }, { order, 0, 0 }, { order, order, 0 }, { 0, order, 0 } }, order);
      break;
    case FileTetrahedron:
      addSolid(nodes, tetrahedron, order, 0);
      break;
    case FileHexahedron:
      addSolid(nodes, hexahedron, order, 0);
      break;
    default:
      addSolid(nodes, prism, order, 0);
      break;
  }
  return nodes;
}

/// An element type of Gmsh and the corresponding cell.
struct KnownCell
{
  int code;
  unsigned char type;
  int nodes;
};

constexpr KnownCell Known[] = { { 15, FileVertex, 1 }, { 1, FileLine, 2 }, { 2, FileTriangle, 3 },
  { 3, FileQuadrilateral, 4 }, { 4, FileTetrahedron, 4 }, { 5, FileHexahedron, 8 },
  { 6, FileWedge, 6 }, { 7, FilePyramid, 5 }, { 8, FileLine3, 3 }, { 9, FileTriangle6, 6 },
  { 10, FileQuadrilateral9, 9 }, { 11, FileTetrahedron10, 10 }, { 12, FileHexahedron27, 27 },
  { 13, FileWedge18, 18 }, { 16, FileQuadrilateral8, 8 }, { 17, FileHexahedron20, 20 },
  { 18, FileWedge15, 15 }, { 19, FilePyramid13, 13 },
  // Third order, then fourth.
  { 26, FileLagrangeLine, 4 }, { 21, FileLagrangeTriangle, 10 },
  { 36, FileLagrangeQuadrilateral, 16 }, { 29, FileLagrangeTetrahedron, 20 },
  { 92, FileLagrangeHexahedron, 64 }, { 90, FileLagrangeWedge, 40 }, { 27, FileLagrangeLine, 5 },
  { 23, FileLagrangeTriangle, 15 }, { 37, FileLagrangeQuadrilateral, 25 },
  { 30, FileLagrangeTetrahedron, 35 }, { 93, FileLagrangeHexahedron, 125 },
  { 91, FileLagrangeWedge, 75 },
  // Lagrange cells of first and second order, from other formats.
  { 1, FileLagrangeLine, 2 }, { 8, FileLagrangeLine, 3 }, { 2, FileLagrangeTriangle, 3 },
  { 9, FileLagrangeTriangle, 6 }, { 3, FileLagrangeQuadrilateral, 4 },
  { 10, FileLagrangeQuadrilateral, 9 }, { 4, FileLagrangeTetrahedron, 4 },
  { 11, FileLagrangeTetrahedron, 10 }, { 5, FileLagrangeHexahedron, 8 },
  { 12, FileLagrangeHexahedron, 27 }, { 6, FileLagrangeWedge, 6 }, { 13, FileLagrangeWedge, 18 } };

/// A pyramid of 14 nodes: VTK's cell lacks the node in its base, the last one.
constexpr int CompletePyramid = 14;

/// Gmsh numbers the nodes of a pyramid's edges in the order of its own list of edges.
const std::vector<int> Pyramid13 = { 0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12 };

GmshCell makeCell(const KnownCell& known)
{
  GmshCell cell = { known.code, known.type, known.nodes, {} };
  if (known.type == FilePyramid13)
  {
    cell.order = Pyramid13;
  }
  const int order = cellOrder(known.type, known.nodes);
  if (order == 0)
  {
    return cell;
  }
  const Places gmsh = gmshPlaces(linearType(known.type), order);
  for (const LatticePoint& place : cellPlaces(known.type, known.nodes))
  {
    const auto found = std::find(gmsh.begin(), gmsh.end(), place);
    cell.order.push_back(static_cast<int>(found - gmsh.begin()));
  }
  return cell;
}

/// The element types; files are read with the first one of a code.
const std::vector<GmshCell>& cells()
{
  static const std::vector<GmshCell> table = []
  {
    std::vector<GmshCell> made;
    std::transform(std::begin(Known), std::end(Known), std::back_inserter(made), makeCell);
    made.push_back({ CompletePyramid, FilePyramid13, CompletePyramid, Pyramid13 });
    return made;
  }();
  return table;
}

/// Elements whose polynomials are not available in any VTK cell.
struct UnknownCell
{
  int code;
  const char* what;
};
constexpr const char* Incomplete = "incomplete elements of third or fourth order (set "
                                   "Mesh.SecondOrderIncomplete = 0 and mesh again)";
constexpr const char* HighPyramids =
  "pyramids of third or fourth order, which VTK does not have (gmsh -order 2)";
constexpr UnknownCell Unreadable[] = { { 20, Incomplete }, { 22, Incomplete }, { 39, Incomplete },
  { 40, Incomplete }, { 137, Incomplete }, { 32, Incomplete }, { 99, Incomplete },
  { 100, Incomplete }, { 111, Incomplete }, { 112, Incomplete }, { 118, HighPyramids },
  { 119, HighPyramids }, { 125, HighPyramids }, { 126, HighPyramids } };
}

//------------------------------------------------------------------------------
const GmshCell* gmshCellByCode(Index code)
{
  const auto found = std::find_if(
    cells().begin(), cells().end(), [code](const GmshCell& c) { return c.code == code; });
  return found == cells().end() ? nullptr : &*found;
}

//------------------------------------------------------------------------------
const GmshCell* gmshCellByType(unsigned char type, Index nodes)
{
  const auto found = std::find_if(cells().begin(), cells().end(),
    [&](const GmshCell& c) { return c.type == type && c.nodes == nodes; });
  return found == cells().end() ? nullptr : &*found;
}

//------------------------------------------------------------------------------
std::string gmshRefusal(Index code)
{
  const auto* found = std::find_if(std::begin(Unreadable), std::end(Unreadable),
    [code](const UnknownCell& c) { return c.code == code; });
  const bool known = found != std::end(Unreadable);
  return "elements of type " + std::to_string(code) + " cannot be read" +
    (known ? std::string(": they are ") + found->what
           : std::string("; elements up to fourth order can: gmsh -order 4"));
}

//------------------------------------------------------------------------------
void GmshTags::assign(std::vector<Index> tags)
{
  *this = GmshTags();
  if (tags.empty())
  {
    return;
  }
  const auto [low, high] = std::minmax_element(tags.begin(), tags.end());
  const auto count = static_cast<Index>(tags.size());
  this->Low = *low;
  // the difference of two tags may not fit a signed number
  const auto range = static_cast<std::uint64_t>(*high) - static_cast<std::uint64_t>(*low);
  if (range < static_cast<std::uint64_t>(4 * count + 1024))
  {
    this->Dense.assign(static_cast<std::size_t>(range) + 1, -1);
  }
  for (Index i = 0; i < count; ++i)
  {
    const Index tag = tags[static_cast<std::size_t>(i)];
    if (this->find(tag) >= 0)
    {
      this->Duplicate = i;
    }
    if (this->Dense.empty())
    {
      this->Sparse.emplace(tag, i);
    }
    else
    {
      this->Dense[static_cast<std::size_t>(tag - this->Low)] = i;
    }
  }
}

//------------------------------------------------------------------------------
Index GmshTags::find(Index tag) const
{
  if (this->Dense.empty())
  {
    const auto found = this->Sparse.find(tag);
    return found == this->Sparse.end() ? -1 : found->second;
  }
  const auto place = static_cast<std::uint64_t>(tag) - static_cast<std::uint64_t>(this->Low);
  return tag < this->Low || place >= this->Dense.size() ? -1 : this->Dense[place];
}

//------------------------------------------------------------------------------
void GmshInput::addElement(const GmshCell& cell, const Index* tags, const char* place)
{
  std::array<Index, MaxGmshNodes> ids;
  const std::size_t size =
    cell.order.empty() ? static_cast<std::size_t>(cell.nodes) : cell.order.size();
  for (std::size_t i = 0; i < size; ++i)
  {
    const Index tag = tags[cell.order.empty() ? i : static_cast<std::size_t>(cell.order[i])];
    ids[i] = this->nodes.find(tag);
    if (ids[i] < 0)
    {
      this->cursor.failAt(
        place, "an element uses node " + std::to_string(tag) + ", which is not in $Nodes");
    }
  }
  this->mesh.addCell(cell.type, ids.data(), static_cast<Index>(size));
  this->basesLeftOut += cell.code == CompletePyramid;
}

//------------------------------------------------------------------------------
void GmshInput::reserveElements(std::size_t count)
{
  reserveLarge(this->mesh.connectivity, 4 * count);
  reserveLarge(this->mesh.offsets, count + 1);
  reserveLarge(this->mesh.cellTypes, count);
  reserveLarge(this->elementTags, count);
  reserveLarge(this->references, count);
  reserveLarge(this->entities, count);
}

//------------------------------------------------------------------------------
void GmshInput::setNodes(std::vector<Index> tags)
{
  this->nodes.assign(tags);
  if (this->nodes.duplicate() >= 0)
  {
    this->cursor.fail("node number " +
      std::to_string(tags[static_cast<std::size_t>(this->nodes.duplicate())]) + " is given twice");
  }
}
}
