// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshFileReader.h"

#include "ExecutionScope.h"
#include "FileNames.h"
#include "FileRanges.h"
#include "MeshFileAdapter.h"
#include "MeshPart.h"
#include "PartExchange.h"
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
/// The piece that is asked for; the whole mesh where nothing is.
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

std::string noMemory(const std::string& file, const std::bad_alloc& error)
{
  return file + ": " +
    tautline::errorText(error, "read it where there is more, or a part of the mesh");
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
tautline::MeshShare vtkMeshFileReader::ReadShare(const tautline::FileRanges&)
{
  throw tautline::UnusualFile();
}

//------------------------------------------------------------------------------
bool vtkMeshFileReader::HasRanges(const std::string&) const
{
  return false;
}

//------------------------------------------------------------------------------
/// Without a file name a rank does not know, and takes part.
bool vtkMeshFileReader::MayHaveRanges() const
{
  return this->HasRanges(
    this->FileName ? tautline::splitExtension(this->FileName).second : std::string());
}

//------------------------------------------------------------------------------
bool vtkMeshFileReader::Agrees(
  tautline::RankGroup& group, const tautline::PartRequest& request) const
{
  const std::string asked = std::string(this->GetClassName()) + "\n" +
    (this->FileName ? this->FileName : "") + "\n" + std::to_string(this->LowerCells) +
    std::to_string(request.ghostLayers);
  const std::vector<tautline::Bytes> all =
    group.allGather(tautline::Bytes(asked.begin(), asked.end()));
  const bool same = std::all_of(
    all.begin(), all.end(), [&](const tautline::Bytes& other) { return other == all[0]; });
  const bool named = this->FileName && this->FileName[0];
  return !group.any(!same || !named || request.part != group.rank());
}

//------------------------------------------------------------------------------
tautline::MeshFile vtkMeshFileReader::ReadPartOfWhole(const tautline::PartRequest& request)
{
  constexpr double readingShare = 0.8;
  if (!this->FileName || !this->FileName[0])
  {
    throw tautline::Error("no file name");
  }
  try
  {
    tautline::MeshFile mesh = [&]
    {
      const tautline::ProgressStep progress(this, 0.0, readingShare);
      return this->ReadMesh();
    }();
    return request.parts > 1 ? tautline::partOf(mesh, request) : mesh;
  }
  catch (const std::bad_alloc& error)
  {
    throw tautline::Error(noMemory(this->FileName, error));
  }
}

//------------------------------------------------------------------------------
tautline::MeshFile vtkMeshFileReader::ReadPart(const tautline::PartRequest& request)
{
  const std::unique_ptr<tautline::RankGroup> group =
    request.parts > 1 && this->MayHaveRanges() ? tautline::tryProcessGroup() : nullptr;
  if (!group || group->size() != request.parts || !this->Agrees(*group, request))
  {
    return this->ReadPartOfWhole(request);
  }
  try
  {
    constexpr double readingShare = 0.6;
    const tautline::FileRanges ranges(*group);
    tautline::MeshShare share = [&]
    {
      const tautline::ProgressStep progress(this, 0.0, readingShare);
      return this->ReadShare(ranges);
    }();
    tautline::MeshFile part =
      tautline::exchangeParts(ranges, std::move(share), request.ghostLayers);
    this->ReadByRanges = true;
    return part;
  }
  catch (const tautline::UnusualFile&)
  {
    tautline::MeshFile part;
    group->together([&] { part = this->ReadPartOfWhole(request); });
    return part;
  }
}

//------------------------------------------------------------------------------
int vtkMeshFileReader::RequestData(vtkInformationVector* outputs)
{
  this->ErrorText.clear();
  this->ReadByRanges = false;
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkDataObject* output = vtkDataObject::GetData(outputs);
  output->Initialize();
  try
  {
    tautline::MeshFile mesh = this->ReadPart(requestedPart(outputs->GetInformationObject(0)));
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
  catch (const tautline::Error& error)
  {
    this->ErrorText = error.what();
  }
  catch (const std::bad_alloc& error)
  {
    this->ErrorText = noMemory(this->FileName, error);
  }
  if (!this->ErrorText.empty())
  {
    output->Initialize();
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
  os << indent << "ReadByRanges: " << this->ReadByRanges << "\n";
}
