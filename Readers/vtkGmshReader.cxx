// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGmshReader.h"

#include "FileNames.h"
#include "GmshFile.h"
#include "TextCursor.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGmshReader);

//------------------------------------------------------------------------------
tautline::MeshFile vtkGmshReader::ReadMesh()
{
  return tautline::readGmsh(this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
int vtkGmshReader::CanReadFile(const char* name)
{
  const std::string extension = tautline::splitExtension(name).second;
  const std::string start = tautline::firstWord(name);
  return (extension == "msh" || extension == "msh2" || extension == "msh4") &&
    (start == "$MeshFormat" || start == "$NOD" ||
      (!start.empty() && start[0] >= '0' && start[0] <= '9'));
}
