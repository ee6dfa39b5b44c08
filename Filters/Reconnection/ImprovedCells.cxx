// SPDX-License-Identifier: BSD-3-Clause
#include "ImprovedCells.h"

#include "MeshAdapter.h"
#include "MeshOutput.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Quality/Metrics.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr const char* AngleArray = "min_angle";
constexpr const char* RatioArray = "imr";

vtkSmartPointer<vtkDoubleArray> arrayOf(const char* name, const std::vector<double>& values)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

/// Measures cells with given point coordinates. @return whether all are valid
bool measure(const Simplices& simplices, const std::vector<double>& coordinates, bool mirrored,
  int threads, ImprovedCells& measured)
{
  const std::size_t count = simplices.cells();
  const CellType type = simplices.corners == 3 ? CellType::Triangle : CellType::Tetrahedron;
  std::vector<unsigned char> types(count, simplices.corners == 3 ? VTK_TRIANGLE : VTK_TETRA);
  std::vector<Index> offsets(count + 1);
  for (std::size_t i = 0; i <= count; ++i)
  {
    offsets[i] = static_cast<Index>(simplices.corners * i);
  }
  MeshView view;
  view.numberOfPoints = static_cast<Index>(coordinates.size() / 3);
  view.points = coordinates.data();
  view.numberOfCells = static_cast<Index>(count);
  view.cellTypes = types.data();
  view.offsets = offsets.data();
  view.connectivity = simplices.connectivity.data();
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

/// Whether the worst cells are worse than in the input.
bool isWorse(const ImprovedCells& measured, const ReconnectionRecord& before)
{
  const std::vector<double>&angles = measured.smallestAngles, &ratios = measured.inverseMeanRatios;
  // Both are measured here with a different order of operations than in the kernel.
  constexpr double Rounding = 1e-9;
  return !angles.empty() &&
    (*std::min_element(angles.begin(), angles.end()) < before.smallestAngle - Rounding ||
      *std::max_element(ratios.begin(), ratios.end()) >
        before.worstInverseMeanRatio * (1.0 + Rounding));
}

/// The coordinates rounded to single precision.
std::vector<double> toSinglePrecision(const std::vector<double>& coordinates)
{
  std::vector<double> rounded(coordinates.size());
  std::transform(coordinates.begin(), coordinates.end(), rounded.begin(),
    [](double x) { return static_cast<double>(static_cast<float>(x)); });
  return rounded;
}
}

//------------------------------------------------------------------------------
ImprovedCells writePoints(RankGroup* group, const Simplices& simplices,
  const std::vector<double>& coordinates, bool mirrored, const ReconnectionRecord& before,
  int threads, vtkPointSet* input, vtkPointSet* output)
{
  vtkPoints* given = input && input->GetNumberOfPoints() > 0 ? input->GetPoints() : nullptr;
  const bool single = given && given->GetDataType() == VTK_FLOAT;
  ImprovedCells improved;
  const auto measureAt = [&](const std::vector<double>& places)
  {
    return simplices.cells() == 0 ||
      (measure(simplices, places, mirrored, threads, improved) && !isWorse(improved, before));
  };
  const bool good = measureAt(single ? toSinglePrecision(coordinates) : coordinates);
  const bool fails = group ? group->any(single && !good) : single && !good;
  if (single && fails)
  {
    measureAt(coordinates);
  }
  output->SetPoints(single && !fails ? makePoints(coordinates, given) : makePoints(coordinates, 3));
  improved.note = fails ? PrecisionNote : "";
  return improved;
}

//------------------------------------------------------------------------------
ImprovedCells measureMarks(
  const Simplices& marks, const std::vector<double>& coordinates, int threads)
{
  constexpr double idealAngle = 60.0, idealRatio = 1.0;
  constexpr int cornersOfTriangle = 3;
  ImprovedCells measured;
  if (marks.corners == cornersOfTriangle && marks.cells() > 0)
  {
    measure(marks, coordinates, false, threads, measured);
  }
  measured.smallestAngles.resize(marks.cells(), idealAngle);
  measured.inverseMeanRatios.resize(marks.cells(), idealRatio);
  return measured;
}

//------------------------------------------------------------------------------
void copyCellData(vtkCellData* from, const std::vector<Index>& originals, vtkCellData* to)
{
  const auto count = static_cast<vtkIdType>(originals.size());
  to->CopyAllocate(from, count);
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    pollInterruption(cell);
    to->CopyData(from, originals[cell], cell);
  }
}

//------------------------------------------------------------------------------
void addCellArrays(vtkPointSet* output, const std::vector<Index>& originals, Index first,
  const ImprovedCells& improved)
{
  vtkCellData* cells = output->GetCellData();
  cells->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  vtkNew<vtkIdTypeArray> numbers;
  numbers->SetName(OriginalCellArray);
  numbers->SetNumberOfValues(static_cast<vtkIdType>(originals.size()));
  std::transform(originals.begin(), originals.end(), numbers->GetPointer(0),
    [first](Index cell) { return static_cast<vtkIdType>(first + cell); });
  cells->AddArray(numbers);
  cells->AddArray(arrayOf(AngleArray, improved.smallestAngles));
  cells->AddArray(arrayOf(RatioArray, improved.inverseMeanRatios));
  output->GetPointData()->SetActiveScalars(nullptr);
  cells->SetActiveScalars(AngleArray);
}
}
