// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBoundaryMesher.h"

#include "GatheredExecution.h"
#include "Processes.h"
#include "ValidateInput.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Types.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>

//------------------------------------------------------------------------------
vtkBoundaryMesher::vtkBoundaryMesher()
{
  this->SetNumberOfOutputPorts(2);
}

//------------------------------------------------------------------------------
vtkBoundaryMesher::~vtkBoundaryMesher() = default;

//------------------------------------------------------------------------------
int vtkBoundaryMesher::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkBoundaryMesher::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkBoundaryMesher::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return tautline::processGathered(this, { this->TimeLimit, nullptr },
    tautline::GatheredResult::OnFirst, { true, 0 }, request, inputs, outputs,
    [&] { return this->Superclass::ProcessRequest(request, inputs, outputs); });
}

//------------------------------------------------------------------------------
int vtkBoundaryMesher::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPointSet* input = vtkPointSet::GetData(inputVector[0]);
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkPolyData* boundary = vtkPolyData::GetData(outputVector, 1);
  if (!input)
  {
    vtkWarningMacro(<< tautline::leftOut(vtkDataObject::GetData(inputVector[0]), "point set"));
    return 1;
  }
  try
  {
    tautline::requireFirstProcess(
      this, 0, input, this->IsA("vtkTetGenMesher") ? "TetGen Mesher" : "Triangle Mesher");
    tautline::validateInput(input, { true });
    if (input->GetNumberOfPoints() == 0)
    {
      tautline::warnOfEmptyInput(this, input, "points");
      return 1;
    }
    this->Generate(input, output, boundary);
  }
  catch (const std::exception& error)
  {
    output->Initialize();
    boundary->Initialize();
    vtkErrorMacro(<< tautline::errorText(error, "choose larger elements"));
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
std::vector<double> vtkBoundaryMesher::TakeSizes(vtkPointSet* input)
{
  vtkDataArray* sizes = this->GetInputArrayToProcess(0, input);
  if (!sizes || sizes->GetNumberOfComponents() != 1 ||
    sizes->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    throw tautline::Error("choose a point array with one component for the sizes");
  }
  std::vector<double> values;
  for (vtkIdType i = 0; i < sizes->GetNumberOfTuples(); ++i)
  {
    values.push_back(sizes->GetComponent(i, 0));
    if (!(values.back() > 0.0 && std::isfinite(values.back())))
    {
      throw tautline::Error("sizes must be positive and finite; the size at point " +
        std::to_string(i) + " is " + std::to_string(values.back()));
    }
  }
  return values;
}

//------------------------------------------------------------------------------
void vtkBoundaryMesher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseSizeArray: " << this->UseSizeArray << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
}
