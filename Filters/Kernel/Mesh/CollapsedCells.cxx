// SPDX-License-Identifier: BSD-3-Clause
#include "CollapsedCells.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <mutex>

namespace tautline
{
namespace
{
/// The nodes of a face, counterclockwise as seen from outside.
using Face = std::vector<Index>;
using Faces = std::vector<Face>;

/// The nodes of a cycle without repetitions of the previous node.
Face distinctCycle(const Face& cycle)
{
  Face result;
  for (std::size_t k = 0; k < cycle.size(); ++k)
  {
    if (cycle[k] != cycle[(k + cycle.size() - 1) % cycle.size()])
    {
      result.push_back(cycle[k]);
    }
  }
  return result;
}

bool listsTwice(const Index* nodes, int count)
{
  for (int i = 1; i < count; ++i)
  {
    if (std::find(nodes, nodes + i, nodes[i]) != nodes + i)
    {
      return true;
    }
  }
  return false;
}

/// The cycle starting from its smallest node, so that equal faces compare equal.
Face fromSmallest(Face face)
{
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

Face reversed(const Face& face)
{
  return fromSmallest(Face(face.rbegin(), face.rend()));
}

Faces facesOf(CellType type, const Index* nodes)
{
  const CellTopology& t = topology(type);
  Faces faces;
  for (int f = 0; f < t.faces; ++f)
  {
    Face face;
    for (int k = 0; k < t.faceSizes[f]; ++k)
    {
      face.push_back(nodes[t.faceNodes[f][k]]);
    }
    faces.push_back(face);
  }
  return faces;
}

/// The remaining faces; empty if a face touches itself in a node.
Faces remainingFaces(CellType type, const Index* nodes)
{
  Faces remaining;
  for (const Face& given : facesOf(type, nodes))
  {
    const Face face = distinctCycle(given);
    if (face.size() < 3)
    {
      continue;
    }
    if (listsTwice(face.data(), static_cast<int>(face.size())))
    {
      return {};
    }
    // Two faces with the same nodes in opposite orders have collapsed onto each other.
    const auto opposite = std::find(remaining.begin(), remaining.end(), reversed(face));
    if (opposite != remaining.end())
    {
      remaining.erase(opposite);
    }
    else
    {
      remaining.push_back(fromSmallest(face));
    }
  }
  return remaining;
}

std::vector<Index> distinctNodes(const Faces& faces)
{
  std::vector<Index> nodes;
  for (const Face& face : faces)
  {
    nodes.insert(nodes.end(), face.begin(), face.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

bool hasEdge(const Face& face, Index a, Index b)
{
  for (std::size_t k = 0; k < face.size(); ++k)
  {
    const Index from = face[k], to = face[(k + 1) % face.size()];
    if ((from == a && to == b) || (from == b && to == a))
    {
      return true;
    }
  }
  return false;
}

/// Cuts a quadrilateral over four nodes along the diagonal that is not an edge of another face: two
/// triangles on the other diagonal complete it to a tetrahedron.
Faces cutAcross(const Faces& faces)
{
  Faces result;
  for (const Face& face : faces)
  {
    if (face.size() == 3)
    {
      result.push_back(face);
      continue;
    }
    const bool taken = std::any_of(faces.begin(), faces.end(),
      [&](const Face& other) { return hasEdge(other, face[0], face[2]); });
    const int first = taken ? 1 : 0;
    for (int half : { first, first + 2 })
    {
      result.push_back(
        fromSmallest({ face[half % 4], face[(half + 1) % 4], face[(half + 2) % 4] }));
    }
  }
  return result;
}

/// The node connected to a node of a triangle by an edge outside the triangle; -1 if there is none.
Index partnerOf(Index node, const Face& triangle, const Faces& faces)
{
  for (const Face& face : faces)
  {
    const auto at = std::find(face.begin(), face.end(), node);
    if (face.size() != 4 || at == face.end())
    {
      continue;
    }
    const std::size_t k = at - face.begin();
    for (Index other : { face[(k + 1) % 4], face[(k + 3) % 4] })
    {
      if (std::find(triangle.begin(), triangle.end(), other) == triangle.end())
      {
        return other;
      }
    }
  }
  return -1;
}

/// The node that is not in a face.
Index apexOver(const Face& face, const std::vector<Index>& nodes)
{
  return *std::find_if(nodes.begin(), nodes.end(),
    [&](Index node) { return std::find(face.begin(), face.end(), node) == face.end(); });
}

/// The nodes of a cell in its local numbering, starting from its first face; empty if no type has
/// this number of nodes and faces.
std::vector<Index> numbered(const Faces& faces, const std::vector<Index>& nodes, CellType& type)
{
  const auto triangle =
    std::find_if(faces.begin(), faces.end(), [](const Face& face) { return face.size() == 3; });
  const auto square =
    std::find_if(faces.begin(), faces.end(), [](const Face& face) { return face.size() == 4; });
  if (nodes.size() == 4 && faces.size() == 4 && square == faces.end())
  {
    type = CellType::Tetrahedron;
    // Faces are counterclockwise from outside, but the base of a tetrahedron is counterclockwise
    // from its apex.
    const Face& base = *triangle;
    return { base[0], base[2], base[1], apexOver(base, nodes) };
  }
  if (nodes.size() == 5 && faces.size() == 5 && square != faces.end())
  {
    type = CellType::Pyramid;
    const Face& base = *square;
    return { base[0], base[3], base[2], base[1], apexOver(base, nodes) };
  }
  if (nodes.size() == 6 && faces.size() == 5 && triangle != faces.end())
  {
    type = CellType::Wedge;
    std::vector<Index> result = *triangle;
    for (Index node : *triangle)
    {
      result.push_back(partnerOf(node, *triangle, faces));
    }
    return result;
  }
  return {};
}

/// The quadratic type with the corners of a linear one, by VTK's codes.
unsigned char quadraticType(CellType type)
{
  constexpr int firstType = 22, lastType = 27; // quadratic triangle to quadratic pyramid
  for (int vtkType = firstType; vtkType <= lastType; ++vtkType)
  {
    if (cornerType(vtkType) == type)
    {
      return static_cast<unsigned char>(vtkType);
    }
  }
  throw Error("No quadratic type has these corners.");
}
}

//------------------------------------------------------------------------------
CellType remainingShape(CellType type, Index* nodes)
{
  const CellTopology& t = topology(type);
  if (!listsTwice(nodes, t.nodes))
  {
    return type;
  }
  if (t.dimension == 2)
  {
    const Face face = distinctCycle(Face(nodes, nodes + t.nodes));
    if (face.size() != 3 || listsTwice(face.data(), 3))
    {
      return CellType::Unsupported;
    }
    std::copy(face.begin(), face.end(), nodes);
    return CellType::Triangle;
  }
  Faces faces = remainingFaces(type, nodes);
  const std::vector<Index> distinct = distinctNodes(faces);
  if (distinct.size() == 4)
  {
    faces = cutAcross(faces);
  }
  CellType shape = CellType::Unsupported;
  const std::vector<Index> result = numbered(faces, distinct, shape);
  if (result.empty())
  {
    return CellType::Unsupported;
  }
  // The numbering is based on one face: the others must match.
  Faces wanted = facesOf(shape, result.data());
  std::transform(wanted.begin(), wanted.end(), wanted.begin(), fromSmallest);
  std::sort(wanted.begin(), wanted.end());
  std::sort(faces.begin(), faces.end());
  if (wanted != faces)
  {
    return CellType::Unsupported;
  }
  std::copy(result.begin(), result.end(), nodes);
  return shape;
}

namespace
{
/// The cells of a block that list points twice, and the remaining shapes.
std::vector<CollapsedCell> collapsedOf(const MeshView& view, const CellBlock& block, int threads)
{
  const int nodes = topology(block.type).nodes;
  std::vector<CollapsedCell> found;
  std::mutex guard;
  forEachChunk(block.count, threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const Index cell = block.cell(i);
        const Index* given = view.connectivity + view.offsets[cell];
        if (listsTwice(given, nodes))
        {
          std::array<Index, MaxNodes> own;
          std::copy_n(given, nodes, own.begin());
          const CellType remaining = remainingShape(block.type, own.data());
          const std::lock_guard<std::mutex> lock(guard);
          found.push_back({ cell, block.type, remaining });
        }
      }
    });
  return found;
}

/// Appends the remaining shape of a cell to the arrays of the result.
void appendRemaining(const MeshView& view, const CollapsedCell& collapsed, CollapsedCells& result)
{
  const Index begin = view.offsets[collapsed.cell], end = view.offsets[collapsed.cell + 1];
  const int given = topology(collapsed.given).nodes;
  std::array<Index, MaxNodes> nodes;
  std::copy_n(view.connectivity + begin, given, nodes.begin());
  // Collapsed cells are rare: computing the shape again is cheaper than storing it.
  remainingShape(collapsed.given, nodes.data());
  result.connectivity.insert(
    result.connectivity.end(), nodes.begin(), nodes.begin() + topology(collapsed.remaining).nodes);
  const bool higher = isHigherOrder(view.cellTypes[collapsed.cell]);
  if (higher)
  {
    result.connectivity.insert(
      result.connectivity.end(), view.connectivity + begin + given, view.connectivity + end);
  }
  result.types[collapsed.cell] =
    higher ? quadraticType(collapsed.remaining) : static_cast<unsigned char>(collapsed.remaining);
}
}

//------------------------------------------------------------------------------
CollapsedCells findCollapsedCells(const Mesh& mesh, int threads)
{
  const MeshView& view = mesh.view();
  CollapsedCells result;
  for (const CellBlock& block : mesh.blocks())
  {
    if (block.type != CellType::Triangle && block.type != CellType::Tetrahedron)
    {
      const std::vector<CollapsedCell> found = collapsedOf(view, block, threads);
      result.found.insert(result.found.end(), found.begin(), found.end());
    }
  }
  // Threads find the cells in any order.
  std::sort(result.found.begin(), result.found.end(),
    [](const CollapsedCell& a, const CollapsedCell& b) { return a.cell < b.cell; });
  if (std::all_of(result.found.begin(), result.found.end(),
        [](const CollapsedCell& c) { return c.remaining == CellType::Unsupported; }))
  {
    return result;
  }
  result.types.assign(view.cellTypes, view.cellTypes + view.numberOfCells);
  result.offsets.reserve(view.numberOfCells + 1);
  result.offsets.push_back(0);
  result.connectivity.reserve(view.offsets[view.numberOfCells] - view.offsets[0]);
  auto next = result.found.begin();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const bool collapsed = next != result.found.end() && next->cell == cell;
    if (collapsed && next->remaining != CellType::Unsupported)
    {
      appendRemaining(view, *next, result);
    }
    else
    {
      result.connectivity.insert(result.connectivity.end(), view.connectivity + view.offsets[cell],
        view.connectivity + view.offsets[cell + 1]);
    }
    next += collapsed;
    result.offsets.push_back(static_cast<Index>(result.connectivity.size()));
  }
  return result;
}
}
