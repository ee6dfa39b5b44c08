// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeditWriter.h"

#include "FileNames.h"
#include "MeditFile.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkMeditWriter);

//------------------------------------------------------------------------------
std::vector<std::string> vtkMeditWriter::WriteMesh(
  const tautline::MeshFile& mesh, const std::string& name)
{
  const std::string leftOut = tautline::meditArraysLeftOut(mesh);
  if (tautline::splitExtension(name).second == "meshb" && !leftOut.empty())
  {
    vtkWarningMacro(<< name << ": the arrays " << leftOut
                    << " are left out; write .mesh, which stores them in a .sol beside it");
  }
  return tautline::writeMedit(mesh, name);
}
