// SPDX-License-Identifier: BSD-3-Clause
#include "CornerPoints.h"

#include "CellBatch.h"
#include "tautline/Core/CountingSort.h"

namespace tautline
{
namespace
{
/// Marks the corners of the `part`-th of `parts` parts of the cells of each block.
void markPart(const Mesh& mesh, int dimension, Index part, Index parts, std::vector<char>& marks)
{
  const MeshView& view = mesh.view();
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (dimension != 0 && t.dimension != dimension)
    {
      continue;
    }
    const Index end = block.count * (part + 1) / parts;
    withNodes(t,
      [&](auto nodesOfCell)
      {
        constexpr int Nodes = decltype(nodesOfCell)::value;
        char* const mark = marks.data(); // a local pointer, which stores through it cannot modify
        for (Index i = block.count * part / parts; i < end; ++i)
        {
          pollInterruption(i);
          const Index* node = view.connectivity + view.offsets[block.cell(i)];
          for (int k = 0; k < Nodes; ++k)
          {
            mark[node[k]] = 1;
          }
        }
      });
  }
}
}

//------------------------------------------------------------------------------
std::vector<char> cornerPoints(const Mesh& mesh, int dimension, int threads)
{
  const Index points = mesh.view().numberOfPoints;
  // Each part has separate marks, so that no two threads write to the same memory.
  std::vector<std::vector<char>> marks(numberOfParts(mesh.view().numberOfCells, threads));
  const auto parts = static_cast<Index>(marks.size());
  parallelFor(parts, 1, threads,
    [&](Index part)
    {
      marks[part].assign(points, 0);
      markPart(mesh, dimension, part, parts, marks[part]);
    });
  for (std::size_t part = 1; part < marks.size(); ++part)
  {
    std::transform(marks[0].begin(), marks[0].end(), marks[part].begin(), marks[0].begin(),
      [](char a, char b) { return static_cast<char>(a | b); });
  }
  return std::move(marks[0]);
}
}
