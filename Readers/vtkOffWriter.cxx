// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOffWriter.h"

#include "OffFile.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkOffWriter);

//------------------------------------------------------------------------------
std::vector<std::string> vtkOffWriter::WriteMesh(
  const tautline::MeshFile& mesh, const std::string& name)
{
  return tautline::writeOff(mesh, name);
}
