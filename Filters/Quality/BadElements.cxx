// SPDX-License-Identifier: BSD-3-Clause
#include "BadElements.h"

#include "tautline/Quality/Criteria.h"

#include "vtkAppendFilter.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"

#include <unordered_map>
#include <utility>

namespace tautline
{
namespace
{

std::vector<vtkIdType> badCells(vtkDataSet* output, const signed char* validity,
  const unsigned char* skip, const std::vector<Metric>& metrics)
{
  vtkCellData* data = output->GetCellData();
  vtkDataArray* grades = data->GetArray("Grade");
  std::vector<std::pair<vtkDataArray*, Range>> limits;
  for (const Metric metric : metrics)
  {
    const MetricInfo& info = metricInfo(metric);
    if (vtkDataArray* values = grades ? nullptr : data->GetArray(info.name))
    {
      limits.emplace_back(values, info.acceptable(3));
    }
  }
  const auto isBad = [&](vtkIdType cell)
  {
    if (validity[cell] != Valid)
    {
      return isInvalid(validity[cell]);
    }
    if (grades)
    {
      return grades->GetComponent(cell, 0) == static_cast<double>(Grade::Failed);
    }
    for (const auto& limit : limits)
    {
      const double value = limit.first->GetComponent(cell, 0);
      if (value < limit.second.low || value > limit.second.high)
      {
        return true;
      }
    }
    return false;
  };
  std::vector<vtkIdType> cells;
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    if (!(skip && skip[cell]) && isBad(cell))
    {
      cells.push_back(cell);
    }
  }
  return cells;
}

vtkSmartPointer<vtkUnstructuredGrid> extract(vtkDataSet* input, const std::vector<vtkIdType>& cells)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  grid->GetPointData()->CopyAllOn();
  grid->GetPointData()->CopyAllocate(input->GetPointData());
  grid->GetCellData()->CopyAllOn();
  grid->GetCellData()->CopyAllocate(input->GetCellData(), static_cast<vtkIdType>(cells.size()));
  grid->Allocate(static_cast<vtkIdType>(cells.size()));
  std::unordered_map<vtkIdType, vtkIdType> newIds;
  vtkNew<vtkIdList> ids;
  for (const vtkIdType cell : cells)
  {
    const auto renumber = [&](vtkIdType i)
    {
      const vtkIdType old = ids->GetId(i);
      const auto entry = newIds.emplace(old, points->GetNumberOfPoints());
      if (entry.second)
      {
        points->InsertNextPoint(input->GetPoint(old));
        grid->GetPointData()->CopyData(input->GetPointData(), old, entry.first->second);
      }
      ids->SetId(i, entry.first->second);
    };
    const int type = input->GetCellType(cell);
    if (type == VTK_POLYHEDRON)
    {
      // The number of faces, and for each face its size and points.
      vtkUnstructuredGrid::SafeDownCast(input)->GetFaceStream(cell, ids);
      for (vtkIdType i = 1; i < ids->GetNumberOfIds(); i += ids->GetId(i) + 1)
      {
        for (vtkIdType k = 1; k <= ids->GetId(i); ++k)
        {
          renumber(i + k);
        }
      }
    }
    else
    {
      input->GetCellPoints(cell, ids);
      for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
      {
        renumber(i);
      }
    }
    const vtkIdType made = grid->InsertNextCell(type, ids);
    grid->GetCellData()->CopyData(input->GetCellData(), cell, made);
  }
  grid->SetPoints(points);
  if (vtkDataArray* colored = input->GetCellData()->GetScalars())
  {
    grid->GetCellData()->SetActiveScalars(colored->GetName());
  }
  return grid;
}

} // anonymous namespace

//------------------------------------------------------------------------------
void BadElements::add(vtkDataSet* output, const signed char* validity, const unsigned char* skip,
  const std::vector<Metric>& metrics)
{
  const std::vector<vtkIdType> cells = badCells(output, validity, skip, metrics);
  if (!cells.empty())
  {
    this->Blocks.push_back(extract(output, cells));
  }
}

//------------------------------------------------------------------------------
void BadElements::copyTo(vtkUnstructuredGrid* grid) const
{
  if (this->Blocks.size() == 1)
  {
    grid->ShallowCopy(this->Blocks.front());
  }
  else if (!this->Blocks.empty())
  {
    vtkNew<vtkAppendFilter> append;
    for (const auto& block : this->Blocks)
    {
      append->AddInputData(block);
    }
    append->Update();
    grid->ShallowCopy(append->GetOutput());
  }
}

} // namespace tautline
