// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFluentMeshReader.h"

#include "FileNames.h"
#include "FluentFile.h"
#include "FoamFileAdapter.h"
#include "FoamProcessors.h"
#include "MeshPart.h"
#include "ProgressStep.h"
#include "TextCursor.h"

#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkFluentMeshReader);

//------------------------------------------------------------------------------
vtkFluentMeshReader::vtkFluentMeshReader()
{
  this->LowerCells = true;
}

//------------------------------------------------------------------------------
int vtkFluentMeshReader::CanReadFile(const char* name)
{
  const std::string extension = tautline::splitExtension(name).second;
  return (extension == "cas" || extension == "msh") && tautline::isFluentFile(name);
}

//------------------------------------------------------------------------------
void vtkFluentMeshReader::ReadPart(const tautline::PartRequest& request, vtkDataObject* output)
{
  constexpr double readingShare = 0.8;
  this->PatchList.clear();
  tautline::FluentMesh read = [&]
  {
    const tautline::ProgressStep progress(this, 0.0, readingShare);
    return tautline::readFluent(this->FileName);
  }();
  for (const std::string& warning : read.warnings)
  {
    vtkWarningMacro(<< this->FileName << ": " << warning);
  }
  const auto [base, extension] = tautline::splitExtension(this->FileName);
  if (extension == "cas" && tautline::openFile(base + ".dat"))
  {
    vtkWarningMacro(<< this->FileName << ": the mesh is read without the results in " << base
                    << ".dat; use VTK's FLUENTReader for these");
  }
  tautline::FoamPiece piece;
  if (request.parts > 1)
  {
    piece = tautline::divideMesh(read.mesh, request.part, request.parts);
  }
  else
  {
    piece.mesh = std::move(read.mesh);
  }
  try
  {
    piece.cells = tautline::fluentCells(piece.mesh, read.dimension);
  }
  catch (const tautline::FoamDefect& defect)
  {
    throw tautline::FileError(std::string(this->FileName) + ": " + defect.problem +
      " (cells, faces and points are numbered from 0)");
  }
  this->PatchList = tautline::patchList(piece.mesh);
  tautline::toGrid(std::move(piece), this->LowerCells, vtkUnstructuredGrid::SafeDownCast(output));
}
