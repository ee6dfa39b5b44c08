#include "vtkMeshWarp.h"

#include "Processes.h"
#include "WarpSession.h"

#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkLinearTransform.h"
#include "vtkObjectFactory.h"
#include "vtkSelection.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>
#include <set>

vtkStandardNewMacro(vtkMeshWarp);

namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

enum Ports
{
  MeshPort = 0,
  TargetPort = 1, // input
  MovedPort = 2,  // input
  FixedPort = 3,  // input
  NumberOfInputPorts = 4,
  HistoryPort = 1,
  StatisticsPort = 2,
  NumberOfOutputPorts = 3
};

std::vector<double> timeStepsOf(vtkInformationVector* input)
{
  vtkInformation* info =
    input->GetNumberOfInformationObjects() > 0 ? input->GetInformationObject(0) : nullptr;
  if (!info || !info->Has(Pipeline::TIME_STEPS()))
  {
    return {};
  }
  const double* steps = info->Get(Pipeline::TIME_STEPS());
  return std::vector<double>(steps, steps + info->Length(Pipeline::TIME_STEPS()));
}
}

//------------------------------------------------------------------------------
vtkMeshWarp::vtkMeshWarp()
  : Kept(std::make_unique<Session>(this))
{
  this->SetNumberOfInputPorts(NumberOfInputPorts);
  this->SetNumberOfOutputPorts(NumberOfOutputPorts);
}

//------------------------------------------------------------------------------
vtkMeshWarp::~vtkMeshWarp() = default;

