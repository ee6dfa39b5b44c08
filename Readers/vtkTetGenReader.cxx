// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTetGenReader.h"

#include "FileNames.h"
#include "TetGenFile.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkTetGenReader);

//------------------------------------------------------------------------------
tautline::MeshFile vtkTetGenReader::ReadMesh()
{
  return tautline::readTetGen(this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
int vtkTetGenReader::CanReadFile(const char* name)
{
  const std::string extension = tautline::splitExtension(name).second;
  return extension == "node" || extension == "ele" || extension == "face" || extension == "edge" ||
    extension == "poly" || extension == "smesh";
}
