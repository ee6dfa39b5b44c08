// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshFileAdapter.h
 * @brief Converts a MeshFile to a VTK data set, and a VTK data set to a MeshFile.
 */
#ifndef tautline_MeshFileAdapter_h
#define tautline_MeshFileAdapter_h

#include "MeshFile.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <new>
#include <utility>
#include <vector>

class vtkDataSet;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace tautline
{
/// Fills an empty grid: points in double precision, 64-bit cells, all arrays. The large vectors are
/// moved into the grid without a copy.
TAUTLINEREADERS_EXPORT void toGrid(MeshFile mesh, vtkUnstructuredGrid* grid);

/// Fills an empty surface; cells are in the order required by VTK: vertices, lines, polygons.
TAUTLINEREADERS_EXPORT void toSurface(MeshFile mesh, vtkPolyData* surface);

/**
 * @brief Copies a data set. Pixels and voxels become quadrilaterals and hexahedra; ghost cells and
 * arrays that are not numeric are left out.
 *
 * Throws Error, with types and counts, for cells that the file formats do not support (strips,
 * polyhedra, ...).
 */
TAUTLINEREADERS_EXPORT MeshFile fromDataSet(vtkDataSet* input);

/// A VTK array that takes over the memory of a vector.
template <class ArrayT, class Value>
vtkSmartPointer<ArrayT> takeValues(std::vector<Value> values, int components)
{
  static_assert(sizeof(Value) == sizeof(typename ArrayT::ValueType));
  using Vector = std::vector<Value>;
  auto array = vtkSmartPointer<ArrayT>::New();
  array->SetNumberOfComponents(components);
  const auto size = static_cast<vtkIdType>(values.size());
  if (size > 0)
  {
    // a vector whose destructor never runs: VTK frees the memory
    alignas(Vector) unsigned char kept[sizeof(Vector)];
    Value* memory = (new (kept) Vector(std::move(values)))->data();
    array->SetArray(reinterpret_cast<typename ArrayT::ValueType*>(memory), size, 0,
      ArrayT::VTK_DATA_ARRAY_USER_DEFINED);
    array->SetArrayFreeFunction([](void* p) { ::operator delete(p); });
  }
  return array;
}
}
#endif
