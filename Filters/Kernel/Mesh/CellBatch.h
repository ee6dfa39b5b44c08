// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellBatch.h
 * @brief The vertices of several cells of one type, gathered into packets.
 * Internal: not installed.
 */
#ifndef tautline_CellBatch_h
#define tautline_CellBatch_h

#include "CellExtent.h"
#include "Mesh.h"
#include "tautline/Core/Packet.h"

#include <type_traits>

namespace tautline
{
/// The block of a mesh from which cells are gathered.
struct CellSource
{
  const Mesh* mesh = nullptr;
  const CellBlock* block = nullptr;
  const CellTopology* topology = nullptr;
};

/// Up to PacketWidth cells and their vertices.
struct CellVertices
{
  /// The last one is repeated to fill the packet; in ElementSum::run() only on request.
  Index cells[PacketWidth];
  int count = 0;
  Packet points[MaxNodes][3];
  bool scaled = false; ///< whether normalizeExtents() has scaled a cell
  Packet unit;         ///< if scaled: the length that is 1 in the points; a power of two
};

/// Calls work(N) with the number of nodes as a compile-time constant, so that loops over it unroll.
template <class Work>
void withNodes(const CellTopology& topology, const Work& work)
{
  switch (topology.nodes)
  {
    case 3:
      return work(std::integral_constant<int, 3>());
    case 4:
      return work(std::integral_constant<int, 4>());
    case 5:
      return work(std::integral_constant<int, 5>());
    case 6:
      return work(std::integral_constant<int, 6>());
    default:
      static_assert(MaxNodes == 8, "a case for each number of nodes");
      return work(std::integral_constant<int, 8>());
  }
}

/// Pointers to the nodes of each cell of a batch in the connectivity.
using BatchNodes = const Index* [PacketWidth];

/// Finds the nodes of cells [begin, begin + count) of a block; order maps positions if not null.
inline void locate(const CellSource& source, const Index* order, Index begin, int count,
  CellVertices& batch, BatchNodes& nodes)
{
  const MeshView& view = source.mesh->view();
  for (int l = 0; l < PacketWidth; ++l)
  {
    const Index position = begin + (l < count ? l : count - 1);
    const Index cell = source.block->cell(order ? order[position] : position);
    batch.cells[l] = cell;
    nodes[l] = view.connectivity + view.offsets[cell];
  }
  batch.count = count;
}

/// Loads the vertices of the cells of a batch, with the node numbers `nodes`.
template <int Nodes, class Numbers>
inline __attribute__((always_inline)) void loadNodes(
  const CellSource& source, const double* points, const Numbers& nodes, CellVertices& batch)
{
  for (int k = 0; k < Nodes; ++k)
  {
    const double* p[PacketWidth];
    for (int l = 0; l < PacketWidth; ++l)
    {
      p[l] = points + 3 * static_cast<Index>(nodes[l][k]);
    }
    loadPoints(p, batch.points[k]);
  }
  if (source.mesh->mirrored() && source.mesh->dimension() == Dimension::Volume)
  {
    for (int k = 0; k < Nodes; ++k)
    {
      batch.points[k][0] = -batch.points[k][0];
    }
  }
}

/// Scales extremely small or large cells exactly, by powers of two.
template <int Nodes>
void normalizeExtents(CellVertices& batch)
{
  Packet extent = {};
  for (int k = 1; k < Nodes; ++k)
  {
    for (int c = 0; c < 3; ++c)
    {
      extent = max(extent, abs(batch.points[k][c] - batch.points[0][c]));
    }
  }
  batch.scaled = any(~((extent > SmallestExtent) & (extent < LargestExtent)));
  if (batch.scaled)
  {
    batch.unit = each(extent, unitOfExtent);
    const Packet perUnit = 1.0 / batch.unit;
    for (int k = 0; k < Nodes; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        batch.points[k][c] *= perUnit;
      }
    }
  }
}

/// Loads the vertices of the cells that locate() finds.
template <int Nodes>
void gather(const CellSource& source, const Index* order, Index begin, int count,
  CellVertices& batch, BatchNodes& nodes)
{
  locate(source, order, begin, count, batch, nodes);
  loadNodes<Nodes>(source, source.mesh->view().points, nodes, batch);
}
}
#endif
