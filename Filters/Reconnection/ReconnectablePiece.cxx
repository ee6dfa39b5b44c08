// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectablePiece.h"

#include "MovableMesh.h"
#include "ReconnectableMesh.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"

#include <algorithm>
#include <numeric>

namespace tautline
{
namespace
{
/// The tetrahedra of a piece and the facets marked by its triangles.
void takeCells(const MovableMesh& mesh, ReconnectablePiece& piece)
{
  const MeshView& view = mesh.piece();
  RankTetrahedra& taken = piece.mesh;
  taken.points.assign(mesh.joinedPoints(), mesh.joinedPoints() + 3 * view.numberOfPoints);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const Index* points = view.connectivity + view.offsets[cell];
    if (view.cellTypes[cell] == VTK_TETRA && !mesh.skipped()[cell])
    {
      piece.cells.push_back(cell);
      taken.tetrahedra.insert(taken.tetrahedra.end(), points, points + 4);
    }
    else if (view.cellTypes[cell] == VTK_TRIANGLE)
    {
      const std::array<Index, 3> facet = { piece.numbers[points[0]], piece.numbers[points[1]],
        piece.numbers[points[2]] };
      if (*std::min_element(facet.begin(), facet.end()) >= 0)
      {
        taken.markedFacets.push_back(facet);
      }
    }
  }
}

/// Numbers the regions in the order of their values, the same on all processes.
void takeRegions(RankGroup& group, vtkDataArray* regions, ReconnectablePiece& piece)
{
  if (!group.any(regions != nullptr))
  {
    return;
  }
  std::vector<double> own, all;
  requireNumbers(regions);
  for (const Index cell : piece.cells)
  {
    own.push_back(regionAt(regions, cell));
  }
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  for (const std::vector<double>& list : group.gatherItems(own))
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (const Index cell : piece.cells)
  {
    const auto at = std::lower_bound(all.begin(), all.end(), regions->GetComponent(cell, 0));
    piece.mesh.regions.push_back(at - all.begin());
  }
}
}

//------------------------------------------------------------------------------
Index sumBefore(RankGroup& group, Index value)
{
  const auto all = group.gatherItems(std::vector<Index>{ value });
  return std::accumulate(all.begin(), all.begin() + group.rank(), Index(0),
    [](Index sum, const std::vector<Index>& one) { return sum + one[0]; });
}

//------------------------------------------------------------------------------
CellKinds kindsOnRanks(RankGroup& group, vtkDataSet* input)
{
  struct Count
  {
    Index type, cells;
  };
  std::vector<Count> own;
  for (const auto& [type, cells] : countCells(input, false))
  {
    own.push_back({ type, cells });
  }
  std::map<int, Index> counts;
  for (const std::vector<Count>& list : group.gatherItems(own))
  {
    for (const Count& count : list)
    {
      counts[static_cast<int>(count.type)] += count.cells;
    }
  }
  return CellKinds(counts);
}

//------------------------------------------------------------------------------
ReconnectablePiece takePiece(
  RankGroup& group, const MovableMesh& mesh, vtkDataSet* input, vtkDataArray* regions)
{
  ReconnectablePiece piece;
  piece.input = input;
  piece.numbers = mesh.idsOfPiece(mesh.pointIds());
  piece.mesh.fixed = mesh.markedOfPiece(piece.numbers);
  piece.mesh.numbers = piece.numbers;
  piece.mesh.mirrored = piece.mirrored = mesh.mirrored();
  takeCells(mesh, piece);
  takeRegions(group, regions, piece);
  piece.firstCell = sumBefore(group, input->GetNumberOfCells());
  return piece;
}
}
