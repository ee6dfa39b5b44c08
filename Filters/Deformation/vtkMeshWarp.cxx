// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshWarp.h"

#include "CurvedMesh.h"
#include "GatheredExecution.h"
#include "Processes.h"
#include "WarpPieces.h"

#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkLinearTransform.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkSelection.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>
#include <optional>
#include <set>

vtkStandardNewMacro(vtkMeshWarp);

namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

enum Ports
{
  TargetPort = 1, // input
  MovedPort = 2,  // input
  FixedPort = 3,  // input
  NumberOfInputPorts = 4,
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
  : Session(std::make_unique<tautline::WarpSession>())
{
  this->DeclarePorts(NumberOfInputPorts, NumberOfOutputPorts, { MovedPort, FixedPort });
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
vtkTable* vtkMeshWarp::GetStatistics()
{
  return this->GetOutputTable(StatisticsPort);
}

//------------------------------------------------------------------------------
tautline::WarpSettings vtkMeshWarp::GetSettings()
{
  const auto vector = [](const double* v) { return tautline::Vec3{ v[0], v[1], v[2] }; };
  tautline::WarpSettings settings;
  settings.motion = static_cast<tautline::MotionSource>(this->Motion);
  settings.amount = this->Amount;
  settings.fromPreviousStep = this->StartFrom == PREVIOUS_STEP;
  settings.correspondence = static_cast<tautline::Correspondence>(this->Correspondence);
  settings.targetIds = this->TargetIds;
  settings.part = static_cast<tautline::MovedPart>(this->MovedPart);
  settings.partNumbers = this->Parts;
  settings.partValues = this->Values;
  tautline::PointMotion& motion = settings.transform;
  motion.kind = static_cast<tautline::MotionKind>(this->TransformKind);
  if (this->Transform)
  {
    std::copy_n(
      this->Transform->GetMatrix()->GetData(), motion.matrix.size(), motion.matrix.begin());
  }
  motion.translation = vector(this->Translation);
  motion.angle = this->Angle;
  motion.axis = vector(this->Axis);
  motion.factors = vector(this->ScaleFactors);
  motion.direction = vector(this->Direction);
  motion.ownCenter = this->OwnCenter;
  motion.center = vector(this->Center);
  settings.tensorsByRegion = this->Coefficients == PER_REGION;
  settings.regions = this->Regions;

  tautline::WarpOptions& options = settings.options;
  settings.mergePoints = this->MergeCoincidentPoints;
  options.method = static_cast<tautline::WarpMethod>(this->Method);
  // Converts tensors by region to tensors per cell.
  options.coefficients = settings.tensorsByRegion
    ? tautline::WarpCoefficients::PerCell
    : static_cast<tautline::WarpCoefficients>(this->Coefficients);
  std::copy_n(this->Tensor, options.tensor.size(), options.tensor.begin());
  options.steps = this->Steps;
  options.maximumSteps = this->MaximumSteps;
  options.automaticSolver = this->AutomaticSolver;
  options.solver.method = static_cast<tautline::KrylovMethod>(this->Solver);
  options.solver.preconditioner = static_cast<tautline::Preconditioner>(this->Preconditioner);
  options.solver.threads = this->Threads;
  options.tolerance = this->Tolerance;
  options.poissonRatio = this->PoissonRatio;
  options.stiffeningPower = this->StiffeningPower;
  options.stiffeningFactor = this->StiffeningFactor;
  options.maximumStiffenings = this->MaximumStiffenings;
  options.distancePower = this->DistancePower;
  options.supportRadius = this->SupportRadius;
  options.fitTolerance = this->FitTolerance;
  options.untangleFirst = this->UntangleFirst;
  options.untanglingBeta = this->UntanglingBeta;
  options.optimization.stopping.maximumIterations = this->MaximumIterations;
  options.maximumSeconds = this->TimeLimit;
  options.threads = this->Threads;
  settings.arrays = this;
  settings.secondsLeft = [this] { return this->GetRemainingSeconds(); };
  settings.progress = [this](int block, double fraction)
  { return this->ProceedInBlock(block, fraction); };
  return settings;
}

//------------------------------------------------------------------------------
bool vtkMeshWarp::PlaysMotion(const std::vector<double>& times) const
{
  return this->Animation && this->Motion != TIME_STEPS && times.empty();
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
  tautline::WarpSession& session = *this->Session;
  session.settings = this->GetSettings();
  session.ownTimes.assign(steps.begin(), steps.end());
  std::vector<double> times = session.ownTimes;
  // Another process may have time steps; with any range set, all processes execute at each of them.
  const bool unknown =
    times.empty() && session.overTime() && tautline::severalProcesses() != nullptr;
  for (int port = 0; unknown && port < NumberOfOutputPorts; ++port)
  {
    const double range[2] = { 0, 0 };
    outputVector->GetInformationObject(port)->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  if (this->PlaysMotion(times))
  {
    for (int i = 0; i <= this->AnimationSteps; ++i)
    {
      times.push_back(static_cast<double>(i) / this->AnimationSteps);
    }
  }
  for (int port = 0; !times.empty() && port < NumberOfOutputPorts; ++port)
  {
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
  tautline::WarpSession& session = *this->Session;
  session.settings = this->GetSettings();
  if (!session.looping)
  {
    session.agreeOnTimes(session.overTime() || this->Animation);
  }
  if (!session.sequence())
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
  std::optional<double> time;
  for (int port = 0; port < NumberOfOutputPorts; ++port)
  {
    vtkInformation* info = outputVector->GetInformationObject(port);
    if (info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      time = info->Get(Pipeline::UPDATE_TIME_STEP());
      break;
    }
  }
  session.plan(time, upstream, this->GetMTime());
  for (int port : { int(MeshPort), int(TargetPort) })
  {
    for (int i = 0; i < inputVector[port]->GetNumberOfInformationObjects(); ++i)
    {
      inputVector[port]->GetInformationObject(i)->Set(
        Pipeline::UPDATE_TIME_STEP(), session.times[session.current]);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshWarp::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  tautline::WarpSession& session = *this->Session;
  session.settings = this->GetSettings();
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  vtkDataObject* target = vtkDataObject::GetData(inputVector[TargetPort]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector, MeshPort);
  vtkInformation* requested = outputVector->GetInformationObject(MeshPort);
  const bool plays =
    this->PlaysMotion(session.times) && requested->Has(Pipeline::UPDATE_TIME_STEP());
  const double time = plays ? requested->Get(Pipeline::UPDATE_TIME_STEP()) : 1.0;
  session.settings.amount *= std::clamp(time, 0.0, 1.0);
  tautline::TableRows history, statistics;
  tautline::WarpTotals totals;
  this->ClearNumbers();
  std::string failure = FailureOf("choose conjugate gradients with BoomerAMG (Automatic Solver "
                                  "off), or warp the mesh in parts",
    [&]
    {
      session.requireSameTimes();
      if (session.piecewise && !this->WorksOnPieces())
      {
        session.beginGathered(); // different from the first time step
        return;
      }
      const auto moved =
        tautline::markSelected(input, vtkSelection::GetData(inputVector[MovedPort]));
      if (this->WorksOnPieces())
      {
        if (!session.sequence())
        {
          session.clear();
        }
        tautline::TableRows unused; // otherwise tables of several processes would be joined
        this->ForEachBlock(inputVector, outputVector, nullptr, FixedPort, false,
          [&](const tautline::InputBlock& block)
          {
            tautline::warpPieces(session, *this->MakeMesh(block, false), block, moved,
              this->IsFirst() ? history : unused, this->IsFirst() ? statistics : unused, totals);
          });
        return;
      }
      this->ForEachBlock(inputVector, outputVector, nullptr, FixedPort, false,
        [&](const tautline::InputBlock& block)
        { session.visit(block, target, moved, history, statistics, totals); });
      session.forgetFrom(this->GetNumberOfBlocks());
    });
  if (!failure.empty())
  {
    request->Remove(Pipeline::CONTINUE_EXECUTING());
    session.clear();
    return this->Fail(outputVector, failure);
  }
  session.begun = session.sequence() && !session.startsAgain;
  // The result needs time steps before the requested one: repeats with the next of them.
  if (session.sequence() && (session.startsAgain || session.current < session.requested))
  {
    session.looping = true;
    session.current = session.startsAgain ? 0
      : this->StartFrom == PREVIOUS_STEP  ? session.current + 1
                                          : session.requested;
    session.startsAgain = false;
    request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    return 1;
  }
  if (session.looping)
  {
    session.looping = false;
    request->Remove(Pipeline::CONTINUE_EXECUTING());
  }
  if (session.sequence() || plays)
  {
    output->GetInformation()->Set(
      vtkDataObject::DATA_TIME_STEP(), plays ? time : session.times[session.requested]);
  }
  history.fill(vtkTable::GetData(outputVector, HistoryPort));
  statistics.fill(vtkTable::GetData(outputVector, StatisticsPort));
  this->Summary = totals.summary;
  this->AddToSummary(this->GetBlockNotice());
  this->AddToSummary(this->GetWhyGathered());
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
void vtkMeshWarp::ClearResult()
{
  this->ClearNumbers();
  this->Session->clear();
}

//------------------------------------------------------------------------------
void vtkMeshWarp::ClearNumbers()
{
  this->Summary.clear();
  this->InvertedAfterWarp = this->Inverted = this->Impossible = 0;
  this->WorstShape = 0.0;
  this->Reused = 0;
}

//------------------------------------------------------------------------------
bool vtkMeshWarp::ExecutesAgain() const
{
  return this->Session->looping;
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshWarp::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::SameMesh;
  rules.joinsPartitions =
    rules.joinsPartitions && (!this->Session->sequence() || this->PartitionsHaveIds());
  return rules;
}

//------------------------------------------------------------------------------
bool vtkMeshWarp::TakesPieces(vtkInformationVector** inputs)
{
  this->DropPiece();
  tautline::WarpSession& session = *this->Session;
  session.settings = this->GetSettings();
  const bool sequence = session.sequence();
  if (sequence && session.begun && !session.piecewise)
  {
    return false; // as at the first time step
  }
  if (!sequence)
  {
    session.piecewise = session.gathers = false;
  }
  else if (!session.begun)
  {
    session.forgetFrom(0);
  }
  vtkDataObject* input = vtkDataObject::GetData(inputs[MeshPort]);
  vtkPointSet* first = sequence ? session.firstPiece(input) : nullptr;
  const bool toTarget = session.settings.motion == tautline::MotionSource::Target;
  const bool curved = tautline::minimumOverProcesses(tautline::hasCurvedCells(input) ? 0 : 1) == 0;
  const std::string why = sequence && session.gathers ? "its pieces change over time"
    : toTarget                                        ? "a motion to a target needs the whole mesh"
    : curved                                          ? "it has curved cells"
                                                      : "";
  const bool taken = this->TakePiece(first ? first : input, why);
  if (sequence && !session.begun)
  {
    session.piecewise = taken;
    if (!session.piecewise)
    {
      session.forgetFrom(0);
    }
  }
  return taken || (sequence && session.piecewise);
}

//------------------------------------------------------------------------------
void vtkMeshWarp::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->InvertedAfterWarp, this->Inverted, this->Impossible, this->WorstShape, this->Reused,
    this->Session->looping, this->Session->begun, this->Session->current);
}

//------------------------------------------------------------------------------
void vtkMeshWarp::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Motion: " << this->Motion << "\n";
  os << indent << "Amount: " << this->Amount << "\n";
  os << indent << "Animation: " << this->Animation << "\n";
  os << indent << "AnimationSteps: " << this->AnimationSteps << "\n";
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
}
