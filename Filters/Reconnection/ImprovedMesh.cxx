// SPDX-License-Identifier: BSD-3-Clause
#include "ImprovedMesh.h"

#include "MeshOutput.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// The points and cells of the output.
struct Geometry
{
  std::vector<Index> points; ///< of the result, in the order of the output
  std::vector<double> coordinates;
  Simplices cells;
};

/// The result without the points that were merged into another one.
Geometry geometryOf(const ReconnectableMesh& input, const ReconnectionResult& result)
{
  Geometry geometry;
  std::vector<Index> numbers(result.originalPoints.size(), -1);
  for (std::size_t p = 0; p < result.originalPoints.size(); ++p)
  {
    const Index original = result.originalPoints[p];
    if (original < 0 || !input.isMerged(original))
    {
      numbers[p] = static_cast<Index>(geometry.points.size());
      geometry.points.push_back(static_cast<Index>(p));
      const double* x = &result.points[3 * p];
      geometry.coordinates.insert(geometry.coordinates.end(), x, x + 3);
    }
  }
  const std::vector<Index>& cells = input.isTriangles() ? result.triangles : result.tetrahedra;
  geometry.cells = { std::vector<Index>(cells.size()), input.corners() };
  std::transform(cells.begin(), cells.end(), geometry.cells.connectivity.begin(),
    [&numbers](Index p) { return numbers[p]; });
  return geometry;
}

void writePointData(const ReconnectableMesh& input, const ReconnectionResult& result,
  const Geometry& geometry, vtkPointSet* output)
{
  vtkPointData* from = input.input()->GetPointData();
  vtkPointData* to = output->GetPointData();
  to->InterpolateAllocate(from, static_cast<vtkIdType>(geometry.points.size()));
  auto place = result.interpolations.begin();
  vtkNew<vtkIdList> corners;
  for (std::size_t i = 0; i < geometry.points.size(); ++i)
  {
    pollInterruption(static_cast<Index>(i));
    const vtkIdType id = static_cast<vtkIdType>(i);
    const Index original = result.originalPoints[geometry.points[i]];
    if (original >= 0)
    {
      to->CopyData(from, original, id);
      continue;
    }
    while (place->point != geometry.points[i])
    {
      ++place;
    }
    const MeshView& view = input.mesh().view();
    corners->SetNumberOfIds(geometry.cells.corners);
    std::copy_n(
      view.connectivity + view.offsets[place->cell], geometry.cells.corners, corners->begin());
    to->InterpolatePoint(from, id, corners, const_cast<double*>(place->weights.data()));
  }
  to->RemoveArray(vtkDataSetAttributes::GhostArrayName());
}

/// Averages the arrays of real numbers over the cells of the input that each cell overlaps.
void averageCellData(
  const ReconnectableMesh& input, const CellOverlaps& overlaps, vtkCellData* from, vtkCellData* to)
{
  for (int a = 0; a < from->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* source = from->GetArray(a);
    const bool real =
      source && (source->GetDataType() == VTK_DOUBLE || source->GetDataType() == VTK_FLOAT);
    vtkDataArray* target = real && source->GetName() ? to->GetArray(source->GetName()) : nullptr;
    for (vtkIdType cell = 0; target && cell < target->GetNumberOfTuples(); ++cell)
    {
      for (int k = 0; k < source->GetNumberOfComponents(); ++k)
      {
        target->SetComponent(cell, k,
          overlaps.average(
            cell, [&](Index c) { return source->GetComponent(input.inputCell(c), k); }));
      }
    }
  }
}

void writeCellData(const ReconnectableMesh& input, const ReconnectionResult& result,
  const ImprovedCells& improved, vtkPointSet* output)
{
  std::vector<Index> originals(result.originalCells.size());
  std::transform(result.originalCells.begin(), result.originalCells.end(), originals.begin(),
    [&input](Index cell) { return input.inputCell(cell); });
  vtkCellData* from = input.input()->GetCellData();
  vtkCellData* to = output->GetCellData();
  copyCellData(from, originals, to);
  if (!result.overlaps.offsets.empty())
  {
    averageCellData(input, result.overlaps, from, to);
  }
  addCellArrays(output, originals, 0, improved);
}
}

//------------------------------------------------------------------------------
ImprovedCells writeImproved(const ReconnectableMesh& input, const ReconnectionResult& result,
  int threads, vtkPointSet* output)
{
  const Geometry geometry = geometryOf(input, result);
  output->Initialize();
  const ImprovedCells improved = writePoints(nullptr, geometry.cells, geometry.coordinates,
    input.mesh().mirrored(), result.history.front(), threads, input.input(), output);
  const auto cells = makeCells(geometry.cells.connectivity, geometry.cells.corners);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(output))
  {
    grid->SetCells(input.isTriangles() ? VTK_TRIANGLE : VTK_TETRA, cells);
  }
  else
  {
    vtkPolyData::SafeDownCast(output)->SetPolys(cells);
  }
  writePointData(input, result, geometry, output);
  writeCellData(input, result, improved, output);
  output->GetFieldData()->ShallowCopy(input.input()->GetFieldData());
  return improved;
}
}
