// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTetGenWriter.h"

#include "TetGenFile.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkTetGenWriter);

//------------------------------------------------------------------------------
std::vector<std::string> vtkTetGenWriter::WriteMesh(
  const tautline::MeshFile& mesh, const std::string& name)
{
  return tautline::writeTetGen(mesh, name);
}
