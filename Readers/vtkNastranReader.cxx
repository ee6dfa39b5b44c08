// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNastranReader.h"

#include "FileNames.h"
#include "NastranFile.h"
#include "TextCursor.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkNastranReader);

//------------------------------------------------------------------------------
tautline::MeshFile vtkNastranReader::ReadMesh()
{
  return tautline::readNastran(this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
int vtkNastranReader::CanReadFile(const char* name)
{
  const std::string extension = tautline::splitExtension(name).second;
  return (extension == "bdf" || extension == "nas" || extension == "fem") &&
    !tautline::firstWord(name).empty();
}
