// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMfemReader.h"

#include "FileNames.h"
#include "MfemFile.h"
#include "TextCursor.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkMfemReader);

//------------------------------------------------------------------------------
tautline::MeshFile vtkMfemReader::ReadMesh()
{
  return tautline::readMfem(this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
int vtkMfemReader::CanReadFile(const char* name)
{
  return tautline::splitExtension(name).second == "mesh" && tautline::firstWord(name) == "MFEM";
}
