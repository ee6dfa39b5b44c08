// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOffReader.h"

#include "FileNames.h"
#include "OffFile.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkOffReader);

//------------------------------------------------------------------------------
tautline::MeshFile vtkOffReader::ReadMesh()
{
  return tautline::readOff(this->FileName, this->LowerCells);
}

//------------------------------------------------------------------------------
int vtkOffReader::CanReadFile(const char* name)
{
  const std::string extension = tautline::splitExtension(name).second;
  return extension == "off" || extension == "coff" || extension == "noff" || extension == "cnoff";
}

//------------------------------------------------------------------------------
int vtkOffReader::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  return 1;
}
