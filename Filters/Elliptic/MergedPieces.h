// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MergedPieces.h
 * @brief Joins partitions of a mesh and returns results to them. Internal.
 */
#ifndef tautline_MergedPieces_h
#define tautline_MergedPieces_h

#include "tautline/Core/Types.h"

#include "vtkAppendFilter.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <functional>
#include <unordered_map>
#include <vector>

namespace tautline
{
/// A partition in the pipeline.
struct Piece
{
  vtkDataSet* input;
  vtkDataSet* selected;
  vtkDataSet* output;
};

/// Several pieces joined, with each global point once.
class Merged
{
public:
  Merged(const std::vector<Piece>& pieces, const std::vector<std::vector<Index>>& ids)
  {
    std::unordered_map<Index, Index> known;
    for (const auto& ofPiece : ids)
    {
      for (Index id : ofPiece)
      {
        const auto found = known.emplace(id, static_cast<Index>(this->GlobalIds.size()));
        if (found.second)
        {
          this->GlobalIds.push_back(id);
        }
        this->PointOf.push_back(found.first->second);
      }
    }
    std::vector<vtkDataSet*> inputs, marked;
    for (const Piece& piece : pieces)
    {
      inputs.push_back(piece.input);
      marked.push_back(piece.selected);
    }
    this->Input = this->merge(inputs);
    if (std::find(marked.begin(), marked.end(), nullptr) == marked.end())
    {
      this->Selected = this->merge(marked);
    }
  }

  vtkSmartPointer<vtkUnstructuredGrid> Input, Selected;
  std::vector<Index> GlobalIds;

  /// Copies new arrays of the result to the outputs of the pieces.
  void scatter(vtkDataSet* result, const std::vector<Piece>& pieces) const
  {
    vtkIdType firstPoint = 0, firstCell = 0;
    for (const Piece& piece : pieces)
    {
      const vtkIdType points = piece.input->GetNumberOfPoints();
      const vtkIdType cells = piece.input->GetNumberOfCells();
      copyNew(result->GetPointData(), this->Input->GetPointData(), piece.output->GetPointData(),
        points, [&](vtkIdType k) { return this->PointOf[firstPoint + k]; });
      copyNew(result->GetCellData(), this->Input->GetCellData(), piece.output->GetCellData(), cells,
        [&](vtkIdType k) { return firstCell + k; });
      firstPoint += points;
      firstCell += cells;
    }
  }

private:
  std::vector<Index> PointOf; ///< of the points of all pieces, one piece after the other

  vtkSmartPointer<vtkUnstructuredGrid> merge(const std::vector<vtkDataSet*>& pieces) const
  {
    vtkNew<vtkAppendFilter> append;
    for (vtkDataSet* piece : pieces)
    {
      append->AddInputData(piece);
    }
    append->Update();
    vtkUnstructuredGrid* all = append->GetOutput();
    auto merged = vtkSmartPointer<vtkUnstructuredGrid>::New();
    const auto count = static_cast<vtkIdType>(this->GlobalIds.size());
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(count);
    merged->GetPointData()->CopyAllOn();
    merged->GetPointData()->CopyAllocate(all->GetPointData(), count);
    for (vtkIdType k = all->GetNumberOfPoints() - 1; k >= 0; --k) // the first piece prevails
    {
      points->SetPoint(this->PointOf[k], all->GetPoint(k));
      merged->GetPointData()->CopyData(all->GetPointData(), k, this->PointOf[k]);
    }
    merged->SetPoints(points);
    merged->Allocate(all->GetNumberOfCells());
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < all->GetNumberOfCells(); ++cell)
    {
      all->GetCellPoints(cell, ids);
      for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
      {
        ids->SetId(k, this->PointOf[ids->GetId(k)]);
      }
      // Polyhedra, which no method here supports, would need their faces.
      const int type = all->GetCellType(cell);
      merged->InsertNextCell(type == VTK_POLYHEDRON ? VTK_CONVEX_POINT_SET : type, ids);
    }
    merged->GetCellData()->ShallowCopy(all->GetCellData());
    markGhosts(pieces, merged);
    return merged;
  }

  /// Joins the ghost flags of all pieces, some of which may have none.
  static void markGhosts(const std::vector<vtkDataSet*>& pieces, vtkDataSet* merged)
  {
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    bool any = false;
    for (vtkDataSet* piece : pieces)
    {
      vtkUnsignedCharArray* own = piece->GetCellGhostArray();
      any = any || own;
      for (vtkIdType cell = 0; cell < piece->GetNumberOfCells(); ++cell)
      {
        ghosts->InsertNextValue(own ? own->GetValue(cell) : 0);
      }
    }
    if (any)
    {
      merged->GetCellData()->AddArray(ghosts);
    }
  }

  static void copyNew(vtkDataSetAttributes* result, vtkDataSetAttributes* before,
    vtkDataSetAttributes* output, vtkIdType count, const std::function<vtkIdType(vtkIdType)>& from)
  {
    for (int i = 0; i < result->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = result->GetArray(i);
      if (!array || before->GetArray(array->GetName()) == array)
      {
        continue;
      }
      auto copy = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
      copy->SetName(array->GetName());
      copy->SetNumberOfComponents(array->GetNumberOfComponents());
      copy->CopyComponentNames(array);
      copy->SetNumberOfTuples(count);
      for (vtkIdType k = 0; k < count; ++k)
      {
        copy->SetTuple(k, from(k), array);
      }
      output->AddArray(copy);
    }
    vtkDataArray* active = result->GetScalars();
    output->SetActiveScalars(active ? active->GetName() : nullptr);
  }
};
}
#endif
