// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTautlineAlgorithm.h"

#include "Blocks.h"
#include "ExecutionScope.h"
#include "GatheredExecution.h"
#include "ProcessGroup.h"
#include "Processes.h"
#include "ProgressStep.h"
#include "ValidateInput.h"
#include "VtkCompatibility.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"

#include "vtkAlgorithmOutput.h"
#include "vtkDataObject.h"
#include "vtkDataObjectTypes.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPointData.h"
#include "vtkSelection.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace
{
constexpr int MeshPort = 0;

/// Removes data that VTK's reader leaves at random from copies; the inputs are not changed.
void removeStrayFaces(vtkInformationVector** inputs, int ports, vtkInformationVector* outputs)
{
  std::set<vtkDataSet*> given;
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      tautline::forEachLeaf(vtkDataObject::GetData(inputs[port], i),
        [&given](unsigned int, vtkDataSet* leaf) { given.insert(leaf); });
    }
  }
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    tautline::forEachLeaf(vtkDataObject::GetData(outputs, port),
      [&given](unsigned int, vtkDataSet* leaf)
      {
        auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
        if (grid && given.count(grid) == 0)
        {
          tautline::removeStrayFaces(grid);
        }
      });
  }
}
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
  // The composite type comes first, so that the tables cover all blocks.
  info->Set(
    vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), selection ? "vtkSelection" : "vtkCompositeDataSet");
  if (!selection)
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
    // Accepts other data as well, so that the message can give the remedy.
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
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
    // If an abstract class is announced, the output has the class of the input.
    const std::string announced =
      this->GetOutputPortInformation(port)->Get(vtkDataObject::DATA_TYPE_NAME());
    const bool likeInput = announced == "vtkDataObject" || announced == "vtkDataSet";
    if (likeInput && !input)
    {
      return 0;
    }
    // A block that is not a data set is left out but has an output.
    const bool other = announced == "vtkDataSet" && !vtkDataSet::SafeDownCast(input);
    const std::string name = other ? "vtkUnstructuredGrid"
      : likeInput                  ? input->GetClassName()
                                   : announced;
    vtkInformation* info = outputVector->GetInformationObject(port);
    vtkDataObject* output = vtkDataObject::GetData(info);
    if (!output || name != output->GetClassName())
    {
      info->Set(vtkDataObject::DATA_OBJECT(),
        vtkSmartPointer<vtkDataObject>::Take(likeInput && !other
            ? input->NewInstance()
            : vtkDataObjectTypes::NewDataObject(name.c_str())));
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkTautlineAlgorithm::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    tautline::nameProgress(this);
    return this->Superclass::ProcessRequest(request, inputs, outputs);
  }
  this->Start = std::chrono::steady_clock::now();
  this->Best = false;
  bool complete = false;
  const tautline::ExecutionLimits limits = { this->GetExecutionSeconds(),
    [this] { return this->KeepsBest(); } };
  const int result = tautline::processInScope(this, limits, request, outputs,
    [&]
    {
      const int executed = this->GetNumberOfInputPorts() > 0
        ? this->ExecuteData(request, inputs, outputs)
        : this->Superclass::ProcessRequest(request, inputs, outputs);
      removeStrayFaces(inputs, this->GetNumberOfInputPorts(), outputs);
      complete = true;
      return executed;
    });
  if (!complete)
  {
    this->ClearResult();
  }
  return result;
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::ExecuteData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!this->UpstreamProblem.empty())
  {
    request->Remove(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING());
    this->ClearResult();
    return this->Fail(outputs, std::exchange(this->UpstreamProblem, ""));
  }
  vtkDataObject* input = vtkDataObject::GetData(inputs[MeshPort]);
  if (!this->TakesComposite(MeshPort) && !vtkDataSet::SafeDownCast(input))
  {
    vtkWarningMacro(<< tautline::leftOut(input, "mesh"));
    for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
    {
      vtkDataObject::GetData(outputs, port)->Initialize();
    }
    return 1;
  }
  std::string problem;
  const std::string failure = vtkTautlineAlgorithm::FailureOf("divide the mesh",
    [&]
    {
      problem = this->FindSettingProblem();
      problem = problem.empty() ? this->FindInputProblem(inputs) : problem;
    });
  problem = failure.empty() ? problem : failure;
  const tautline::GatheredRules rules = this->GetGatheredRules();
  const bool gathers = tautline::isGathered(this, rules);
  const bool together = rules.onAll || gathers;
  if (together)
  {
    problem = tautline::firstProblem(problem);
  }
  if (!problem.empty())
  {
    // A filter that executes itself once per time step ends at the first invalid one.
    request->Remove(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING());
    this->ClearResult();
    return this->Fail(outputs, problem);
  }
  std::string empty = tautline::emptyInput(input);
  if (together)
  {
    // The first process may have no part of a mesh.
    const bool here = input->GetNumberOfElements(vtkDataObject::CELL) == 0;
    empty = tautline::minimumOverProcesses(here) ? empty : "";
  }
  const std::string notice = tautline::skippedLeaves(input);
  if (!notice.empty())
  {
    vtkWarningMacro(<< notice);
  }
  this->InPieces = gathers && tautline::severalProcesses() && this->TakesPieces(inputs);
  const int executed = gathers && !this->InPieces
    ? this->ExecuteGathered(rules, request, inputs, outputs)
    : this->Superclass::ProcessRequest(request, inputs, outputs);
  if (executed && !empty.empty())
  {
    this->Summary = empty;
    this->Warn(empty);
  }
  return executed;
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::ExecuteGathered(tautline::GatheredRules rules, vtkInformation* request,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  rules.exchange = [this](tautline::ResultStream& stream) { this->ExchangeResult(stream); };
  // On the first process, which is temporarily the only one for VTK.
  const bool several = tautline::severalProcesses() != nullptr;
  const auto execute = [&]
  {
    if (!several) // the scope of the request holds
    {
      return static_cast<int>(this->Superclass::ProcessRequest(request, inputs, outputs));
    }
    const tautline::ExecutionLimits limits = { this->GetExecutionSeconds(),
      [this] { return this->KeepsBest(); } };
    return tautline::processInScope(this, limits, request, outputs,
      [&] { return this->Superclass::ProcessRequest(request, inputs, outputs); });
  };
  const int executed = tautline::executeGathered(this, request, inputs, outputs, rules, execute);
  if (!executed)
  {
    this->ClearResult();
  }
  return executed;
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::ModifyRequest(vtkInformation* request, int when)
{
  const auto isTogether = [this]
  {
    const tautline::GatheredRules rules = this->GetGatheredRules();
    return rules.onAll || rules.result != tautline::GatheredResult::None;
  };
  const bool update = when == vtkExecutive::BeforeForward &&
    request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()) && this->GetNumberOfInputPorts() > 0 &&
    (this->ExecutesAgain() || (tautline::severalProcesses() && isTogether()));
  return update ? this->UpdateInputs(request) : this->Superclass::ModifyRequest(request, when);
}

