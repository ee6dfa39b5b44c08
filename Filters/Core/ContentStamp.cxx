// SPDX-License-Identifier: BSD-3-Clause
#include "ContentStamp.h"

#include "VtkCompatibility.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkFieldData.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

namespace tautline
{
namespace
{
void add(ContentStamp& stamp, vtkObject* object)
{
  stamp.push_back(object ? object->GetMTime() : 0);
}

/// The connectivity may change without a change of the cell array's own time.
void addCells(ContentStamp& stamp, vtkCellArray* cells)
{
  add(stamp, cells);
  add(stamp, cells ? cells->GetConnectivityArray() : nullptr);
  add(stamp, cells ? cells->GetOffsetsArray() : nullptr);
}

/// Arrays in order. The modification time of the field data itself changes with a copy.
void addArrays(ContentStamp& stamp, vtkFieldData* fields)
{
  const int count = fields ? fields->GetNumberOfArrays() : 0;
  stamp.push_back(static_cast<vtkMTimeType>(count));
  for (int i = 0; i < count; ++i)
  {
    add(stamp, fields->GetAbstractArray(i));
  }
}

/// Which arrays are the scalars, the vectors, ...
void addAttributes(ContentStamp& stamp, vtkDataSetAttributes* attributes)
{
  int indices[vtkDataSetAttributes::NUM_ATTRIBUTES];
  attributes->GetAttributeIndices(indices);
  for (const int index : indices)
  {
    stamp.push_back(static_cast<vtkMTimeType>(index + 1)); // -1: none
  }
}

void addDataSet(ContentStamp& stamp, vtkDataObject* data)
{
  auto* points = vtkPointSet::SafeDownCast(data);
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  auto* surface = vtkPolyData::SafeDownCast(data);
  if (!grid && !surface)
  {
    add(stamp, data);
    return;
  }
  add(stamp, points->GetPoints());
  add(stamp, points->GetPoints() ? points->GetPoints()->GetData() : nullptr);
  if (grid)
  {
    addCells(stamp, grid->GetCells());
    add(stamp, storedCellTypes(grid));
  }
  else
  {
    for (vtkCellArray* cells :
      { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
    {
      addCells(stamp, cells);
    }
  }
  addArrays(stamp, points->GetPointData());
  addArrays(stamp, points->GetCellData());
  addArrays(stamp, points->GetFieldData());
  addAttributes(stamp, points->GetPointData());
  addAttributes(stamp, points->GetCellData());
}

void addLeaves(ContentStamp& stamp, vtkCompositeDataSet* blocks)
{
  const auto at = vtk::TakeSmartPointer(blocks->NewIterator());
  at->SkipEmptyNodesOff();
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    // The position in the tree: moving a block changes the content.
    stamp.push_back(static_cast<vtkMTimeType>(at->GetCurrentFlatIndex()));
    addDataSet(stamp, at->GetCurrentDataObject());
  }
}
}

//------------------------------------------------------------------------------
ContentStamp contentStamp(const std::vector<vtkDataObject*>& inputs)
{
  ContentStamp stamp;
  for (vtkDataObject* data : inputs)
  {
    const std::size_t length = stamp.size();
    stamp.push_back(0); // later the number of entries of this input
    if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
    {
      addLeaves(stamp, blocks);
    }
    else if (data)
    {
      addDataSet(stamp, data);
    }
    stamp[length] = static_cast<vtkMTimeType>(stamp.size() - length);
  }
  return stamp;
}
}
