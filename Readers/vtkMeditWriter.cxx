// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeditWriter.h"

#include "MeditFile.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkMeditWriter);

//------------------------------------------------------------------------------
std::vector<std::string> vtkMeditWriter::WriteMesh(
  const tautline::MeshFile& mesh, const std::string& name)
{
  return tautline::writeMedit(mesh, name);
}
