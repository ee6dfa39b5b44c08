// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFoamMeshReader.h"

#include "FileNames.h"
#include "FoamCase.h"
#include "FoamFileAdapter.h"
#include "MeshPart.h"
#include "ProgressStep.h"
#include "vtkTautlineSetRange.h"

#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkFoamMeshReader);

//------------------------------------------------------------------------------
vtkFoamMeshReader::vtkFoamMeshReader()
{
  this->LowerCells = true;
}

//------------------------------------------------------------------------------
vtkFoamMeshReader::~vtkFoamMeshReader()
{
  this->SetRegionName(nullptr);
}

//------------------------------------------------------------------------------
void vtkFoamMeshReader::SetCaseType(int type)
{
  const std::string error =
    tautline::rangeError<int>("CaseType", type, AUTOMATIC, DECOMPOSED, this->CaseType);
  if (!error.empty())
  {
    vtkErrorMacro(<< error);
  }
  else if (this->CaseType != type)
  {
    this->CaseType = type;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkFoamMeshReader::CanReadFile(const char* name)
{
  const std::string ending = tautline::splitExtension(name).second;
  tautline::FoamRequest request;
  request.name = name;
  const std::string& file = request.name;
  const std::string settings = "controlDict";
  const bool named = ending == "foam" || ending == "openfoam" ||
    (file.size() >= settings.size() &&
      file.compare(file.size() - settings.size(), settings.size(), settings) == 0);
  try
  {
    return named && !tautline::locateFoamCase(request).folders.empty();
  }
  catch (const tautline::Error&)
  {
    return 0;
  }
}

//------------------------------------------------------------------------------
void vtkFoamMeshReader::ReadPart(const tautline::PartRequest& request, vtkDataObject* output)
{
  constexpr double readingShare = 0.9;
  this->PatchList.clear();
  tautline::FoamRequest wanted;
  wanted.name = this->FileName;
  wanted.region = this->RegionName ? this->RegionName : "";
  wanted.type = static_cast<tautline::FoamCaseType>(this->CaseType);
  wanted.piece = request.part;
  wanted.pieces = request.parts;
  tautline::FoamPiece piece = [&]
  {
    const tautline::ProgressStep progress(this, 0.0, readingShare);
    return tautline::readFoamCase(wanted);
  }();
  for (const std::string& warning : piece.warnings)
  {
    vtkWarningMacro(<< this->FileName << ": " << warning);
  }
  this->PatchList = tautline::patchList(piece.mesh);
  tautline::toGrid(std::move(piece), this->LowerCells, vtkUnstructuredGrid::SafeDownCast(output));
}

//------------------------------------------------------------------------------
void vtkFoamMeshReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CaseType: " << this->CaseType << "\n";
  os << indent << "RegionName: " << (this->RegionName ? this->RegionName : "(none)") << "\n";
}
