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
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <limits>

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
  /// Lines beside triangles, or triangles beside tetrahedra, and their original cells in the input.
  Simplices marks;
  std::vector<Index> markOrigins;
};

/// The result without merged points.
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
  const auto renumbered = [&numbers](const std::vector<Index>& points)
  {
    std::vector<Index> ids(points.size());
    std::transform(
      points.begin(), points.end(), ids.begin(), [&numbers](Index p) { return numbers[p]; });
    return ids;
  };
  const std::vector<Index>& cells = input.isTriangles() ? result.triangles : result.tetrahedra;
  geometry.cells = { renumbered(cells), input.corners() };
  geometry.marks.corners = input.corners() - 1;
  if (!result.adapted)
  {
    return geometry;
  }
  geometry.marks.connectivity = renumbered(input.isTriangles() ? result.lines : result.facets);
  geometry.markOrigins = input.isTriangles() ? result.originalLines : result.originalFacets;
  for (Index& origin : geometry.markOrigins)
  {
    origin = input.markCells()[origin];
  }
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
/// @param first the index of the first cell in the output
void averageCellData(const ReconnectableMesh& input, const CellOverlaps& overlaps,
  std::size_t first, vtkCellData* from, vtkCellData* to)
{
  const auto count = static_cast<vtkIdType>(overlaps.offsets.size()) - 1;
  for (int a = 0; a < from->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* source = from->GetArray(a);
    const bool real =
      source && (source->GetDataType() == VTK_DOUBLE || source->GetDataType() == VTK_FLOAT);
    vtkDataArray* target = real && source->GetName() ? to->GetArray(source->GetName()) : nullptr;
    for (vtkIdType cell = 0; target && cell < count; ++cell)
    {
      for (int k = 0; k < source->GetNumberOfComponents(); ++k)
      {
        target->SetComponent(static_cast<vtkIdType>(first) + cell, k,
          overlaps.average(
            cell, [&](Index c) { return source->GetComponent(input.inputCell(c), k); }));
      }
    }
  }
}

/// @param marksFirst whether the marks come before the other cells, as lines do in poly data
void writeCellData(const ReconnectableMesh& input, const ReconnectionResult& result,
  const Geometry& geometry, const ImprovedCells& improved, bool marksFirst, vtkPointSet* output)
{
  std::vector<Index> originals(result.originalCells.size());
  std::transform(result.originalCells.begin(), result.originalCells.end(), originals.begin(),
    [&input](Index cell) { return input.inputCell(cell); });
  originals.insert(marksFirst ? originals.begin() : originals.end(), geometry.markOrigins.begin(),
    geometry.markOrigins.end());
  vtkCellData* from = input.input()->GetCellData();
  vtkCellData* to = output->GetCellData();
  copyCellData(from, originals, to);
  if (!result.overlaps.offsets.empty())
  {
    averageCellData(input, result.overlaps, marksFirst ? geometry.marks.cells() : 0, from, to);
  }
  ImprovedCells all = measureMarks(geometry.marks, geometry.coordinates, 1);
  const auto join = [marksFirst](std::vector<double>& marks, const std::vector<double>& cells)
  { marks.insert(marksFirst ? marks.end() : marks.begin(), cells.begin(), cells.end()); };
  join(all.smallestAngles, improved.smallestAngles);
  join(all.inverseMeanRatios, improved.inverseMeanRatios);
  addCellArrays(output, originals, 0, all);
}
}

//------------------------------------------------------------------------------
ImprovedCells writeImproved(const ReconnectableMesh& input, const ReconnectionResult& result,
  int threads, vtkPointSet* output)
{
  ReconnectionRecord floor = result.history.front();
  if (result.adapted)
  {
    // The elements deliberately have different shapes: any valid shape is acceptable.
    floor.smallestAngle = 0.0;
    floor.worstInverseMeanRatio = std::numeric_limits<double>::infinity();
  }
  const Geometry geometry = geometryOf(input, result);
  output->Initialize();
  const ImprovedCells improved = writePoints(nullptr, geometry.cells, geometry.coordinates,
    input.mesh().mirrored(), floor, threads, input.input(), output);
  const auto cells = makeCells(geometry.cells.connectivity, geometry.cells.corners);
  const auto marks = makeCells(geometry.marks.connectivity, geometry.marks.corners);
  auto* surface = vtkPolyData::SafeDownCast(output);
  if (surface)
  {
    surface->SetPolys(cells);
    surface->SetLines(marks);
  }
  else
  {
    vtkNew<vtkUnsignedCharArray> types;
    types->SetNumberOfValues(cells->GetNumberOfCells() + marks->GetNumberOfCells());
    std::fill_n(types->GetPointer(0), cells->GetNumberOfCells(),
      static_cast<unsigned char>(input.isTriangles() ? VTK_TRIANGLE : VTK_TETRA));
    std::fill_n(types->GetPointer(cells->GetNumberOfCells()), marks->GetNumberOfCells(),
      static_cast<unsigned char>(input.isTriangles() ? VTK_LINE : VTK_TRIANGLE));
    cells->Append(marks);
    vtkUnstructuredGrid::SafeDownCast(output)->SetCells(types, cells);
  }
  writePointData(input, result, geometry, output);
  writeCellData(input, result, geometry, improved, surface != nullptr, output);
  output->GetFieldData()->ShallowCopy(input.input()->GetFieldData());
  return improved;
}
}
