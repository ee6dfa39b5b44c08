// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <numeric>

namespace tautline
{
VertexCells Mesh::vertexCells() const
{
  VertexCells result;
  result.offsets.assign(this->View.numberOfPoints + 1, 0);
  // The first pass counts the uses, the second stores them; both must visit them in the same order.
  auto forEachUse = [&](auto visit)
  {
    for (const CellBlock& block : this->Blocks)
    {
      const int nodes = topology(block.type).nodes;
      for (Index i = 0; i < block.count; ++i)
      {
        pollInterruption(i);
        const Index cell = block.cell(i);
        const Index* node = this->View.connectivity + this->View.offsets[cell];
        for (int k = 0; k < nodes; ++k)
        {
          visit(node[k], cell);
        }
      }
    }
  };
  forEachUse([&](Index node, Index) { ++result.offsets[node + 1]; });
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.cells.resize(result.offsets.back());
  std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
  forEachUse([&](Index node, Index cell) { result.cells[next[node]++] = cell; });
  // With one block, cells are visited in ascending order; with several, they are ordered by type.
  if (this->Blocks.size() > 1)
  {
    for (Index v = 0; v < this->View.numberOfPoints; ++v)
    {
      std::sort(
        result.cells.begin() + result.offsets[v], result.cells.begin() + result.offsets[v + 1]);
    }
  }
  return result;
}
}
