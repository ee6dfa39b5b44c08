// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshFileWriter.h"

#include "MeshFileAdapter.h"
#include "ValidateInput.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"

#include "vtkDataSet.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"

#include <new>

//------------------------------------------------------------------------------
vtkMeshFileWriter::~vtkMeshFileWriter()
{
  this->SetFileName(nullptr);
}

//------------------------------------------------------------------------------
int vtkMeshFileWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  // Accepts other types as well, so that the message can give the remedy.
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshFileWriter::Write()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->ErrorText.clear();
  return this->Superclass::Write() && this->GetErrorCode() == vtkErrorCode::NoError;
}

//------------------------------------------------------------------------------
std::string vtkMeshFileWriter::TargetName()
{
  if (!this->FileName || !this->FileName[0])
  {
    throw tautline::Error("no file name");
  }
  return this->FileName;
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkMeshFileWriter::WriteMesh(const tautline::MeshFile&, const std::string&)
{
  return {};
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkMeshFileWriter::WriteDataSet(vtkDataSet* mesh, const std::string& name)
{
  return this->WriteMesh(tautline::fromDataSet(mesh), name);
}

//------------------------------------------------------------------------------
void vtkMeshFileWriter::WriteData()
{
  this->FilesWritten.clear();
  std::string name;
  try
  {
    name = this->TargetName();
    auto* input = vtkDataSet::SafeDownCast(this->GetInput());
    if (!input)
    {
      throw tautline::Error(name + ": the input is a " +
        (this->GetInput() ? this->GetInput()->GetClassName() : "null") +
        ", but a file holds one mesh: extract a block (Extract Block), or merge the blocks first "
        "(Merge Blocks)");
    }
    const std::string problem = tautline::inputProblem(input, { true });
    if (!problem.empty())
    {
      throw tautline::Error(name + ": " + problem);
    }
    this->FilesWritten = this->WriteDataSet(input, name);
  }
  catch (const std::exception& error)
  {
    this->ErrorText = tautline::errorText(error, name + " cannot be written");
  }
  catch (const tautline::Interrupted&)
  {
    this->ErrorText = name + ": writing was interrupted";
  }
  if (!this->ErrorText.empty())
  {
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    vtkErrorMacro(<< this->ErrorText);
  }
}

//------------------------------------------------------------------------------
void vtkMeshFileWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
}
