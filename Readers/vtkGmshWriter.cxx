// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGmshWriter.h"

#include "GmshFile.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGmshWriter);

//------------------------------------------------------------------------------
std::vector<std::string> vtkGmshWriter::WriteMesh(
  const tautline::MeshFile& mesh, const std::string& name)
{
  const std::string ending = ".pos";
  if (name.size() < ending.size() || name.substr(name.size() - ending.size()) != ending)
  {
    return tautline::writeGmsh(mesh, name, this->Binary);
  }
  if (this->Binary)
  {
    throw tautline::FileError(name + ": views are written as text; switch Binary off");
  }
  std::vector<std::string> warnings;
  std::vector<std::string> files = tautline::writeGmshViews(mesh, name, &warnings);
  for (const std::string& warning : warnings)
  {
    vtkWarningMacro(<< name << ": " << warning);
  }
  return files;
}
