// SPDX-License-Identifier: BSD-3-Clause
#include "vtkInteractionLayer.h"

#include "GatheredExecution.h"
#include "HorizonInput.h"
#include "ProgressStep.h"
#include "ValidateInput.h"

#include "tautline/Core/Memory.h"
#include "tautline/Peridynamics/InteractionLayer.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <functional>

vtkStandardNewMacro(vtkInteractionLayer);

namespace
{
/// The name of the cell array of interaction layer and domain, and its values.
constexpr const char* ReferenceArray = "Reference";
constexpr int DomainValue = 1, LayerValue = 2;

/// Adds copies of arrays with `count` rows: row i is row `from(i)` of the input, or zero if that is
/// negative.
void passData(vtkDataSetAttributes* input, vtkDataSetAttributes* output, vtkIdType count,
  const std::function<vtkIdType(vtkIdType)>& from)
{
  for (int a = 0; a < input->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = input->GetArray(a);
    if (!array)
    {
      continue;
    }
    auto copy = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    copy->SetName(array->GetName());
    copy->SetNumberOfComponents(array->GetNumberOfComponents());
    copy->SetNumberOfTuples(count);
    copy->Fill(0.0);
    for (vtkIdType i = 0; i < count; ++i)
    {
      if (from(i) >= 0)
      {
        copy->SetTuple(i, from(i), array);
      }
    }
    output->AddArray(copy);
  }
}
}

//------------------------------------------------------------------------------
vtkInteractionLayer::vtkInteractionLayer() = default;

//------------------------------------------------------------------------------
vtkInteractionLayer::~vtkInteractionLayer() = default;

//------------------------------------------------------------------------------
int vtkInteractionLayer::FillInputPortInformation(int, vtkInformation* info)
{
  // The composite type comes first: its data sets form one mesh.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkInteractionLayer::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return tautline::processGathered(this, { this->TimeLimit, nullptr },
    tautline::GatheredResult::NewMesh, { true, this->Threads }, request, inputs, outputs,
    [&] { return this->Superclass::ProcessRequest(request, inputs, outputs); });
}

//------------------------------------------------------------------------------
int vtkInteractionLayer::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector);
  try
  {
    tautline::InteractionLayerOptions options;
    options.width = this->Width;
    options.elementSize = this->ElementSize;
    options.threads = this->Threads;
    options.progress = [this](double done)
    {
      tautline::advance(this, done);
      return !this->GetAbortExecute();
    };
    const tautline::ProgressStep progress(this, 0.0, 0.9);
    tautline::validateInput(vtkDataObject::GetData(inputVector[0]), { true, this->Threads });
    const vtkSmartPointer<vtkDataSet> input =
      tautline::wholeMesh(vtkDataObject::GetData(inputVector[0]));
    if (input->GetNumberOfCells() == 0)
    {
      tautline::warnOfEmptyInput(this, vtkDataObject::GetData(inputVector[0]), "cells");
      return 1;
    }
    const tautline::HorizonInput taken(
      input, nullptr, 0.0, this->MergeCoincidentPoints, this->Threads);
    const tautline::HorizonMesh made = tautline::addInteractionLayer(taken.mesh(), options);

    vtkNew<vtkPoints> points;
    points->SetDataType(VTK_DOUBLE);
    points->SetNumberOfPoints(static_cast<vtkIdType>(made.numberOfPoints()));
    for (tautline::Index i = 0; i < made.numberOfPoints(); ++i)
    {
      const auto id = static_cast<vtkIdType>(i);
      tautline::Vec3 p = taken.lift(made.points[2 * i], made.points[2 * i + 1]);
      if (id < input->GetNumberOfPoints())
      {
        input->GetPoint(id, p.data());
      }
      points->SetPoint(id, p.data());
    }
    output->SetPoints(points);
    vtkNew<vtkIntArray> reference;
    reference->SetName(ReferenceArray);
    output->Allocate(static_cast<vtkIdType>(made.numberOfTriangles()));
    for (tautline::Index t = 0; t < made.numberOfTriangles(); ++t)
    {
      const vtkIdType ids[3] = { static_cast<vtkIdType>(made.triangles[3 * t]),
        static_cast<vtkIdType>(made.triangles[3 * t + 1]),
        static_cast<vtkIdType>(made.triangles[3 * t + 2]) };
      output->InsertNextCell(VTK_TRIANGLE, 3, ids);
      reference->InsertNextValue(made.layer[t] ? LayerValue : DomainValue);
    }
    const vtkIdType oldPoints = input->GetNumberOfPoints();
    const auto oldTriangles = static_cast<vtkIdType>(taken.mesh().numberOfTriangles());
    passData(input->GetPointData(), output->GetPointData(), points->GetNumberOfPoints(),
      [&](vtkIdType i) { return i < oldPoints ? i : -1; });
    passData(input->GetCellData(), output->GetCellData(), reference->GetNumberOfTuples(),
      [&](vtkIdType i) { return i < oldTriangles ? taken.cell(i) : -1; });
    for (vtkDataSetAttributes* data :
      std::initializer_list<vtkDataSetAttributes*>{ output->GetPointData(), output->GetCellData() })
    {
      data->RemoveArray(vtkDataSetAttributes::GhostArrayName()); // there are no ghosts anymore
    }
    output->GetCellData()->AddArray(reference);
    output->GetCellData()->SetActiveScalars(ReferenceArray);
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< tautline::errorText(error, "choose larger elements or a narrower layer"));
    output->Initialize();
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkInteractionLayer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Width: " << this->Width << "\n";
  os << indent << "ElementSize: " << this->ElementSize << "\n";
  os << indent << "Threads: " << this->Threads << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
}
