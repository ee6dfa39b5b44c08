// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedGrid.h"

#include "MeshAdapter.h"
#include "MeshOutput.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Curving/CurveMesh.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSignedCharArray.h"
#include "vtkUniformGridAMR.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace tautline
{
namespace
{
vtkSmartPointer<vtkUnstructuredGrid> gridOf(vtkDataSet* data)
{
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    return grid;
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(data->GetNumberOfPoints());
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    pollInterruption(p);
    double x[3];
    data->GetPoint(p, x);
    points->SetPoint(p, x);
  }
  grid->SetPoints(points);
  vtkNew<vtkIdList> nodes;
  grid->Allocate(data->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    data->GetCellPoints(cell, nodes);
    grid->InsertNextCell(data->GetCellType(cell), nodes);
  }
  grid->GetPointData()->ShallowCopy(data->GetPointData());
  grid->GetCellData()->ShallowCopy(data->GetCellData());
  grid->GetFieldData()->ShallowCopy(data->GetFieldData());
  return grid;
}

/// Copies the data of points that stay, and interpolates the data of the nodes.
void writePointData(const CurvingResult& curved, vtkPointData* from, vtkPointData* to)
{
  const auto kept = static_cast<vtkIdType>(curved.kept.size());
  const auto nodes = static_cast<vtkIdType>(curved.starts.size()) - 1;
  to->InterpolateAllocate(from, kept + nodes);
  for (vtkIdType p = 0; p < kept; ++p)
  {
    pollInterruption(p);
    to->CopyData(from, curved.kept[p], p);
  }
  vtkNew<vtkIdList> sources;
  for (vtkIdType n = 0; n < nodes; ++n)
  {
    pollInterruption(n);
    const Index begin = curved.starts[n], end = curved.starts[n + 1];
    sources->SetNumberOfIds(end - begin);
    std::copy(&curved.sources[begin], &curved.sources[begin] + (end - begin), sources->begin());
    to->InterpolatePoint(
      from, kept + n, sources, const_cast<double*>(curved.weights.data() + begin));
  }
  to->RemoveArray(vtkDataSetAttributes::GhostArrayName());
}

/// Points that have not moved get exactly their original coordinates.
std::vector<double> pointsOf(const CurvingResult& curved, const MeshAdapter& adapter)
{
  std::vector<double> points = curved.points;
  adapter.frame().leave(points);
  const double* framed = adapter.mesh().view().points;
  const double* given = adapter.inputView().points;
  for (std::size_t p = 0; p < curved.kept.size(); ++p)
  {
    const Index id = curved.kept[p];
    if (std::equal(framed + 3 * id, framed + 3 * id + 3, &curved.points[3 * p]))
    {
      std::copy_n(given + 3 * id, 3, &points[3 * p]);
    }
  }
  return points;
}
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> asGrids(vtkDataObject* data)
{
  if (auto* single = vtkDataSet::SafeDownCast(data))
  {
    return gridOf(single);
  }
  auto* blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (!blocks)
  {
    return data;
  }
  if (vtkUniformGridAMR::SafeDownCast(data))
  {
    throw Error("An adaptive grid (AMR) cannot hold curved cells: run Merge Blocks first.");
  }
  auto grids = vtkSmartPointer<vtkCompositeDataSet>::Take(blocks->NewInstance());
  grids->CopyStructure(blocks);
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    auto* block = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject());
    if (block)
    {
      grids->SetDataSet(walk, gridOf(block));
    }
  }
  return grids;
}

//------------------------------------------------------------------------------
void writeCurved(const CurvingResult& curved, const MeshAdapter& adapter, vtkDataSet* input,
  vtkUnstructuredGrid* output)
{
  output->Initialize();
  output->SetPoints(makePoints(pointsOf(curved, adapter), 3));
  vtkNew<vtkTypeInt64Array> offsets, connectivity;
  offsets->SetNumberOfTuples(static_cast<vtkIdType>(curved.offsets.size()));
  std::copy(curved.offsets.begin(), curved.offsets.end(), offsets->GetPointer(0));
  connectivity->SetNumberOfTuples(static_cast<vtkIdType>(curved.connectivity.size()));
  std::copy(curved.connectivity.begin(), curved.connectivity.end(), connectivity->GetPointer(0));
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  vtkNew<vtkUnsignedCharArray> types;
  types->SetNumberOfTuples(static_cast<vtkIdType>(curved.types.size()));
  std::copy(curved.types.begin(), curved.types.end(), types->GetPointer(0));
  output->SetCells(types, cells);
  writePointData(curved, input->GetPointData(), output->GetPointData());
  // The orders of the input's cells do not apply to the output.
  vtkCellData* cellData = output->GetCellData();
  cellData->ShallowCopy(input->GetCellData());
  if (vtkDataArray* degrees = cellData->GetHigherOrderDegrees())
  {
    cellData->RemoveArray(degrees->GetName());
  }
  vtkNew<vtkSignedCharArray> validity;
  validity->SetName("Validity");
  validity->SetNumberOfTuples(static_cast<vtkIdType>(curved.validity.size()));
  std::copy(curved.validity.begin(), curved.validity.end(), validity->GetPointer(0));
  cellData->AddArray(validity);
  output->GetFieldData()->ShallowCopy(input->GetFieldData());
}
}
