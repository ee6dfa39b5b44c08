#include "vtkTautlineAlgorithm.h"

#include "tautline/Core/Memory.h"

#include "vtkDataObject.h"
#include "vtkDataObjectTypes.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"

#include <algorithm>

namespace
{
constexpr int MeshPort = 0;
}

//------------------------------------------------------------------------------
vtkTautlineAlgorithm::vtkTautlineAlgorithm() = default;

//------------------------------------------------------------------------------
vtkTautlineAlgorithm::~vtkTautlineAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkTautlineAlgorithm::DeclarePorts(
  int inputs, int outputs, std::initializer_list<int> selections)
{
  this->SetNumberOfInputPorts(inputs);
  this->SetNumberOfOutputPorts(outputs);
  this->SelectionPorts = selections;
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  const bool selection =
    std::count(this->SelectionPorts.begin(), this->SelectionPorts.end(), port) > 0;
  // The composite type first, so that the tables are those of all blocks.
  info->Set(
    vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), selection ? "vtkSelection" : "vtkCompositeDataSet");
  if (!selection)
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  }
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), port != MeshPort);
  return 1;
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == MeshPort ? "vtkDataObject" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input =
    this->GetNumberOfInputPorts() > 0 ? vtkDataObject::GetData(inputVector[MeshPort]) : nullptr;
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    // What is announced by an abstract class has the class of the input.
    const std::string announced =
      this->GetOutputPortInformation(port)->Get(vtkDataObject::DATA_TYPE_NAME());
    const bool likeInput = announced == "vtkDataObject" || announced == "vtkDataSet";
    if (likeInput && !input)
    {
      return 0;
    }
    const std::string name = likeInput ? input->GetClassName() : announced;
    vtkInformation* info = outputVector->GetInformationObject(port);
    vtkDataObject* output = vtkDataObject::GetData(info);
    if (!output || name != output->GetClassName())
    {
      info->Set(vtkDataObject::DATA_OBJECT(),
        vtkSmartPointer<vtkDataObject>::Take(
          likeInput ? input->NewInstance() : vtkDataObjectTypes::NewDataObject(name.c_str())));
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
vtkTable* vtkTautlineAlgorithm::GetOutputTable(int port)
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(port));
}

//------------------------------------------------------------------------------
std::string vtkTautlineAlgorithm::FailureOf(
  const char* memoryRemedy, const std::function<void()>& work)
{
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    return tautline::errorText(error, memoryRemedy);
  }
  return "";
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::Fail(vtkInformationVector* outputVector, const std::string& message)
{
  vtkErrorMacro(<< message);
  for (int port = 0; port < outputVector->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputVector, port))
    {
      output->Initialize();
    }
  }
  this->Summary.clear();
  return 0;
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::Attempt(
  vtkInformationVector* outputVector, const char* memoryRemedy, const std::function<void()>& work)
{
  const std::string failure = vtkTautlineAlgorithm::FailureOf(memoryRemedy, work);
  return failure.empty() ? 1 : this->Fail(outputVector, failure);
}

//------------------------------------------------------------------------------
bool vtkTautlineAlgorithm::Proceed(double fraction)
{
  this->UpdateProgress(fraction);
  return this->GetAbortExecute() == 0;
}

//------------------------------------------------------------------------------
void vtkTautlineAlgorithm::AddToSummary(const std::string& paragraph)
{
  this->Summary += (this->Summary.empty() || paragraph.empty() ? "" : "\n") + paragraph;
}

//------------------------------------------------------------------------------
void vtkTautlineAlgorithm::Warn(const std::string& text)
{
  if (!text.empty())
  {
    vtkWarningMacro(<< text);
  }
}

//------------------------------------------------------------------------------
void vtkTautlineAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Threads: " << this->Threads << "\n";
  os << indent << "Summary: " << this->Summary << "\n";
}
