// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshFileReader.h"

#include "ExecutionScope.h"
#include "MeshFileAdapter.h"
#include "MeshPart.h"
#include "ProcessGroup.h"
#include "ProgressStep.h"
#include "tautline/Core/Memory.h"

#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <memory>
#include <new>

namespace
{
/// The requested piece; the whole mesh if nothing is requested.
tautline::PartRequest requestedPart(vtkInformation* info)
{
  using Executive = vtkStreamingDemandDrivenPipeline;
  tautline::PartRequest request;
  if (info->Has(Executive::UPDATE_PIECE_NUMBER()) &&
    info->Has(Executive::UPDATE_NUMBER_OF_PIECES()))
  {
    request.part = std::max(info->Get(Executive::UPDATE_PIECE_NUMBER()), 0);
    request.parts = std::max(info->Get(Executive::UPDATE_NUMBER_OF_PIECES()), 1);
    request.ghostLayers = std::max(info->Get(Executive::UPDATE_NUMBER_OF_GHOST_LEVELS()), 0);
  }
  return request;
}
}

//------------------------------------------------------------------------------
vtkMeshFileReader::vtkMeshFileReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(1);
}

//------------------------------------------------------------------------------
vtkMeshFileReader::~vtkMeshFileReader()
{
  this->SetFileName(nullptr);
}

//------------------------------------------------------------------------------
int vtkMeshFileReader::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkUnstructuredGrid");
  return 1;
}

//------------------------------------------------------------------------------
vtkPointSet* vtkMeshFileReader::GetOutput()
{
  return vtkPointSet::SafeDownCast(this->GetOutputDataObject(0));
}

//------------------------------------------------------------------------------
vtkTypeBool vtkMeshFileReader::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return tautline::processInScope(this, {}, request, outputs,
    [&]
    {
      if (request->Has(vtkDemandDrivenPipeline::REQUEST_INFORMATION()))
      {
        outputs->GetInformationObject(0)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
        return 1;
      }
      return request->Has(vtkDemandDrivenPipeline::REQUEST_DATA())
        ? this->RequestData(outputs)
        : this->Superclass::ProcessRequest(request, inputs, outputs);
    });
}

//------------------------------------------------------------------------------
tautline::MeshFile vtkMeshFileReader::ReadMesh()
{
  return {};
}

//------------------------------------------------------------------------------
void vtkMeshFileReader::ReadPart(const tautline::PartRequest& request, vtkDataObject* output)
{
  constexpr double readingShare = 0.8;
  tautline::MeshFile mesh = [&]
  {
    const tautline::ProgressStep progress(this, 0.0, readingShare);
    return this->ReadMesh();
  }();
  if (request.parts > 1)
  {
    mesh = tautline::partOf(mesh, request);
  }
  for (const std::string& warning : mesh.warnings)
  {
    vtkWarningMacro(<< this->FileName << ": " << warning);
  }
  if (auto* surface = vtkPolyData::SafeDownCast(output))
  {
    tautline::toSurface(std::move(mesh), surface);
  }
  else
  {
    tautline::toGrid(std::move(mesh), vtkUnstructuredGrid::SafeDownCast(output));
  }
}

//------------------------------------------------------------------------------
void vtkMeshFileReader::ReadFile(const tautline::PartRequest& request, vtkDataObject* output)
{
  if (!this->FileName || !this->FileName[0])
  {
    throw tautline::Error("no file name");
  }
  try
  {
    this->ReadPart(request, output);
  }
  catch (const std::bad_alloc& error)
  {
    throw tautline::Error(std::string(this->FileName) + ": " +
      tautline::errorText(
        error, "read it on a machine with more memory, or read a part of the mesh"));
  }
}

//------------------------------------------------------------------------------
int vtkMeshFileReader::RequestData(vtkInformationVector* outputs)
{
  this->ErrorText.clear();
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkDataObject* output = vtkDataObject::GetData(outputs);
  output->Initialize();
  const tautline::PartRequest request = requestedPart(outputs->GetInformationObject(0));
  try
  {
    const std::unique_ptr<tautline::RankGroup> ranks =
      request.parts > 1 ? tautline::tryProcessGroup() : nullptr;
    tautline::SingleRank alone;
    tautline::RankGroup& group = ranks && ranks->size() == request.parts ? *ranks : alone;
    group.together([&] { this->ReadFile(request, output); });
  }
  catch (const tautline::Error& error)
  {
    output->Initialize();
    this->ErrorText = error.what();
    this->SetErrorCode(vtkErrorCode::FileFormatError);
    vtkErrorMacro(<< this->ErrorText);
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkMeshFileReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "LowerCells: " << this->LowerCells << "\n";
}