//------------------------------------------------------------------------------
namespace
{
/// Whether the next Tautline filter upstream has failed, which is visible only in its error code,
/// see processInScope(). ParaView inserts filters of its own between the user's filters.
bool hasFailed(vtkExecutive* executive)
{
  vtkAlgorithm* algorithm = executive->GetAlgorithm();
  const bool failed = algorithm->GetErrorCode() == vtkErrorCode::UserError;
  if (failed || vtkTautlineAlgorithm::SafeDownCast(algorithm))
  {
    return failed;
  }
  for (int i = 0; i < algorithm->GetNumberOfInputPorts(); ++i)
  {
    for (int k = 0; k < algorithm->GetNumberOfInputConnections(i); ++k)
    {
      if (hasFailed(executive->GetInputExecutive(i, k)))
      {
        return true;
      }
    }
  }
  return false;
}
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::UpdateInputs(vtkInformation* request)
{
  const int port = request->Get(vtkExecutive::FROM_OUTPUT_PORT());
  bool failed = false;
  vtkMTimeType time = 0;
  std::vector<double> steps;
  for (int i = 0; i < this->GetNumberOfInputPorts(); ++i)
  {
    for (int k = 0; k < this->GetNumberOfInputConnections(i); ++k)
    {
      vtkExecutive* upstream = this->GetInputExecutive(i, k);
      request->Set(vtkExecutive::FROM_OUTPUT_PORT(), this->GetInputConnection(i, k)->GetIndex());
      failed = !upstream->ProcessRequest(
                 request, upstream->GetInputInformation(), upstream->GetOutputInformation()) ||
        failed;
      failed = failed || hasFailed(upstream);
      auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(upstream);
      time = std::max(time, pipeline ? pipeline->GetPipelineMTime() : 0);
      vtkInformation* info =
        upstream->GetOutputInformation(this->GetInputConnection(i, k)->GetIndex());
      using Streaming = vtkStreamingDemandDrivenPipeline;
      steps.push_back(info->Has(Streaming::UPDATE_TIME_STEP())
          ? info->Get(Streaming::UPDATE_TIME_STEP())
          : std::numeric_limits<double>::lowest()); // NaN is not equal to itself
    }
  }
  request->Set(vtkExecutive::FROM_OUTPUT_PORT(), port);
  // A failed algorithm counts as up to date, with empty outputs.
  failed =
    failed || (this->FailedInputs > 0 && this->FailedInputs == time && this->FailedSteps == steps);
  this->FailedInputs = failed ? time : 0;
  this->FailedSteps = steps;
  const std::string problem = tautline::firstProblem(failed
      ? "An input could not be computed; see the error of the filter or reader before this one."
      : "");
  if (!problem.empty() && this->ExecutesAgain())
  {
    this->UpstreamProblem = problem; // the inputs count as up to date
    return 1;
  }
  if (!problem.empty())
  {
    this->ClearResult();
    this->Fail(this->GetExecutive()->GetOutputInformation(), problem);
  }
  return problem.empty() ? 1 : 0;
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkTautlineAlgorithm::GetGatheredRules()
{
  tautline::GatheredRules rules;
  rules.onAll = this->GetNumberOfInputPorts() > 0 && this->TakesComposite(MeshPort);
  return rules;
}

//------------------------------------------------------------------------------
bool vtkTautlineAlgorithm::TakesPieces(vtkInformationVector**)
{
  return false;
}

//------------------------------------------------------------------------------
bool vtkTautlineAlgorithm::PartitionsHaveIds()
{
  bool all = true;
  vtkDataObject* input = this->GetNumberOfInputConnections(MeshPort) > 0
    ? this->GetInputDataObject(MeshPort, 0)
    : nullptr;
  if (!input)
  {
    return false;
  }
  tautline::forEachLeaf(input,
    [&all](unsigned int, vtkDataSet* leaf)
    { all = all && (leaf->GetNumberOfPoints() == 0 || leaf->GetPointData()->GetGlobalIds()); });
  return all;
}

//------------------------------------------------------------------------------
void vtkTautlineAlgorithm::ExchangeResult(tautline::ResultStream& stream)
{
  stream(this->Summary);
}

//------------------------------------------------------------------------------
bool vtkTautlineAlgorithm::TakesComposite(int port)
{
  const char* first =
    this->GetInputPortInformation(port)->Get(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), 0);
  const std::string type = first ? first : "";
  return type == "vtkCompositeDataSet" || type == "vtkMultiBlockDataSet";
}

//------------------------------------------------------------------------------
std::string vtkTautlineAlgorithm::FindInputProblem(vtkInformationVector** inputs)
{
  vtkDataObject* mesh = vtkDataObject::GetData(inputs[MeshPort]);
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    const tautline::InputRules rules = { this->NeedsFinitePoints(port), this->Threads };
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkDataObject* data = vtkDataObject::GetData(inputs[port], i);
      vtkSelection* selection = vtkSelection::SafeDownCast(data);
      const std::string problem = selection ? tautline::selectionProblem(selection, mesh)
                                            : tautline::inputProblem(data, rules);
      if (!problem.empty())
      {
        return (port == MeshPort || selection ? "" : "Input " + std::to_string(port + 1) + ": ") +
          problem;
      }
    }
  }
  return "";
}

