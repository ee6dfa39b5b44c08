#include "vtkMeshOptimizer.h"

#include "BeforeAfter.h"
#include "OptimizerSetup.h"

#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>

vtkStandardNewMacro(vtkMeshOptimizer);

namespace
{
enum Ports
{
  MeshPort = 0,
  ReferencePort = 1, // input
  SelectionPort = 2, // input
  HistoryPort = 1,
  StatisticsPort = 2,
  NumberOfPorts = 3
};

// More time steps than this are of no use to an animation.
constexpr int MostTimeSteps = 1000;

}

//------------------------------------------------------------------------------
vtkMeshOptimizer::vtkMeshOptimizer()
{
  this->SetNumberOfInputPorts(NumberOfPorts);
  this->SetNumberOfOutputPorts(NumberOfPorts);
}

//------------------------------------------------------------------------------
vtkMeshOptimizer::~vtkMeshOptimizer() = default;

//------------------------------------------------------------------------------
vtkMeshOptimizer::Row& vtkMeshOptimizer::RowAt(int index)
{
  this->Rows.resize(std::max(this->Rows.size(), static_cast<std::size_t>(index) + 1));
  return this->Rows[index];
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::AddObjective(int metric, int form, double weight, int target)
{
  try
  {
    tautline::metricInfo(static_cast<tautline::Metric>(metric)); // throws if there is none
    if (form < DEFAULT_TEMPLATE || form > MAXIMUM || target < IDEAL || target > TENSOR)
    {
      throw tautline::Error("There is no template " + std::to_string(form) + " or no target type " +
        std::to_string(target) + "; see the enumerations of vtkMeshOptimizer.");
    }
    this->RowAt(this->Objectives++) = { metric, form, weight, target };
    this->Preset = CUSTOM;
    this->Modified();
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::AddObjectiveByName(const char* metric, int form, double weight, int target)
{
  const tautline::MetricInfo* info = tautline::findMetric(metric ? metric : "");
  if (!info)
  {
    vtkErrorMacro(<< "There is no metric '" << (metric ? metric : "")
                  << "'. Element Quality and its help page list them.");
    return;
  }
  this->AddObjective(static_cast<int>(info->metric), form, weight, target);
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::RemoveAllObjectives()
{
  this->Rows.clear();
  this->Objectives = 0;
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::SetNumberOfObjectives(int count)
{
  if (count != this->Objectives && count >= 0)
  {
    this->RowAt(std::max(count - 1, 0));
    this->Objectives = count;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
template <class Value>
void vtkMeshOptimizer::SetPart(Value& part, Value value)
{
  if (part != value)
  {
    part = value;
    this->Modified();
  }
}

void vtkMeshOptimizer::SetMetric1(int metric)
{
  this->SetPart(this->RowAt(0).metric, metric);
}
void vtkMeshOptimizer::SetMetric2(int metric)
{
  this->SetPart(this->RowAt(1).metric, metric);
}
void vtkMeshOptimizer::SetMetric3(int metric)
{
  this->SetPart(this->RowAt(2).metric, metric);
}
void vtkMeshOptimizer::SetMetric4(int metric)
{
  this->SetPart(this->RowAt(3).metric, metric);
}
void vtkMeshOptimizer::SetTemplate1(int form)
{
  this->SetPart(this->RowAt(0).form, form);
}
void vtkMeshOptimizer::SetTemplate2(int form)
{
  this->SetPart(this->RowAt(1).form, form);
}
void vtkMeshOptimizer::SetTemplate3(int form)
{
  this->SetPart(this->RowAt(2).form, form);
}
void vtkMeshOptimizer::SetTemplate4(int form)
{
  this->SetPart(this->RowAt(3).form, form);
}
void vtkMeshOptimizer::SetWeight1(double weight)
{
  this->SetPart(this->RowAt(0).weight, weight);
}
void vtkMeshOptimizer::SetWeight2(double weight)
{
  this->SetPart(this->RowAt(1).weight, weight);
}
void vtkMeshOptimizer::SetWeight3(double weight)
{
  this->SetPart(this->RowAt(2).weight, weight);
}
void vtkMeshOptimizer::SetWeight4(double weight)
{
  this->SetPart(this->RowAt(3).weight, weight);
}
void vtkMeshOptimizer::SetTarget1(int target)
{
  this->SetPart(this->RowAt(0).target, target);
}
void vtkMeshOptimizer::SetTarget2(int target)
{
  this->SetPart(this->RowAt(1).target, target);
}
void vtkMeshOptimizer::SetTarget3(int target)
{
  this->SetPart(this->RowAt(2).target, target);
}
void vtkMeshOptimizer::SetTarget4(int target)
{
  this->SetPart(this->RowAt(3).target, target);
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::AddUtopia(double value)
{
  this->Utopia.push_back(value);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::RemoveAllUtopias()
{
  this->Utopia.clear();
  this->Modified();
}

//------------------------------------------------------------------------------
vtkTable* vtkMeshOptimizer::GetHistory()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(HistoryPort));
}

//------------------------------------------------------------------------------
vtkTable* vtkMeshOptimizer::GetStatistics()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(StatisticsPort));
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::FillInputPortInformation(int port, vtkInformation* info)
{
  tautline::declareInput(info, port == SelectionPort, port != MeshPort);
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == MeshPort ? "vtkDataObject" : "vtkTable");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::RequestDataObject(
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
int vtkMeshOptimizer::EffectiveIterations() const
{
  tautline::OptimizeOptions options;
  options.stopping.maximumIterations = this->MaximumIterations;
  tautline::applyPreset(static_cast<tautline::Preset>(this->Preset), options);
  return options.stopping.maximumIterations;
}

//------------------------------------------------------------------------------
std::vector<double> vtkMeshOptimizer::TimeSteps() const
{
  // How many there are is known after the run only; until then the last ones repeat the result.
  int last = 0;
  for (const auto& run : this->Runs)
  {
    last = std::max(last, run->iterations);
  }
  last = this->Runs.empty() ? this->EffectiveIterations() : last;
  const int step = 1 + (last - 1) / MostTimeSteps;
  std::vector<double> steps;
  for (int i = 0; i < last; i += step)
  {
    steps.push_back(i);
  }
  steps.push_back(last);
  return steps;
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  if (this->RunTime.GetMTime() < this->GetMTime())
  {
    this->Runs.clear();
  }
  if (this->Animation)
  {
    using Pipeline = vtkStreamingDemandDrivenPipeline;
    const std::vector<double> steps = this->TimeSteps();
    const double range[2] = { steps.front(), steps.back() };
    for (int port = 0; port < NumberOfPorts; ++port)
    {
      vtkInformation* info = outputVector->GetInformationObject(port);
      info->Set(Pipeline::TIME_STEPS(), steps.data(), static_cast<int>(steps.size()));
      info->Set(Pipeline::TIME_RANGE(), range, 2);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // The time asked for is an iteration, which means nothing upstream.
  for (int port = 0; this->Animation && port < NumberOfPorts; ++port)
  {
    for (int i = 0; i < inputVector[port]->GetNumberOfInformationObjects(); ++i)
    {
      inputVector[port]->GetInformationObject(i)->Remove(
        vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
bool vtkMeshOptimizer::HasRunFor(
  vtkDataObject* input, vtkDataObject* reference, vtkDataObject* selection)
{
  vtkMTimeType latest = this->GetMTime();
  for (vtkDataObject* data : { input, reference, selection })
  {
    latest = std::max(latest, data ? data->GetMTime() : 0);
  }
  return !this->Runs.empty() && this->RunTime.GetMTime() > latest;
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  vtkDataObject* reference = vtkDataObject::GetData(inputVector[ReferencePort]);
  auto* selection = vtkSelection::GetData(inputVector[SelectionPort]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector, MeshPort);
  vtkInformation* info = outputVector->GetInformationObject(MeshPort);
  const double time = this->Animation && info->Has(Pipeline::UPDATE_TIME_STEP())
    ? info->Get(Pipeline::UPDATE_TIME_STEP())
    : vtkMath::Nan();
  const bool done = this->HasRunFor(input, reference, selection);
  tautline::TableRows history, statistics;
  try
  {
    if (!done)
    {
      this->Runs.clear();
    }
    const auto selected = tautline::markSelected(input, selection);
    const double blocks = tautline::countBlocks(input);
    tautline::forEachBlock(input, reference, selected, output,
      [&](const tautline::InputBlock& block)
      {
        if (!done)
        {
          this->Runs.push_back(std::make_unique<Run>());
        }
        this->Improve(block, *this->Runs[block.number], !done, blocks, time, history, statistics);
      });
    this->RunTime.Modified();
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("Not enough memory: optimise the mesh in parts, or lower Animation Memory.");
    return this->Fail(output);
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    return this->Fail(output);
  }
  history.fill(vtkTable::GetData(outputVector, HistoryPort));
  statistics.fill(vtkTable::GetData(outputVector, StatisticsPort));
  this->Report();
  if (this->Animation)
  {
    this->RequestInformation(nullptr, inputVector, outputVector);
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(),
      vtkMath::IsNan(time) ? info->Get(Pipeline::TIME_RANGE())[1] : time);
  }
  else
  {
    for (const auto& run : this->Runs)
    {
      run->result.points = {};
    }
    this->RunTime = vtkTimeStamp();
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::Fail(vtkDataObject* output)
{
  output->Initialize();
  this->Runs.clear();
  this->Report();
  return 0;
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::Improve(const tautline::InputBlock& block, Run& run, bool optimize,
  double blocks, double time, tautline::TableRows& history, tautline::TableRows& statistics)
{
  block.output->ShallowCopy(block.input);
  if (block.input->GetNumberOfPoints() == 0 || block.input->GetNumberOfCells() == 0)
  {
    return;
  }
  Setup setup(this, block);
  const tautline::MeshView& view = setup.mesh.mesh().view();
  if (optimize)
  {
    const auto coordinates = static_cast<std::size_t>(3 * view.numberOfPoints);
    setup.options.observer = [&](const tautline::IterationState& state)
    {
      ++run.iterations; // -1 at the start, 0 for the input
      if (this->Animation)
      {
        run.keep(state, coordinates, this->AnimationMemory / blocks);
      }
      this->UpdateProgress((block.number + state.progress) / blocks);
      return !this->GetAbortExecute();
    };
    run.iterations = -1;
    run.result = tautline::optimize(setup.mesh.mesh(), setup.options);
    run.iterations = std::max(run.iterations, run.result.iterations);
  }
  const std::vector<double> points = run.at(time, view);
  const std::string note = setup.mesh.move(vtkPointSet::SafeDownCast(block.output), points);
  const auto metrics = tautline::measuredMetrics(setup.options.objectives);
  const std::string qualities = tautline::addBeforeAfter(
    setup.mesh, points, metrics, this->Threads, block.name, block.output, statistics);
  tautline::addHistory(
    history, run.result.history, tautline::objectiveNames(setup.options.objectives), block.name);
  if (optimize)
  {
    run.summary = tautline::summarize(run.result, setup.mesh, block.name) + qualities;
    for (const std::string& sentence : { note, setup.mesh.notice() })
    {
      run.summary += (sentence.empty() ? "" : "\n") + sentence;
    }
  }
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::Report()
{
  this->Reason.clear();
  this->StopReason = -1;
  this->Iterations = 0;
  this->FreePoints = this->InvertedBefore = this->InvertedAfter = 0;
  this->SurfaceError = 0;
  this->Summary.clear();
  for (const auto& run : this->Runs)
  {
    const tautline::OptimizeResult& result = run->result;
    if (run->summary.empty())
    {
      continue; // an empty block
    }
    this->StopReason = static_cast<int>(result.reason);
    this->Reason = tautline::describe(result.reason);
    this->Iterations = std::max(this->Iterations, result.iterations);
    this->FreePoints += result.freeVertices;
    this->InvertedBefore += result.invertedBefore;
    this->InvertedAfter += result.invertedAfter;
    this->SurfaceError = std::max(this->SurfaceError, result.surfaceError);
    this->Summary += (this->Summary.empty() ? "" : "\n") + run->summary;
  }
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Preset: " << this->Preset << "\n";
  for (int i = 0; i < this->Objectives; ++i)
  {
    const Row& row = this->Rows[i];
    os << indent << "Objective: metric " << row.metric << ", template " << row.form << ", weight "
       << row.weight << ", target " << row.target << "\n";
  }
  os << indent << "Power: " << this->Power << "\n";
  os << indent << "Combination: " << this->Combination << "\n";
  os << indent << "Beta: " << this->Beta << "\n";
  os << indent << "Scalarization: " << this->Scalarization << "\n";
  os << indent << "C: " << this->C << "\n";
  os << indent << "Exponent: " << this->Exponent << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Utopia values: " << this->Utopia.size() << "\n";
  os << indent << "Optimizer: " << this->Optimizer << "\n";
  os << indent << "MaximumIterations: " << this->MaximumIterations << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
  os << indent << "GradientNorm: " << this->GradientNorm << "\n";
  os << indent << "RelativeChange: " << this->RelativeChange << "\n";
  os << indent << "TwoDigits: " << this->TwoDigits << "\n";
  os << indent << "Reduction: " << this->Reduction << "\n";
  os << indent << "BestKnown: " << this->BestKnown << "\n";
  os << indent << "StopWhenValid: " << this->StopWhenValid << "\n";
  os << indent << "Boundary: " << this->Boundary << "\n";
  os << indent << "FlatAngle: " << this->FlatAngle << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "MaximumDisplacement: " << this->MaximumDisplacement << "\n";
  os << indent << "ProjectToSurface: " << this->ProjectToSurface << "\n";
  os << indent << "AllowInversion: " << this->AllowInversion << "\n";
  os << indent << "UntangleFirst: " << this->UntangleFirst << "\n";
  os << indent << "RescaleUntangling: " << this->RescaleUntangling << "\n";
  os << indent << "Culling: " << this->Culling << "\n";
  os << indent << "PatchIterations: " << this->PatchIterations << "\n";
  os << indent << "Relaxation: " << this->Relaxation << "\n";
  os << indent << "ImproveWorst: " << this->ImproveWorst << "\n";
  os << indent << "Animation: " << this->Animation << "\n";
  os << indent << "AnimationMemory: " << this->AnimationMemory << "\n";
  os << indent << "Threads: " << this->Threads << "\n";
  os << indent << "Summary: " << this->Summary << "\n";
}
