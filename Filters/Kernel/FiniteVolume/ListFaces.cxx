// SPDX-License-Identifier: BSD-3-Clause
#include "ListFaces.h"

#include "FaceShape.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <atomic>
#include <tuple>

namespace tautline
{
namespace
{
/// An edge of a listed face.
struct FaceEdge
{
  Index low, high;
  Index face;   ///< its number in the cell
  bool forward; ///< whether the face traverses it from low to high
};

/// The edges of the faces of a cell, with edges of the same points adjacent.
std::vector<FaceEdge> edgesOf(const ListedFaces& list, Index cell)
{
  std::vector<FaceEdge> edges;
  const Index first = list.cellOffsets[cell];
  for (Index face = first; face < list.cellOffsets[cell + 1]; ++face)
  {
    const Index begin = list.faceOffsets[face], end = list.faceOffsets[face + 1];
    for (Index i = begin; i < end; ++i)
    {
      const Index a = list.nodes[i], b = list.nodes[i + 1 < end ? i + 1 : begin];
      edges.push_back({ std::min(a, b), std::max(a, b), face - first, a < b });
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const FaceEdge& a, const FaceEdge& b)
    { return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face); });
  return edges;
}

bool sameEdge(const FaceEdge& a, const FaceEdge& b)
{
  return a.low == b.low && a.high == b.high;
}

/// Whether the edges occur in pairs.
bool isClosed(const std::vector<FaceEdge>& edges)
{
  bool closed = edges.size() % 2 == 0;
  for (std::size_t i = 0; closed && i + 1 < edges.size(); i += 2)
  {
    closed = sameEdge(edges[i], edges[i + 1]) &&
      !(i + 2 < edges.size() && sameEdge(edges[i], edges[i + 2]));
  }
  return closed;
}

/// The faces of a closed cell that must be reversed to agree with the first one.
std::vector<char> turnedFaces(const std::vector<FaceEdge>& edges, Index faces)
{
  std::vector<char> turned(faces, -1); // unknown
  turned[0] = 0;
  // Each pass determines at least one face, unless the cell is disconnected.
  for (bool changed = true; changed;)
  {
    changed = false;
    for (std::size_t i = 0; i + 1 < edges.size(); i += 2)
    {
      const FaceEdge &a = edges[i], &b = edges[i + 1];
      char &first = turned[a.face], &second = turned[b.face];
      if ((first < 0) != (second < 0))
      {
        const char known = first < 0 ? second : first;
        (first < 0 ? first : second) = a.forward == b.forward ? !known : known;
        changed = true;
      }
    }
  }
  return turned;
}

/// Six times the volume within the faces of a cell.
double sixVolumes(const ListedFaces& list, Index cell, const double* points)
{
  const Index first = list.faceOffsets[list.cellOffsets[cell]];
  const Vec3 apex = pointAt(points, list.nodes[first]);
  double sum = 0;
  for (Index face = list.cellOffsets[cell]; face < list.cellOffsets[cell + 1]; ++face)
  {
    const Index begin = list.faceOffsets[face];
    const Vec3 a = pointAt(points, list.nodes[begin]) - apex;
    for (Index i = begin + 1; i + 1 < list.faceOffsets[face + 1]; ++i)
    {
      sum += dot(
        a, cross(pointAt(points, list.nodes[i]) - apex, pointAt(points, list.nodes[i + 1]) - apex));
    }
  }
  return sum;
}

void reverseFace(ListedFaces& list, Index face)
{
  // Keep the first point in place.
  std::reverse(list.nodes.begin() + list.faceOffsets[face] + 1,
    list.nodes.begin() + list.faceOffsets[face + 1]);
}

enum class Turn
{
  None,
  Turned,
  Open
};

Turn turnCell(ListedFaces& list, Index cell, const double* points)
{
  const Index first = list.cellOffsets[cell], count = list.cellOffsets[cell + 1] - first;
  const std::vector<FaceEdge> edges = edgesOf(list, cell);
  if (count == 0 || !isClosed(edges))
  {
    return Turn::Open;
  }
  const std::vector<char> turned = turnedFaces(edges, count);
  if (std::find(turned.begin(), turned.end(), 1) == turned.end())
  {
    return Turn::None;
  }
  for (Index i = 0; i < count; ++i)
  {
    if (turned[i] == 1)
    {
      reverseFace(list, first + i);
    }
  }
  if (sixVolumes(list, cell, points) < 0)
  {
    for (Index i = 0; i < count; ++i)
    {
      reverseFace(list, first + i);
    }
  }
  return Turn::Turned;
}
}

