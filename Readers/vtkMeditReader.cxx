// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeditReader.h"

#include "FileNames.h"
#include "MeditFile.h"
#include "TextCursor.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkMeditReader);

//------------------------------------------------------------------------------
tautline::MeshFile vtkMeditReader::ReadMesh()
{
  return tautline::readMedit(this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
int vtkMeditReader::CanReadFile(const char* name)
{
  const std::string extension = tautline::splitExtension(name).second;
  const std::string start = tautline::firstWord(name);
  if (extension == "meshb")
  {
    return tautline::isMeditBinary(name);
  }
  return (extension == "mesh" || extension == "sol") && start == "MeshVersionFormatted";
}
