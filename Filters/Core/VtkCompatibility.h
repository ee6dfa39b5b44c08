// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VtkCompatibility.h
 * @brief Handles the differences between VTK 9.1 and 9.6. Not a public header.
 */
#ifndef tautline_VtkCompatibility_h
#define tautline_VtkCompatibility_h

#include "vtkAOSDataArrayTemplate.h"
#include "vtkCellArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkSmartPointer.h"
#include "vtkStructuredData.h"
#include "vtkTypeInt64Array.h"
#include "vtkUniformGridAMR.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersionMacros.h"

#include <algorithm>
#include <vector>

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
#include "vtkCellTypeUtilities.h"
#else
#include "vtkCellTypes.h"
#endif

namespace tautline
{
/// The name of the VTK class for a cell type; "UnknownClass" for unknown numbers.
inline const char* cellClassName(int type)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return vtkCellTypeUtilities::GetClassNameFromTypeId(type);
#else
  return vtkCellTypes::GetClassNameFromTypeId(type);
#endif
}

/// The points of a cell; `list` may hold them. VTK 9.1 always copies them.
inline void cellPoints(
  vtkDataSet* mesh, vtkIdType cell, vtkIdType& count, const vtkIdType*& points, vtkIdList* list)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
  mesh->GetCellPoints(cell, count, points, list);
#else
  mesh->GetCellPoints(cell, list);
  count = list->GetNumberOfIds();
  points = list->GetPointer(0);
#endif
}

/// The stored types of the cells. VTK 9.6 may compute them.
inline vtkDataArray* storedCellTypes(vtkUnstructuredGrid* grid)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return grid->GetCellTypes();
#else
  return grid->GetCellTypesArray();
#endif
}

/// The types of the cells, one byte each; a copy if VTK 9.6 computes them, for example for cells of
/// one type. Null if there are none.
inline vtkSmartPointer<vtkUnsignedCharArray> cellTypesOf(vtkUnstructuredGrid* grid)
{
  vtkDataArray* stored = storedCellTypes(grid);
  vtkSmartPointer<vtkUnsignedCharArray> types = vtkUnsignedCharArray::SafeDownCast(stored);
  if (stored && !types)
  {
    types = vtkSmartPointer<vtkUnsignedCharArray>::New();
    types->DeepCopy(stored);
  }
  return types;
}

/// Removes lists of the faces of polyhedra from a mesh that has no polyhedra. The .pvtu readers of
/// VTK before 9.4 leave such lists at random, because they look for polyhedra before the cell types
/// are known. The lists are shorter than the number of cells, and VTK's extraction of cells reads
/// beyond their ends.
inline void removeStrayFaces(vtkUnstructuredGrid* grid)
{
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 4, 0)
  if (!grid->GetFaces() && !grid->GetFaceLocations())
  {
    return;
  }
  const vtkSmartPointer<vtkUnsignedCharArray> types = cellTypesOf(grid);
  const unsigned char* begin = types ? types->GetPointer(0) : nullptr;
  const unsigned char* end = types ? begin + types->GetNumberOfValues() : nullptr;
  if (std::find(begin, end, VTK_POLYHEDRON) == end)
  {
    grid->SetCells(types, grid->GetCells(), nullptr, nullptr);
  }
#else
  static_cast<void>(grid);
#endif
}

/// Sets the cells of a mesh with polyhedra. `starts` has the position of each polyhedron in
/// `streams`, -1 for other cells. A stream has the number of faces, and for each face the number of
/// points and the points, as in VTK before 9.4.
inline void setPolyhedralCells(vtkUnstructuredGrid* grid, vtkUnsignedCharArray* types,
  vtkCellArray* cells, vtkIdTypeArray* starts, vtkIdTypeArray* streams)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 4, 0)
  auto faces = vtkSmartPointer<vtkCellArray>::New();
  auto facesOfCells = vtkSmartPointer<vtkCellArray>::New();
  for (vtkIdType cell = 0; cell < starts->GetNumberOfValues(); ++cell)
  {
    vtkIdType at = starts->GetValue(cell);
    const vtkIdType count = at < 0 ? 0 : streams->GetValue(at++);
    facesOfCells->InsertNextCell(static_cast<int>(count));
    for (vtkIdType i = 0; i < count; ++i)
    {
      const vtkIdType points = streams->GetValue(at++);
      facesOfCells->InsertCellPoint(faces->InsertNextCell(points, streams->GetPointer(at)));
      at += points;
    }
  }
  grid->SetPolyhedralCells(types, cells, facesOfCells, faces);
#else
  grid->SetCells(types, cells, starts, streams);
#endif
}

/// The offsets of cells stored in 64 bits; null if they are not a plain array.
inline vtkAOSDataArrayTemplate<vtkTypeInt64>* offsets64(vtkCellArray* cells)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return cells->GetOffsetsAOSArray64();
#else
  return cells->GetOffsetsArray64();
#endif
}

/// The points of cells stored in 64 bits; null if they are not a plain array.
inline vtkAOSDataArrayTemplate<vtkTypeInt64>* connectivity64(vtkCellArray* cells)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return cells->GetConnectivityAOSArray64();
#else
  return cells->GetConnectivityArray64();
#endif
}

/// The start of offsets64(); null if VTK 9.6 computes the offsets.
inline const vtkTypeInt64* plainOffsets(vtkCellArray* cells)
{
  auto* array = offsets64(cells);
  return array ? array->GetPointer(0) : nullptr;
}

/// The start of connectivity64(); null if the points are not a plain array.
inline const vtkTypeInt64* plainConnectivity(vtkCellArray* cells)
{
  auto* array = connectivity64(cells);
  return array ? array->GetPointer(0) : nullptr;
}

/// Sets the levels of a three-dimensional AMR data set, with the given number of blocks each.
inline void initializeLevels(vtkUniformGridAMR* amr, const std::vector<unsigned int>& blocks)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  amr->Initialize(blocks);
  amr->SetGridDescription(vtkStructuredData::VTK_STRUCTURED_XYZ_GRID);
#else
  const std::vector<int> counts(blocks.begin(), blocks.end());
  amr->Initialize(static_cast<int>(counts.size()), counts.data());
  amr->SetGridDescription(VTK_XYZ_GRID);
#endif
}
} // namespace tautline

#endif
