// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGmshReader.h"

#include "FileNames.h"
#include "GmshFile.h"
#include "PartExchange.h"
#include "TextCursor.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGmshReader);

//------------------------------------------------------------------------------
tautline::MeshFile vtkGmshReader::ReadMesh()
{
  return tautline::readGmsh(this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
tautline::MeshShare vtkGmshReader::ReadShare(const tautline::FileRanges& ranges)
{
  return tautline::shareGmsh(ranges, this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
bool vtkGmshReader::HasRanges(const std::string& extension) const
{
  return extension.empty() || extension == "msh";
}

//------------------------------------------------------------------------------
int vtkGmshReader::CanReadFile(const char* name)
{
  const std::string extension = tautline::splitExtension(name).second;
  const std::string start = tautline::firstWord(name);
  return extension == "msh" &&
    (start == "$MeshFormat" || start == "$NOD" ||
      (!start.empty() && start[0] >= '0' && start[0] <= '9'));
}
