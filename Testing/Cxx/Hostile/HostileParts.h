// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HostileParts.h
 * @brief What the sources of the hostile data share.
 */

#ifndef tautline_HostileParts_h
#define tautline_HostileParts_h

#include "HostileData.h"

#include "vtkVariant.h"

namespace tautline
{

/** An array of 0 and 1. */
template <class ArrayT>
vtkSmartPointer<ArrayT> makeArray(const char* name, vtkIdType tuples, int components = 1)
{
  auto array = vtkSmartPointer<ArrayT>::New();
  TAUTLINE_SET(array, SetName(name), SetNumberOfComponents(components), SetNumberOfTuples(tuples));
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    array->SetVariantValue(i, vtkVariant(static_cast<int>(i % 2)));
  }
  return array;
}

vtkSmartPointer<vtkDataObject> makeTable();

vtkSmartPointer<vtkDataObject> makeBlocks(
  const std::vector<vtkSmartPointer<vtkDataObject>>& leaves);

/** With the cells a second time, or, shifted, all of it; null if it is no unstructured grid. */
vtkSmartPointer<vtkDataObject> doubledMesh(vtkDataObject* data, double shift, bool newPoints);

/** Adds data that do not depend on what suits the filter: meshes of all kinds, other types. */
void addHostileMeshes(std::vector<HostileData>& list);

} // namespace tautline

#endif
