#include "vtkGmshWriter.h"

#include "GmshFile.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGmshWriter);

//------------------------------------------------------------------------------
std::vector<std::string> vtkGmshWriter::WriteMesh(
  const tautline::MeshFile& mesh, const std::string& name)
{
  return tautline::writeGmsh(mesh, name, this->Binary);
}
