// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshOutput.h
 * @brief Converts plain vectors of points, simplices and markers to VTK data sets.
 */
#ifndef tautline_MeshOutput_h
#define tautline_MeshOutput_h

#include "tautline/Core/Types.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkTypeInt64Array.h"

#include <algorithm>
#include <vector>

namespace tautline
{
/// Points with `dimension` coordinates each; planar points get the third coordinate z.
inline vtkSmartPointer<vtkPoints> makePoints(
  const std::vector<double>& coordinates, int dimension, double z = 0.0)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(VTK_DOUBLE);
  const auto width = static_cast<std::size_t>(dimension);
  points->SetNumberOfPoints(static_cast<vtkIdType>(coordinates.size() / width));
  for (std::size_t i = 0; i < coordinates.size() / width; ++i)
  {
    const double* x = coordinates.data() + width * i;
    points->SetPoint(static_cast<vtkIdType>(i), x[0], x[1], dimension == 3 ? x[2] : z);
  }
  return points;
}

/// Cells with `size` points each.
inline vtkSmartPointer<vtkCellArray> makeCells(const std::vector<Index>& nodes, int size)
{
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->Use64BitStorage();
  vtkNew<vtkTypeInt64Array> connectivity;
  connectivity->SetNumberOfTuples(static_cast<vtkIdType>(nodes.size()));
  std::copy(nodes.begin(), nodes.end(), connectivity->GetPointer(0));
  cells->SetData(size, connectivity);
  return cells;
}

/// The marker of a cell in an array of any type; 0 if it is not a number in the range of int.
inline int markerAt(vtkDataArray* markers, vtkIdType cell)
{
  const double value = markers->GetComponent(cell, 0);
  constexpr double Limit = 2147483647.0;
  return value >= -Limit && value <= Limit ? static_cast<int>(value) : 0;
}

/// A 64-bit array, as made by the readers.
inline vtkSmartPointer<vtkTypeInt64Array> makeMarkers(
  const char* name, const std::vector<int>& values)
{
  auto array = vtkSmartPointer<vtkTypeInt64Array>::New();
  array->SetName(name);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}
}
#endif
