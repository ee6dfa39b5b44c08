// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMfemWriter.h"

#include "MfemFile.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkMfemWriter);

//------------------------------------------------------------------------------
vtkMfemWriter::~vtkMfemWriter()
{
  this->SetTemplateFileName(nullptr);
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkMfemWriter::WriteMesh(
  const tautline::MeshFile& mesh, const std::string& name)
{
  const bool hasTemplate = this->TemplateFileName && *this->TemplateFileName;
  return hasTemplate ? tautline::rewriteMfem(mesh, this->TemplateFileName, name)
                     : tautline::writeMfem(mesh, name, this->Continuous);
}
