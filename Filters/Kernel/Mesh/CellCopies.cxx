// SPDX-License-Identifier: BSD-3-Clause
#include "CellCopies.h"

#include "FacetTable.h"
#include "tautline/Core/Random.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tautline
{
namespace
{
/// The points of a facet in the order in which the cell traverses it, from the smallest one.
struct Walk
{
  std::array<Index, MaxFaceNodes> points;
  int size;

  bool operator==(const Walk& other) const
  {
    return this->size == other.size &&
      std::equal(this->points.begin(), this->points.begin() + this->size, other.points.begin());
  }
};

Walk walkOf(const CellTopology& t, int facet, const Index* nodes, bool reversed)
{
  Walk walk = { {}, t.dimension == 3 ? t.faceSizes[facet] : 2 };
  for (int k = 0; k < walk.size; ++k)
  {
    walk.points[k] = nodes[t.dimension == 3 ? t.faceNodes[facet][k] : t.edgeNodes[facet][k]];
  }
  const auto begin = walk.points.begin(), end = begin + walk.size;
  if (reversed)
  {
    std::reverse(begin, end);
  }
  if (walk.size > 2) // the order of an edge is its orientation
  {
    std::rotate(begin, std::min_element(begin, end), end);
  }
  return walk;
}

/// A cell with a number that depends only on its point locations, not on their order.
struct PlacedCell
{
  std::uint64_t key;
  Index cell;
};

using CellPlaces = std::array<Index, MaxNodes>;

CellPlaces placesOf(const MeshView& view, const std::vector<Index>& placeOf, Index cell, int nodes)
{
  CellPlaces places = {};
  const Index* node = view.connectivity + view.offsets[cell];
  std::transform(node, node + nodes, places.begin(), [&](Index p) { return placeOf[p]; });
  return places;
}

/// The cells of a block with a point that coincides with others, grouped by key; without cells with
/// two coincident points.
std::vector<PlacedCell> placedCells(const Mesh& mesh, const CellBlock& block,
  const std::vector<Index>& placeOf, const std::vector<char>& several, const unsigned char* ghosts)
{
  const MeshView& view = mesh.view();
  const int nodes = topology(block.type).nodes;
  std::vector<PlacedCell> cells;
  for (Index i = 0; i < block.count; ++i)
  {
    const Index cell = block.cell(i);
    const Index* node = view.connectivity + view.offsets[cell];
    if ((ghosts && ghosts[cell]) ||
      std::none_of(node, node + nodes, [&](Index p) { return several[p] != 0; }))
    {
      continue;
    }
    const CellPlaces places = placesOf(view, placeOf, cell, nodes);
    std::uint64_t key = 0;
    bool collapsed = false;
    for (int k = 0; k < nodes; ++k)
    {
      // A sum of hashes does not depend on the order of the points.
      key += SplitMix::mixed(static_cast<std::uint64_t>(places[k]));
      for (int j = 0; j < k; ++j)
      {
        collapsed = collapsed || places[j] == places[k];
      }
    }
    if (!collapsed)
    {
      cells.push_back({ key, cell });
    }
  }
  std::sort(cells.begin(), cells.end(),
    [](const PlacedCell& a, const PlacedCell& b)
    { return a.key != b.key ? a.key < b.key : a.cell < b.cell; });
  return cells;
}
}

//------------------------------------------------------------------------------
bool sameFacets(CellType type, const Index* a, const Index* b, bool reversed)
{
  if (type == CellType::Unsupported)
  {
    return false;
  }
  const CellTopology& t = topology(type);
  const int facets = t.dimension == 3 ? t.faces : t.edges;
  for (int f = 0; f < facets; ++f)
  {
    const Walk walk = walkOf(t, f, a, false);
    int other = 0;
    while (other < facets && !(walkOf(t, other, b, reversed) == walk))
    {
      ++other;
    }
    if (other == facets)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
std::vector<unsigned char> findCopies(const Mesh& mesh, const std::vector<Index>& placeOf,
  const std::vector<char>& several, const unsigned char* reversed, const unsigned char* ghosts)
{
  const MeshView& view = mesh.view();
  // where no orientation is preferred
  const bool onSurface = mesh.dimension() == Dimension::Surface;
  std::vector<unsigned char> copies;
  for (const CellBlock& block : mesh.blocks())
  {
    const int nodes = topology(block.type).nodes;
    const std::vector<PlacedCell> cells = placedCells(mesh, block, placeOf, several, ghosts);
    for (std::size_t begin = 0, i = 0; i < cells.size(); ++i)
    {
      // Cells with the same key are compared in pairs, because different cells may share a key.
      begin = cells[i].key == cells[begin].key ? begin : i;
      for (std::size_t j = begin; j < i; ++j)
      {
        const Index a = cells[j].cell, b = cells[i].cell;
        // If only one of both cells is reversed, they traverse their facets in opposite directions.
        const bool opposite = reversed && (reversed[a] != 0) != (reversed[b] != 0);
        const CellPlaces first = placesOf(view, placeOf, a, nodes),
                         second = placesOf(view, placeOf, b, nodes);
        if ((copies.empty() || !copies[a]) &&
          (sameFacets(block.type, first.data(), second.data(), opposite) ||
            (onSurface && sameFacets(block.type, first.data(), second.data(), !opposite))))
        {
          copies.resize(view.numberOfCells, 0);
          copies[b] = 1;
          break;
        }
      }
    }
  }
  return copies;
}

//------------------------------------------------------------------------------
Overlap findOverlap(const Mesh& mesh, const signed char* validity, const unsigned char* counted)
{
  Overlap overlap;
  if (mesh.dimension() != Dimension::Volume && mesh.dimension() != Dimension::Planar)
  {
    return overlap;
  }
  const Index cells = mesh.view().numberOfCells;
  // If no cell is valid, the mesh is reversed, and inverted cells are the proper ones.
  const signed char proper =
    std::find(validity, validity + cells, Valid) == validity + cells ? Inverted : Valid;
  FacetTable(mesh).forEachFacet(
    [&](Index smallest, const FacetUse* uses, Index count)
    {
      // Two proper cells that traverse their facet in the same direction lie on the same side of
      // it.
      if (count == 2 && uses[0].forward == uses[1].forward && validity[uses[0].cell] == proper &&
        validity[uses[1].cell] == proper && (!counted || counted[smallest]))
      {
        overlap.first = overlap.facets++ == 0 ? smallest : std::min(overlap.first, smallest);
      }
    });
  return overlap;
}
}