//------------------------------------------------------------------------------
void listLinearCell(ListedFaces& list, CellType type, const Index* nodes)
{
  const CellTopology& t = topology(type);
  for (int face = 0; face < t.faces; ++face)
  {
    for (int k = 0; k < t.faceSizes[face]; ++k)
    {
      list.nodes.push_back(nodes[t.faceNodes[face][k]]);
    }
    list.faceOffsets.push_back(static_cast<Index>(list.nodes.size()));
  }
  list.cellOffsets.push_back(static_cast<Index>(list.faceOffsets.size()) - 1);
}

//------------------------------------------------------------------------------
TurnedCells turnFaces(ListedFaces& list, Index first, const double* points, int threads)
{
  std::atomic<Index> open{ 0 }, turned{ 0 };
  const Index cells = static_cast<Index>(list.cellOffsets.size()) - 1;
  constexpr Index grain = 1024;
  parallelFor(cells - first, grain, threads,
    [&](Index i)
    {
      const Turn turn = turnCell(list, first + i, points);
      open += turn == Turn::Open;
      turned += turn == Turn::Turned;
    });
  return { open, turned };
}

//------------------------------------------------------------------------------
Index turnInsideOut(
  ListedFaces& list, const std::vector<char>& some, const double* points, bool each)
{
  std::vector<double> volumes(some.size());
  double sum = 0;
  for (std::size_t cell = 0; cell < some.size(); ++cell)
  {
    pollInterruption(static_cast<Index>(cell));
    volumes[cell] = some[cell] ? sixVolumes(list, static_cast<Index>(cell), points) : 0;
    sum += volumes[cell];
  }
  Index turned = 0;
  for (std::size_t cell = 0; cell < some.size(); ++cell)
  {
    const bool turns = some[cell] && (each ? volumes[cell] : sum) < 0;
    turned += turns;
    for (Index face = list.cellOffsets[cell]; turns && face < list.cellOffsets[cell + 1]; ++face)
    {
      reverseFace(list, face);
    }
  }
  return turned;
}

//------------------------------------------------------------------------------
void reverseFaces(ListedFaces& list)
{
  for (Index face = 0; face + 1 < static_cast<Index>(list.faceOffsets.size()); ++face)
  {
    pollInterruption(face);
    reverseFace(list, face);
  }
}

//------------------------------------------------------------------------------
void turnPolygons(std::vector<std::vector<Index>>& cells, const double* points)
{
  double twice = 0;
  for (const std::vector<Index>& cell : cells)
  {
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
      const double *a = points + 3 * cell[i], *b = points + 3 * cell[(i + 1) % cell.size()];
      twice += a[0] * b[1] - a[1] * b[0];
    }
  }
  for (std::size_t i = 0; twice < 0 && i < cells.size(); ++i)
  {
    std::reverse(cells[i].begin(), cells[i].end());
  }
}

//------------------------------------------------------------------------------
ListedFaces extrude(
  Index points, const std::vector<std::vector<Index>>& cells, ListedFacets& facets)
{
  ListedFaces list;
  const auto addFace = [&list](const std::vector<Index>& nodes)
  {
    list.nodes.insert(list.nodes.end(), nodes.begin(), nodes.end());
    list.faceOffsets.push_back(static_cast<Index>(list.nodes.size()));
  };
  const auto addFacet = [&facets](const std::vector<Index>& nodes, int patch)
  {
    facets.nodes.insert(facets.nodes.end(), nodes.begin(), nodes.end());
    facets.offsets.push_back(static_cast<Index>(facets.nodes.size()));
    facets.patch.push_back(patch);
  };
  for (const std::vector<Index>& cell : cells)
  {
    pollInterruption(static_cast<Index>(list.cellOffsets.size()));
    std::vector<Index> above(cell), below(cell.rbegin(), cell.rend());
    for (Index& node : above)
    {
      node += points;
    }
    addFace(below);
    addFace(above);
    addFacet(below, 0);
    addFacet(above, 1);
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
      const std::size_t next = (i + 1) % cell.size();
      addFace({ cell[i], cell[next], above[next], above[i] });
    }
    list.cellOffsets.push_back(static_cast<Index>(list.faceOffsets.size()) - 1);
  }
  return list;
}
}