//------------------------------------------------------------------------------
std::string vtkTautlineAlgorithm::FindSettingProblem() const
{
  return "";
}

//------------------------------------------------------------------------------
bool vtkTautlineAlgorithm::NeedsFinitePoints(int) const
{
  return false;
}

//------------------------------------------------------------------------------
double vtkTautlineAlgorithm::GetExecutionSeconds() const
{
  return 0.0;
}

//------------------------------------------------------------------------------
bool vtkTautlineAlgorithm::KeepsBest() const
{
  return this->Best;
}

//------------------------------------------------------------------------------
double vtkTautlineAlgorithm::GetRemainingSeconds() const
{
  constexpr double least = 1e-9; // 0 would be no limit
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - this->Start;
  const double limit = this->GetExecutionSeconds();
  return limit > 0.0 ? std::max(least, limit - spent.count()) : 0.0;
}

//------------------------------------------------------------------------------
void vtkTautlineAlgorithm::ClearResult()
{
  this->Summary.clear();
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
    tautline::emptyOutput(outputVector->GetInformationObject(port));
  }
  this->Summary.clear();
  return 0;
}

//------------------------------------------------------------------------------
int vtkTautlineAlgorithm::Attempt(
  vtkInformationVector* outputVector, const char* memoryRemedy, const std::function<void()>& work)
{
  const auto group = this->InPieces ? tautline::tryProcessGroup() : nullptr;
  const std::string failure =
    vtkTautlineAlgorithm::FailureOf(memoryRemedy, [&] { group ? group->together(work) : work(); });
  return failure.empty() ? 1 : this->Fail(outputVector, failure);
}

//------------------------------------------------------------------------------
bool vtkTautlineAlgorithm::Proceed(double fraction)
{
  tautline::advance(this, fraction);
  tautline::throwIfInterrupted();
  return this->GetAbortExecute() == 0;
}

//------------------------------------------------------------------------------
void vtkTautlineAlgorithm::ShowIteration(
  const char* filter, int iteration, std::initializer_list<ProgressValue> values)
{
  constexpr int digits = 6;
  std::ostringstream text;
  text.precision(digits);
  text << filter << ": iteration " << iteration;
  for (const ProgressValue& shown : values)
  {
    if (std::isfinite(shown.value))
    {
      text << ", " << shown.name << " " << shown.value;
    }
  }
  this->SetProgressText(text.str().c_str());
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
