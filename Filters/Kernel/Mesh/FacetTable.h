// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetTable.h
 * @brief The edges of 2D cells, or the faces of 3D cells, with the cells that use each.
 * Internal: not installed.
 */
#ifndef tautline_FacetTable_h
#define tautline_FacetTable_h

#include "Mesh.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace tautline
{
/// One use of an edge or face by a cell, stored by its smallest node.
struct FacetUse
{
  std::array<Index, MaxFaceNodes - 1> others; ///< the other nodes in increasing order, then -1
  Index cell;
  /// The direction in which the cell traverses the facet; the orders of two cells agree if their
  /// directions differ.
  bool forward;
  Index sum; ///< of the nodes of the cell; duplicates have equal sums
};

/// Whether two cells have the same nodes, in any order.
inline bool sameNodes(const MeshView& view, Index a, Index b)
{
  const Index size = view.offsets[a + 1] - view.offsets[a];
  return size == view.offsets[b + 1] - view.offsets[b] &&
    std::is_permutation(view.connectivity + view.offsets[a],
      view.connectivity + view.offsets[a] + size, view.connectivity + view.offsets[b]);
}

/**
 * @brief The facets (edges or faces) of the cells of highest dimension of a mesh, stored by
 * smallest node. Only the first of several cells with the same nodes is used: the boundary facets
 * of a duplicate are used once. For large meshes, the facets are processed in parts, one after the
 * other, which need a quarter of the memory.
 */
class FacetTable
{
public:
  /// @param skip one flag per cell: nonzero to ignore it; may be null. Both must outlive the table.
  explicit FacetTable(const Mesh& mesh, const unsigned char* skip = nullptr)
    : TheMesh(mesh)
    , View(mesh.view())
    , Skip(skip)
    , Starts(mesh.view().numberOfPoints + 1, 0)
  {
    this->forEachUse([&](Index smallest, const FacetUse&) { ++this->Starts[smallest + 1]; });
    std::partial_sum(this->Starts.begin(), this->Starts.end(), this->Starts.begin());
  }

  /// Calls visit(smallest node, uses, count) for every facet; its uses are in order of cell.
  template <class Visit>
  void forEachFacet(const Visit& visit)
  {
    constexpr Index small = Index(1) << 20; // number of uses that are always stored at once
    constexpr Index parts = 4;
    const Index nodes = static_cast<Index>(this->Starts.size()) - 1;
    const Index most = std::max(small, this->Starts.back() / parts);
    for (Index first = 0; first < nodes;)
    {
      const Index limit = this->Starts[first] + most;
      const auto after =
        std::upper_bound(this->Starts.begin() + first + 2, this->Starts.end(), limit);
      const Index last = static_cast<Index>(after - this->Starts.begin()) - 1;
      this->fileUses(first, last);
      this->visitFacets(first, last, visit);
      first = last;
    }
  }

private:
  /// Stores the uses of facets with a smallest node from `first` to `last` - 1.
  void fileUses(Index first, Index last)
  {
    const Index begin = this->Starts[first];
    this->makeRoom(this->Starts[last] - begin);
    std::vector<Index> next(this->Starts.begin() + first, this->Starts.begin() + last);
    this->forEachUse(
      [&](Index smallest, const FacetUse& use)
      {
        if (smallest >= first && smallest < last)
        {
          this->Uses[next[smallest - first]++ - begin] = use;
        }
      });
  }

  template <class Visit>
  void visitFacets(Index first, Index last, const Visit& visit)
  {
    for (Index node = first; node < last; ++node)
    {
      pollInterruption(node);
      const Index begin = this->Starts[node] - this->Starts[first],
                  end = this->Starts[node + 1] - this->Starts[first];
      if (begin == end)
      {
        continue;
      }
      std::sort(this->Uses.begin() + begin, this->Uses.begin() + end,
        [](const FacetUse& a, const FacetUse& b)
        { return a.others != b.others ? a.others < b.others : a.cell < b.cell; });
      for (Index i = begin; i < end;)
      {
        Index j = i + 1;
        while (j < end && this->Uses[j].others == this->Uses[i].others)
        {
          ++j;
        }
        visit(node, &this->Uses[i], this->dropDuplicates(i, j) - i);
        i = j;
      }
    }
  }

  /// In parts, because clearing that much memory takes a while.
  void makeRoom(Index uses)
  {
    constexpr Index part = Index(1) << 18;
    this->Uses.clear();
    this->Uses.reserve(uses);
    for (Index size = 0; size < uses;)
    {
      throwIfInterrupted();
      size = std::min(uses, size + part);
      this->Uses.resize(size);
    }
  }

  /// Moves the uses of a facet by distinct cells to the front. @return the end of these
  Index dropDuplicates(Index begin, Index end)
  {
    constexpr Index many = 64; // number of cells at a facet that is certainly not manifold
    if (end - begin > many)
    {
      return end;
    }
    Index kept = begin + 1;
    for (Index i = begin + 1; i < end; ++i)
    {
      const FacetUse& use = this->Uses[i];
      const bool duplicate = std::any_of(this->Uses.begin() + begin, this->Uses.begin() + kept,
        [&](const FacetUse& other)
        { return other.sum == use.sum && sameNodes(this->View, other.cell, use.cell); });
      if (!duplicate)
      {
        this->Uses[kept++] = use;
      }
    }
    return kept;
  }

  template <class Visit>
  void forEachUse(const Visit& visit) const
  {
    const MeshView& view = this->View;
    const int dimension = this->TheMesh.dimension() == Dimension::Volume ? 3 : 2;
    const unsigned char* skip = this->Skip;
    for (const CellBlock& block : this->TheMesh.blocks())
    {
      const CellTopology& t = topology(block.type);
      if (t.dimension != dimension)
      {
        continue;
      }
      const int facets = dimension == 3 ? t.faces : t.edges;
      for (Index i = 0; i < block.count; ++i)
      {
        pollInterruption(i);
        const Index cell = block.cell(i);
        if (skip && skip[cell])
        {
          continue;
        }
        const Index* node = view.connectivity + view.offsets[cell];
        const Index sum = std::accumulate(node, node + t.nodes, Index(0));
        for (int f = 0; f < facets; ++f)
        {
          Index nodes[MaxFaceNodes] = {};
          const int size = dimension == 3 ? t.faceSizes[f] : 2;
          int smallest = 0;
          for (int k = 0; k < size; ++k)
          {
            nodes[k] = node[dimension == 3 ? t.faceNodes[f][k] : t.edgeNodes[f][k]];
            smallest = nodes[k] < nodes[smallest] ? k : smallest;
          }
          // The direction follows from the neighbors of the smallest node or, for an edge, from
          // whether the smallest node comes first.
          const Index next = nodes[(smallest + 1) % size];
          const Index previous = nodes[(smallest + size - 1) % size];
          FacetUse use = { { next, -1, -1 }, cell, smallest == 0, sum };
          if (size > 2)
          {
            use.forward = next < previous;
            use.others = { std::min(next, previous), std::max(next, previous), -1 };
          }
          if (size > 3)
          {
            use.others[2] = nodes[(smallest + 2) % size];
          }
          visit(nodes[smallest], use);
        }
      }
    }
  }

  const Mesh& TheMesh;
  MeshView View;
  const unsigned char* Skip;
  std::vector<Index> Starts;
  std::vector<FacetUse> Uses;
};
}
#endif
