// SPDX-License-Identifier: BSD-3-Clause
#include "ImprovedPiece.h"

#include "MeshAdapter.h"
#include "MeshOutput.h"
#include "PointRows.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <numeric>

namespace tautline
{
namespace
{
/// A point of the output, with its index in the piece and in the result; -1 if it does not exist
/// there.
struct OutputPoint
{
  Index ofPiece, ofResult;
};

Index placeOf(const std::vector<Index>& sorted, Index number)
{
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), number);
  return at != sorted.end() && *at == number ? at - sorted.begin() : -1;
}

/// The remaining points of the piece, then others.
std::vector<OutputPoint> pointsOf(const ReconnectablePiece& piece, const RankReconnection& result)
{
  std::vector<OutputPoint> points;
  std::vector<char> taken(result.numbers.size(), 0);
  for (std::size_t p = 0; p < piece.numbers.size(); ++p)
  {
    pollInterruption(static_cast<Index>(p));
    const Index number = piece.numbers[p];
    const Index at = number < 0 ? -1 : placeOf(result.numbers, number);
    if (number < 0 || (at >= 0 && !taken[at]))
    {
      points.push_back({ static_cast<Index>(p), at });
    }
    if (at >= 0)
    {
      taken[at] = 1;
    }
  }
  for (std::size_t r = 0; r < taken.size(); ++r)
  {
    if (!taken[r])
    {
      points.push_back({ -1, static_cast<Index>(r) });
    }
  }
  return points;
}

std::vector<double> coordinatesOf(const std::vector<OutputPoint>& points,
  const ReconnectablePiece& piece, const RankReconnection& result)
{
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const OutputPoint& point : points)
  {
    std::array<double, 3> x;
    if (point.ofResult >= 0)
    {
      std::copy_n(&result.points[3 * point.ofResult], 3, x.begin());
    }
    else
    {
      piece.input->GetPoint(point.ofPiece, x.data());
    }
    coordinates.insert(coordinates.end(), x.begin(), x.end());
  }
  return coordinates;
}

Simplices cellsOf(const std::vector<OutputPoint>& points, const RankReconnection& result)
{
  std::vector<Index> ids(result.numbers.size(), -1);
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    if (points[p].ofResult >= 0)
    {
      ids[points[p].ofResult] = static_cast<Index>(p);
    }
  }
  Simplices cells = { std::vector<Index>(result.tetrahedra.size()), 4 };
  std::transform(result.tetrahedra.begin(), result.tetrahedra.end(), cells.connectivity.begin(),
    [&ids](Index p) { return ids[p]; });
  return cells;
}

void writePointData(RankGroup& group, const ReconnectablePiece& piece,
  const RankReconnection& result, const std::vector<OutputPoint>& points, vtkPointSet* output)
{
  vtkNew<vtkPointData> own;
  own->ShallowCopy(piece.input->GetPointData());
  keepCommonArrays(group, own, piece.input->GetNumberOfPoints());
  std::vector<Index> wanted;
  for (const OutputPoint& point : points)
  {
    const bool elsewhere =
      point.ofPiece < 0 && result.numbers[point.ofResult] < result.firstInserted;
    if (elsewhere)
    {
      wanted.push_back(result.numbers[point.ofResult]);
    }
  }
  for (const RankReconnection::Share& share : result.shares)
  {
    wanted.push_back(share.number);
  }
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const auto rows = pointRows(group, own, piece.numbers, wanted);
  vtkPointData* to = output->GetPointData();
  to->InterpolateAllocate(own, static_cast<vtkIdType>(points.size()));
  vtkNew<vtkIdList> ids;
  std::vector<double> weights;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    pollInterruption(static_cast<Index>(i));
    const auto id = static_cast<vtkIdType>(i);
    if (points[i].ofPiece >= 0)
    {
      to->CopyData(own, points[i].ofPiece, id);
      continue;
    }
    const Index at = points[i].ofResult;
    if (result.numbers[at] < result.firstInserted)
    {
      to->CopyData(rows, placeOf(wanted, result.numbers[at]), id);
      continue;
    }
    ids->Reset();
    weights.clear();
    for (Index k = result.shareOffsets[at]; k < result.shareOffsets[at + 1]; ++k)
    {
      ids->InsertNextId(placeOf(wanted, result.shares[k].number));
      weights.push_back(result.shares[k].weight);
    }
    to->InterpolatePoint(rows, id, ids, weights.data());
  }
  to->RemoveArray(vtkDataSetAttributes::GhostArrayName());
}

void writeCellData(const ReconnectablePiece& piece, const RankReconnection& result,
  const ImprovedCells& improved, vtkPointSet* output)
{
  std::vector<Index> originals(result.originalCells.size());
  std::transform(result.originalCells.begin(), result.originalCells.end(), originals.begin(),
    [&piece](Index cell) { return piece.cells[cell]; });
  copyCellData(piece.input->GetCellData(), originals, output->GetCellData());
  addCellArrays(output, originals, piece.firstCell, improved);
}
}

//------------------------------------------------------------------------------
ImprovedCells writePiece(RankGroup& group, const ReconnectablePiece& piece,
  const RankReconnection& result, int threads, vtkPointSet* output)
{
  std::vector<OutputPoint> points;
  std::vector<double> coordinates;
  Simplices cells;
  output->Initialize();
  points = pointsOf(piece, result);
  coordinates = coordinatesOf(points, piece, result);
  cells = cellsOf(points, result);
  const ImprovedCells improved = writePoints(&group, cells, coordinates, piece.mirrored,
    result.history.front(), threads, vtkPointSet::SafeDownCast(piece.input), output);
  writePointData(group, piece, result, points, output);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(output))
  {
    grid->SetCells(VTK_TETRA, makeCells(cells.connectivity, cells.corners));
  }
  writeCellData(piece, result, improved, output);
  output->GetFieldData()->ShallowCopy(piece.input->GetFieldData());
  return improved;
}
}