//------------------------------------------------------------------------------
void vtkMeshWarp::SetTargetIds(const char* name)
{
  const std::string given = name ? name : "";
  if (given != this->TargetIds)
  {
    this->TargetIds = given;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkMeshWarp::AddPart(int number)
{
  this->Parts.push_back(number);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkMeshWarp::RemoveAllParts()
{
  this->Parts.clear();
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkMeshWarp::AddValue(double value)
{
  this->Values.push_back(value);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkMeshWarp::RemoveAllValues()
{
  this->Values.clear();
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkMeshWarp::AddRegion(double region, double alpha, double beta, double gamma)
{
  this->Regions.push_back({ region, alpha, beta, gamma });
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkMeshWarp::RemoveAllRegions()
{
  this->Regions.clear();
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkMeshWarp::SetTransform(vtkLinearTransform* transform)
{
  if (transform != this->Transform)
  {
    this->Transform = transform;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkLinearTransform* vtkMeshWarp::GetTransform()
{
  return this->Transform;
}

//------------------------------------------------------------------------------
vtkMTimeType vtkMeshWarp::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Transform ? std::max(own, this->Transform->GetMTime()) : own;
}

//------------------------------------------------------------------------------
vtkTable* vtkMeshWarp::GetHistory()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(HistoryPort));
}

//------------------------------------------------------------------------------
vtkTable* vtkMeshWarp::GetStatistics()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(StatisticsPort));
}

//------------------------------------------------------------------------------
int vtkMeshWarp::FillInputPortInformation(int port, vtkInformation* info)
{
  tautline::declareInput(info, port == MovedPort || port == FixedPort, port != MeshPort);
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshWarp::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == MeshPort ? "vtkDataObject" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshWarp::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  if (!input)
  {
    return 0;
  }
  tautline::provideOutputs(input, outputVector);
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshWarp::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const std::vector<double> own = timeStepsOf(inputVector[MeshPort]);
  std::set<double> steps(own.begin(), own.end());
  if (this->Motion == TARGET)
  {
    const std::vector<double> more = timeStepsOf(inputVector[TargetPort]);
    steps.insert(more.begin(), more.end());
  }
  this->Kept->times.assign(steps.begin(), steps.end());
  for (int port = 0; !steps.empty() && port < NumberOfOutputPorts; ++port)
  {
    const std::vector<double>& times = this->Kept->times;
    const double range[2] = { times.front(), times.back() };
    vtkInformation* info = outputVector->GetInformationObject(port);
    info->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshWarp::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (!this->Kept->sequence())
  {
    return 1;
  }
  vtkMTimeType upstream = 0;
  for (int port = 0; port < NumberOfInputPorts; ++port)
  {
    for (int i = 0; i < this->GetNumberOfInputConnections(port); ++i)
    {
      auto* producer = vtkDemandDrivenPipeline::SafeDownCast(this->GetInputExecutive(port, i));
      upstream = std::max(upstream, producer ? producer->GetPipelineMTime() : 0);
    }
  }
  double time = this->Kept->times.front();
  for (int port = 0; port < NumberOfOutputPorts; ++port)
  {
    vtkInformation* info = outputVector->GetInformationObject(port);
    if (info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      time = info->Get(Pipeline::UPDATE_TIME_STEP());
      break;
    }
  }
  this->Kept->plan(time, upstream);
  for (int port : { MeshPort, TargetPort })
  {
    for (int i = 0; i < inputVector[port]->GetNumberOfInformationObjects(); ++i)
    {
      inputVector[port]->GetInformationObject(i)->Set(
        Pipeline::UPDATE_TIME_STEP(), this->Kept->times[this->Kept->current]);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshWarp::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Session& session = *this->Kept;
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  vtkDataObject* target = vtkDataObject::GetData(inputVector[TargetPort]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector, MeshPort);
  tautline::TableRows history, statistics;
  tautline::WarpTotals totals;
  std::string failure;
  try
  {
    tautline::requireOneProcess(input);
    const auto moved = tautline::markSelected(input, vtkSelection::GetData(inputVector[MovedPort]));
    const auto fixed = tautline::markSelected(input, vtkSelection::GetData(inputVector[FixedPort]));
    session.numberOfBlocks = tautline::countBlocks(input);
    tautline::forEachBlock(input, nullptr, fixed, output,
      [&](const tautline::InputBlock& block)
      { session.visit(block, target, moved, history, statistics, totals); });
    session.blocks.erase(
      session.blocks.lower_bound(static_cast<int>(session.numberOfBlocks)), session.blocks.end());
  }
  catch (const std::bad_alloc&)
  {
    failure =
      "Not enough memory: choose conjugate gradients with BoomerAMG (Automatic Solver off), or "
      "warp the mesh in parts.";
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  // Processes fail together: those that did would execute again alone, and wait for the others.
  if (tautline::minimumOverProcesses(failure.empty()) == 0)
  {
    vtkErrorMacro(<< (failure.empty()
                      ? "Another process could not warp its data set, see its error."
                      : failure));
    return this->Fail(outputVector, request);
  }
  session.begun = session.sequence();
  // Time steps before the one wanted, which the result needs: again, with the next of them.
  if (session.sequence() && session.current < session.wanted)
  {
    session.looping = true;
    session.current = this->StartFrom == PREVIOUS_STEP ? session.current + 1 : session.wanted;
    request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    return 1;
  }
  if (session.looping)
  {
    session.looping = false;
    request->Remove(Pipeline::CONTINUE_EXECUTING());
  }
  if (session.sequence())
  {
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), session.times[session.wanted]);
  }
  history.fill(vtkTable::GetData(outputVector, HistoryPort));
  statistics.fill(vtkTable::GetData(outputVector, StatisticsPort));
  this->Summary = totals.summary;
  this->InvertedAfterWarp = totals.invertedAfterWarp;
  this->Inverted = totals.inverted;
  this->Impossible = totals.impossible;
  this->WorstShape = totals.worstShape;
  this->Reused = totals.reused;
  if (totals.inverted > 0 || totals.incomplete)
  {
    vtkWarningMacro(<< this->Summary);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshWarp::Fail(vtkInformationVector* outputs, vtkInformation* request)
{
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  for (int port = 0; port < NumberOfOutputPorts; ++port)
  {
    vtkDataObject::GetData(outputs, port)->Initialize();
  }
  this->Kept->looping = this->Kept->begun = false;
  this->Kept->blocks.clear();
  this->Summary.clear();
  this->InvertedAfterWarp = this->Inverted = this->Impossible = 0;
  this->WorstShape = 0.0;
  this->Reused = 0;
  return 0;
}

//------------------------------------------------------------------------------
void vtkMeshWarp::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Motion: " << this->Motion << "\n";
  os << indent << "Amount: " << this->Amount << "\n";
  os << indent << "Correspondence: " << this->Correspondence << "\n";
  os << indent << "MovedPart: " << this->MovedPart << "\n";
  os << indent << "TransformKind: " << this->TransformKind << "\n";
  os << indent << "Transform: " << this->Transform.Get() << "\n";
  os << indent << "StartFrom: " << this->StartFrom << "\n";
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Coefficients: " << this->Coefficients << "\n";
  os << indent << "Steps: " << this->Steps << "\n";
  os << indent << "AutomaticSolver: " << this->AutomaticSolver << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
  os << indent << "Threads: " << this->Threads << "\n";
  os << indent << "Summary: " << this->Summary << "\n";
}
