// SPDX-License-Identifier: BSD-3-Clause
#include "ImprovedMesh.h"

#include "MeshOutput.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Quality/Metrics.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr const char* AngleArray = "min_angle";
constexpr const char* RatioArray = "imr";

/// The points and cells of the output.
struct Geometry
{
  std::vector<Index> points; ///< of the result, in the order of the output
  std::vector<double> coordinates;
  std::vector<Index> connectivity;
  int corners = 0; ///< of a cell
  std::size_t cells() const { return this->connectivity.size() / this->corners; }
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
  geometry.corners = input.corners();
  const std::vector<Index>& cells = input.isTriangles() ? result.triangles : result.tetrahedra;
  geometry.connectivity.resize(cells.size());
  std::transform(cells.begin(), cells.end(), geometry.connectivity.begin(),
    [&numbers](Index p) { return numbers[p]; });
  return geometry;
}

/// Measures the cells with their points at some coordinates. @return whether all are valid
bool measure(const Geometry& geometry, const std::vector<double>& coordinates, bool mirrored,
  int threads, ImprovedMesh& measured)
{
  const std::size_t count = geometry.cells();
  const CellType type = geometry.corners == 3 ? CellType::Triangle : CellType::Tetrahedron;
  std::vector<unsigned char> types(count, geometry.corners == 3 ? VTK_TRIANGLE : VTK_TETRA);
  std::vector<Index> offsets(count + 1);
  for (std::size_t i = 0; i <= count; ++i)
  {
    offsets[i] = static_cast<Index>(geometry.corners * i);
  }
  MeshView view;
  view.numberOfPoints = static_cast<Index>(coordinates.size() / 3);
  view.points = coordinates.data();
  view.numberOfCells = static_cast<Index>(count);
  view.cellTypes = types.data();
  view.offsets = offsets.data();
  view.connectivity = geometry.connectivity.data();
  Mesh mesh(view, threads);
  mesh.setMirrored(mirrored);
  std::vector<signed char> validity(count);
  mesh.classifyCells(validity.data(), threads);
  EvaluationOptions options;
  options.threads = threads;
  measured.smallestAngles.resize(count);
  measured.inverseMeanRatios.resize(count);
  evaluateMetric(mesh, Metric::MinimumAngle, options, measured.smallestAngles.data());
  evaluateMetric(mesh, Metric::InverseMeanRatio, options, measured.inverseMeanRatios.data());
  measured.centers.clear();
  for (std::size_t i = 0; i < count; ++i)
  {
    measured.centers.push_back(mesh.center(static_cast<Index>(i), type));
  }
  return std::all_of(validity.begin(), validity.end(), [](signed char v) { return v == Valid; });
}

bool isWorse(const ImprovedMesh& measured, const ReconnectionRecord& before)
{
  const std::vector<double>&angles = measured.smallestAngles, &ratios = measured.inverseMeanRatios;
  // Both are measured here in another order of operations than in the kernel.
  constexpr double Rounding = 1e-9;
  return !angles.empty() &&
    (*std::min_element(angles.begin(), angles.end()) < before.smallestAngle - Rounding ||
      *std::max_element(ratios.begin(), ratios.end()) >
        before.worstInverseMeanRatio * (1.0 + Rounding));
}

/// Sets the points in the precision of the input where that does.
ImprovedMesh writePoints(const ReconnectableMesh& input, const ReconnectionResult& result,
  const Geometry& geometry, int threads, vtkPointSet* output)
{
  const bool mirrored = input.mesh().mirrored();
  ImprovedMesh improved;
  auto points = makePoints(geometry.coordinates, input.input()->GetPoints());
  if (points->GetDataType() != VTK_DOUBLE)
  {
    std::vector<double> rounded(geometry.coordinates.size());
    std::transform(geometry.coordinates.begin(), geometry.coordinates.end(), rounded.begin(),
      [](double x) { return static_cast<double>(static_cast<float>(x)); });
    if (measure(geometry, rounded, mirrored, threads, improved) &&
      !isWorse(improved, result.history.front()))
    {
      output->SetPoints(points);
      return improved;
    }
    points = makePoints(geometry.coordinates, 3);
    improved.note = "The points are in double precision: rounded to the single precision of the "
                    "input, an element would be worse than before.";
  }
  measure(geometry, geometry.coordinates, mirrored, threads, improved);
  output->SetPoints(points);
  return improved;
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
    corners->SetNumberOfIds(geometry.corners);
    std::copy_n(view.connectivity + view.offsets[place->cell], geometry.corners, corners->begin());
    to->InterpolatePoint(from, id, corners, const_cast<double*>(place->weights.data()));
  }
  to->RemoveArray(vtkDataSetAttributes::GhostArrayName());
}

vtkSmartPointer<vtkDoubleArray> arrayOf(const char* name, const std::vector<double>& values)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
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
  const ImprovedMesh& improved, vtkPointSet* output)
{
  const auto count = static_cast<vtkIdType>(result.originalCells.size());
  vtkCellData* from = input.input()->GetCellData();
  vtkCellData* to = output->GetCellData();
  to->CopyAllocate(from, count);
  vtkNew<vtkIdTypeArray> originals;
  originals->SetName(OriginalCellArray);
  originals->SetNumberOfValues(count);
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    pollInterruption(cell);
    const Index original = input.inputCell(result.originalCells[cell]);
    to->CopyData(from, original, cell);
    originals->SetValue(cell, original);
  }
  if (!result.overlaps.offsets.empty())
  {
    averageCellData(input, result.overlaps, from, to);
  }
  to->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  to->AddArray(originals);
  to->AddArray(arrayOf(AngleArray, improved.smallestAngles));
  to->AddArray(arrayOf(RatioArray, improved.inverseMeanRatios));
  output->GetPointData()->SetActiveScalars(nullptr);
  to->SetActiveScalars(AngleArray);
}
}

//------------------------------------------------------------------------------
ImprovedMesh writeImproved(const ReconnectableMesh& input, const ReconnectionResult& result,
  int threads, vtkPointSet* output)
{
  const Geometry geometry = geometryOf(input, result);
  output->Initialize();
  const ImprovedMesh improved = writePoints(input, result, geometry, threads, output);
  const auto cells = makeCells(geometry.connectivity, geometry.corners);
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
