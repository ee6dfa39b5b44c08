// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAbaqusReader.h"

#include "AbaqusFile.h"
#include "FileNames.h"
#include "TextCursor.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkAbaqusReader);

//------------------------------------------------------------------------------
tautline::MeshFile vtkAbaqusReader::ReadMesh()
{
  return tautline::readAbaqus(this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
int vtkAbaqusReader::CanReadFile(const char* name)
{
  const std::string extension = tautline::splitExtension(name).second;
  return extension == "inp" && tautline::firstWord(name).substr(0, 1) == "*";
}
