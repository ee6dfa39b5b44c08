// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageFileReader.h"

#include "ImageFileAdapter.h"
#include "tautline/Core/Types.h"

#include "vtkImageData.h"
#include "vtkImageReader2.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <new>

vtkStandardNewMacro(vtkImageFileReader);

//------------------------------------------------------------------------------
vtkImageFileReader::vtkImageFileReader()
{
  this->SetNumberOfInputPorts(0);
}

//------------------------------------------------------------------------------
vtkImageFileReader::~vtkImageFileReader()
{
  this->SetFileName(nullptr);
}

//------------------------------------------------------------------------------
bool vtkImageFileReader::CanReadFile(const char* name)
{
  return name && tautline::isImageFile(name);
}

//------------------------------------------------------------------------------
int vtkImageFileReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  return this->Guarded(
    [&](const std::string& name)
    {
      outputVector->GetInformationObject(0)->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(),
        tautline::openImage(name)->GetDataExtent(), 6);
    });
}

//------------------------------------------------------------------------------
int vtkImageFileReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkImageData* output = vtkImageData::GetData(outputVector);
  output->Initialize();
  return this->Guarded(
    [&](const std::string& name) { output->ShallowCopy(tautline::readImage(name)); });
}

//------------------------------------------------------------------------------
int vtkImageFileReader::Guarded(const std::function<void(const std::string&)>& work)
{
  const std::string name = this->FileName ? this->FileName : "";
  try
  {
    if (name.empty())
    {
      throw tautline::Error("no file name is set");
    }
    work(name);
  }
  catch (const tautline::Error& error)
  {
    vtkErrorMacro(<< error.what());
    return 0;
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro(<< name << ": not enough memory");
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkImageFileReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
}
