// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshOptimizer.h"

#include "BeforeAfter.h"
#include "ContentStamp.h"
#include "CurvedRun.h"
#include "GatheredExecution.h"
#include "IterationHistory.h"
#include "OptimizerSetup.h"
#include "PolyhedralMesh.h"
#include "Processes.h"
#include "ProgressStep.h"

#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>

vtkStandardNewMacro(vtkMeshOptimizer);

namespace
{
enum Ports
{
  StatisticsPort = 2,
  NumberOfInputPorts = 4,
  NumberOfPorts = 3
};

/// A surface that should not move may move by this fraction of the diagonal without a warning.
constexpr double LeastSurfaceMotion = 0.001;
constexpr const char* InvalidRemedy =
  " Free their points (Free Invalid Elements), or choose another Boundary.";
constexpr const char* FreedRemedy = " Choose another Boundary, or repair them manually.";
constexpr const char* SurfaceRemedy =
  " Set a Maximum Displacement, or a smaller Feature Angle, to keep it closer.";

// An animation does not benefit from more time steps.
constexpr int MaximumTimeSteps = 1000;
}

//------------------------------------------------------------------------------
vtkMeshOptimizer::vtkMeshOptimizer()
  : vtkMeshBoundaryAlgorithm(tautline::FixedArray, tautline::KindArray, tautline::RegionArray)
{
  this->DeclarePorts(NumberOfInputPorts, NumberOfPorts, { tautline::OptimizerPorts::Selection });
}

//------------------------------------------------------------------------------
vtkMeshOptimizer::~vtkMeshOptimizer() = default;

//------------------------------------------------------------------------------
tautline::ObjectiveRow& vtkMeshOptimizer::RowAt(int index)
{
  this->Rows.resize(std::max(this->Rows.size(), static_cast<std::size_t>(index) + 1));
  return this->Rows[index];
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::AddObjective(int metric, int objectiveTemplate, double weight, int target)
{
  try
  {
    tautline::metricInfo(static_cast<tautline::Metric>(metric)); // throws if it does not exist
    if (objectiveTemplate < DEFAULT_TEMPLATE || objectiveTemplate > MAXIMUM || target < IDEAL ||
      target > TENSOR)
    {
      throw tautline::Error("There is no template " + std::to_string(objectiveTemplate) +
        " or no target type " + std::to_string(target) +
        "; see the enumerations of vtkMeshOptimizer.");
    }
    this->RowAt(this->Objectives++) = { metric, objectiveTemplate, weight,
      static_cast<tautline::TargetType>(target) };
    this->Preset = CUSTOM;
    this->Modified();
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::AddObjectiveByName(
  const char* metric, int objectiveTemplate, double weight, int target)
{
  const tautline::MetricInfo* info = tautline::findMetric(metric ? metric : "");
  if (!info)
  {
    vtkErrorMacro(<< "There is no metric '" << (metric ? metric : "")
                  << "'. Element Quality and its help page list them.");
    return;
  }
  this->AddObjective(static_cast<int>(info->metric), objectiveTemplate, weight, target);
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::SetWorstMetric(int metric)
{
  try
  {
    if (metric != -1 && tautline::missingMetric(metric).empty())
    {
      tautline::metricInfo(static_cast<tautline::Metric>(metric)); // throws if it does not exist
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what()
                  << " -1 is automatic. Element Quality and its help page list the metrics.");
    return;
  }
  if (metric != this->WorstMetric)
  {
    this->WorstMetric = metric;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
std::string vtkMeshOptimizer::GetUserMetrics()
{
  return tautline::listUserMetrics();
}

//------------------------------------------------------------------------------
std::string vtkMeshOptimizer::FindSettingProblem() const
{
  std::string problem = tautline::missingMetric(this->WorstMetric);
  for (int i = 0; this->Preset == CUSTOM && i < this->Objectives && problem.empty(); ++i)
  {
    problem = tautline::missingMetric(this->Rows[i].metric);
  }
  return problem;
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::SetWorstMetricByName(const char* name)
{
  const tautline::MetricInfo* info = tautline::findMetric(name ? name : "");
  if (!info)
  {
    vtkErrorMacro(<< "There is no metric '" << (name ? name : "")
                  << "'. Element Quality and its help page list them.");
    return;
  }
  this->SetWorstMetric(static_cast<int>(info->metric));
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
void vtkMeshOptimizer::SetRowValue(Value& current, Value value)
{
  if (current != value)
  {
    current = value;
    this->Modified();
  }
}

void vtkMeshOptimizer::SetMetric1(int metric)
{
  this->SetRowValue(this->RowAt(0).metric, metric);
}
void vtkMeshOptimizer::SetMetric2(int metric)
{
  this->SetRowValue(this->RowAt(1).metric, metric);
}
void vtkMeshOptimizer::SetMetric3(int metric)
{
  this->SetRowValue(this->RowAt(2).metric, metric);
}
void vtkMeshOptimizer::SetMetric4(int metric)
{
  this->SetRowValue(this->RowAt(3).metric, metric);
}
void vtkMeshOptimizer::SetTemplate1(int objectiveTemplate)
{
  this->SetRowValue(this->RowAt(0).objectiveTemplate, objectiveTemplate);
}
void vtkMeshOptimizer::SetTemplate2(int objectiveTemplate)
{
  this->SetRowValue(this->RowAt(1).objectiveTemplate, objectiveTemplate);
}
void vtkMeshOptimizer::SetTemplate3(int objectiveTemplate)
{
  this->SetRowValue(this->RowAt(2).objectiveTemplate, objectiveTemplate);
}
void vtkMeshOptimizer::SetTemplate4(int objectiveTemplate)
{
  this->SetRowValue(this->RowAt(3).objectiveTemplate, objectiveTemplate);
}
void vtkMeshOptimizer::SetWeight1(double weight)
{
  this->SetRowValue(this->RowAt(0).weight, weight);
}
void vtkMeshOptimizer::SetWeight2(double weight)
{
  this->SetRowValue(this->RowAt(1).weight, weight);
}
void vtkMeshOptimizer::SetWeight3(double weight)
{
  this->SetRowValue(this->RowAt(2).weight, weight);
}
void vtkMeshOptimizer::SetWeight4(double weight)
{
  this->SetRowValue(this->RowAt(3).weight, weight);
}
void vtkMeshOptimizer::SetTarget1(int target)
{
  this->SetRowValue(this->RowAt(0).target, static_cast<tautline::TargetType>(target));
}
void vtkMeshOptimizer::SetTarget2(int target)
{
  this->SetRowValue(this->RowAt(1).target, static_cast<tautline::TargetType>(target));
}
void vtkMeshOptimizer::SetTarget3(int target)
{
  this->SetRowValue(this->RowAt(2).target, static_cast<tautline::TargetType>(target));
}
void vtkMeshOptimizer::SetTarget4(int target)
{
  this->SetRowValue(this->RowAt(3).target, static_cast<tautline::TargetType>(target));
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
vtkTable* vtkMeshOptimizer::GetStatistics()
{
  return this->GetOutputTable(StatisticsPort);
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::EffectiveIterations()
{
  return this->GetSettings().options.stopping.maximumIterations;
}

//------------------------------------------------------------------------------
std::vector<double> vtkMeshOptimizer::TimeSteps()
{
  // Their number is known only after the run; until then the last ones repeat the result.
  const int last = this->LastIteration < 0 ? this->EffectiveIterations() : this->LastIteration;
  const int step = 1 + (last - 1) / MaximumTimeSteps;
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
    this->LastIteration = -1;
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
  // The requested time is an iteration, which has no meaning upstream.
  for (int port = 0; this->Animation && port < NumberOfInputPorts; ++port)
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
vtkTypeBool vtkMeshOptimizer::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    // The data of this process, before they are gathered.
    std::vector<vtkDataObject*> data;
    for (int port = 0; port < NumberOfInputPorts; ++port)
    {
      data.push_back(vtkDataObject::GetData(inputs[port]));
    }
    tautline::ContentStamp content = tautline::contentStamp(data);
    this->InputsChanged = content != this->RunInputs;
    this->RunInputs = std::move(content);
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

//------------------------------------------------------------------------------
bool vtkMeshOptimizer::HasRun()
{
  return !this->InputsChanged && !this->Runs.empty() && this->RunTime.GetMTime() > this->GetMTime();
}

//------------------------------------------------------------------------------
tautline::OptimizerSettings vtkMeshOptimizer::GetSettings()
{
  tautline::OptimizerSettings settings;
  settings.preset = static_cast<tautline::Preset>(this->Preset);
  settings.objectives.assign(this->Rows.begin(), this->Rows.begin() + this->Objectives);
  settings.power = this->Power;
  settings.beta = this->Beta;
  settings.combination = static_cast<tautline::Combination>(this->Combination);
  settings.boundary = this->GetBoundaryProperties(nullptr);
  settings.boundary.projectToSurface = this->ProjectToSurface;
  settings.maximumDisplacement = this->MaximumDisplacement;
  settings.mergePoints = this->MergeCoincidentPoints;
  settings.targetArray = [this](int index, vtkDataSet* input)
  {
    tautline::ChosenArray chosen;
    chosen.array = this->GetInputArrayToProcess(index, input, chosen.association);
    return chosen;
  };
  tautline::OptimizeOptions& options = settings.options;
  if (this->Preset == CUSTOM)
  {
    options.scalarization.method = static_cast<tautline::Scalarization>(this->Scalarization);
    options.scalarization.c = this->C;
    options.scalarization.onPatches = this->PatchScalarization;
    options.scalarization.exponent = this->Exponent;
    options.scalarization.tolerance = this->Tolerance;
    options.scalarization.utopia = this->Utopia;
    options.optimizer = static_cast<tautline::Optimizer>(this->Optimizer);
    options.stopping.maximumIterations = this->MaximumIterations;
    options.stopping.gradientNorm = this->GradientNorm;
    options.stopping.relativeChange = this->RelativeChange;
    options.stopping.twoDigits = this->TwoDigits;
    options.stopping.reduction = this->Reduction;
    options.stopping.bestKnown = this->UseBestKnown ? this->BestKnown : vtkMath::Nan();
    options.stopping.allValid = this->StopWhenValid;
    options.rescaleUntangling = this->RescaleUntangling;
    options.culling = this->Culling;
    options.patchIterations = this->PatchIterations;
    options.relaxation = this->Relaxation;
    options.improveWorst = this->ImproveWorst;
  }
  tautline::applyPreset(settings.preset, options);
  settings.boundary.leaving = this->LeaveSurface && options.improveWorst > 0;
  options.holdWorst = this->HoldWorst;
  if (this->WorstMetric >= 0)
  {
    options.worstMetric = static_cast<tautline::Metric>(this->WorstMetric);
  }
  options.stopping.maximumSeconds = this->TimeLimit;
  options.surface.project = this->ProjectToSurface;
  options.allowInversion = this->AllowInversion;
  options.untangleFirst = this->UntangleFirst;
  options.threads = this->Threads;
  return settings;
}

//------------------------------------------------------------------------------
int vtkMeshOptimizer::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkDataObject* reference =
    vtkDataObject::GetData(inputVector[tautline::OptimizerPorts::Reference]);
  vtkInformation* info = outputVector->GetInformationObject(MeshPort);
  const double time = this->Animation && info->Has(Pipeline::UPDATE_TIME_STEP())
    ? info->Get(Pipeline::UPDATE_TIME_STEP())
    : vtkMath::Nan();
  vtkDataObject* geometry = vtkDataObject::GetData(inputVector[tautline::OptimizerPorts::Geometry]);
  const bool done = this->HasRun();
  if (!done)
  {
    this->Runs.clear();
  }
  this->SetProgressText(tautline::OptimizerName);
  tautline::TableRows history, statistics;
  const int succeeded =
    this->Attempt(outputVector, "optimize the mesh in parts, or reduce Animation Memory",
      [&]
      {
        tautline::OptimizerSettings settings = this->GetSettings();
        settings.boundary.geometry = geometry;
        this->ForEachBlock(inputVector, outputVector, reference,
          tautline::OptimizerPorts::Selection, this->Boundary != FIXED,
          [&](const tautline::InputBlock& block)
          {
            while (this->Runs.size() <= static_cast<std::size_t>(block.number))
            {
              this->Runs.push_back(std::make_unique<tautline::OptimizerRun>());
            }
            this->Optimize(
              settings, block, *this->Runs[block.number], done, time, history, statistics);
          });
      });
  if (!succeeded)
  {
    this->Runs.clear();
    this->Report();
    return 0;
  }
  this->RunTime.Modified();
  this->LastIteration = 0;
  for (const auto& run : this->Runs)
  {
    this->LastIteration = std::max(this->LastIteration, run->iterations);
  }
  history.fill(vtkTable::GetData(outputVector, HistoryPort));
  statistics.fill(vtkTable::GetData(outputVector, StatisticsPort));
  this->Report();
  for (const std::string& warning : this->ResultWarnings())
  {
    if (!done && this->IsFirst())
    {
      this->Warn(warning);
    }
  }
  this->AddToSummary(this->GetWhyGathered());
  if (this->Animation)
  {
    this->RequestInformation(nullptr, inputVector, outputVector);
    vtkDataObject::GetData(outputVector, MeshPort)
      ->GetInformation()
      ->Set(vtkDataObject::DATA_TIME_STEP(),
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
/// The mesh of a data set with curved cells; null for others.
std::unique_ptr<tautline::CurvedMotion> vtkMeshOptimizer::MakeCurved(
  const tautline::InputBlock& block)
{
  if (!tautline::hasCurvedCells(block.input))
  {
    return nullptr;
  }
  if (this->ReproducibleOrder)
  {
    throw tautline::Error("Curved cells do not support the reproducible order of several "
                          "processes: switch Reproducible Order off.");
  }
  return std::make_unique<tautline::CurvedMotion>(
    block, this->Threads, this->MergeCoincidentPoints);
}

//------------------------------------------------------------------------------
/// Makes the options report the iterations of a run, which must outlive them.
void vtkMeshOptimizer::Observe(
  tautline::OptimizerRun& run, int block, vtkIdType coordinates, tautline::OptimizeOptions& options)
{
  options.observer = [this, &run, block, coordinates](const tautline::IterationState& state)
  {
    ++run.iterations; // -1 at the start, 0 for the input
    if (this->Animation)
    {
      run.keep(state, static_cast<std::size_t>(coordinates),
        this->AnimationMemory / this->GetNumberOfBlocks());
    }
    const tautline::IterationRecord& record = state.record;
    this->ShowIteration(tautline::OptimizerName, record.iteration,
      { { "objective", record.objective },
        { "worst", record.worst.empty() ? vtkMath::Nan() : record.worst.front() } });
    return this->ProceedInBlock(
      block, std::max(state.progress, tautline::openEnded(record.iteration)));
  };
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::Optimize(const tautline::OptimizerSettings& settings,
  const tautline::InputBlock& block, tautline::OptimizerRun& run, bool done, double time,
  tautline::TableRows& history, tautline::TableRows& statistics)
{
  if (this->WorksOnPieces())
  {
    tautline::needOfWholeMesh(
      settings, tautline::choosesFeatures(settings.boundary, block.input), this->Animation)
      .refuse();
  }
  if (this->Preset == FINITE_VOLUMES)
  {
    this->ImproveFaces(settings, block, run, history, statistics);
    return;
  }
  const std::unique_ptr<tautline::CurvedMotion> curved = this->MakeCurved(block);
  const std::unique_ptr<tautline::MovableMesh> linear =
    curved ? nullptr : this->MakeMesh(block, true);
  tautline::MovableMesh& made = curved ? curved->corners() : *linear;
  const tautline::MovableMesh& mesh = made;
  tautline::OptimizerSetup setup(
    curved ? tautline::settingsOfCorners(settings) : settings, block, made);
  tautline::OptimizeOptions& options = setup.options();
  const tautline::MeshView& view = mesh.mesh().view();
  if (!done)
  {
    this->Observe(run, block.number, 3 * view.numberOfPoints, options);
    run.iterations = -1;
    options.stopping.maximumSeconds = this->GetRemainingSeconds();
    if (curved)
    {
      run.result = tautline::runCurved(settings, setup, *curved, block);
    }
    else
    {
      run.result = setup.run();
      setup.round(run);
    }
    this->Warn(run.warning);
    if (curved || &setup.boundary().start() != &mesh.mesh() || !mesh.frame().isIdentity())
    {
      run.result.elements = {};
    }
    run.iterations = std::max(run.iterations, run.result.iterations);
  }
  const std::vector<double> points = run.at(time, view);
  const bool ofResult = points == run.result.points;
  std::string note = ofResult ? run.note : std::string();
  if (ofResult && !curved)
  {
    mesh.move(vtkPointSet::SafeDownCast(block.output), points, run.single);
  }
  else
  {
    note = mesh.move(vtkPointSet::SafeDownCast(block.output), points);
  }
  const auto metrics = setup.metrics();
  if (this->ShowFeatures)
  {
    setup.boundary().addFeatures(block.output);
  }
  std::string qualities;
  if (!done && !ofResult)
  {
    // The summary describes the result, even if an earlier iteration is shown.
    tautline::TableRows rows;
    qualities = tautline::addBeforeAfter(
      mesh, run.result.points, metrics, {}, this->Threads, block.name, block.output, rows);
  }
  const tautline::VerifiedElements known =
    ofResult ? std::move(run.result.elements) : tautline::VerifiedElements();
  run.result.elements = {};
  tautline::TableRows unused; // otherwise tables of several processes would be joined
  const std::string shown = tautline::addBeforeAfter(mesh, points, metrics, known, this->Threads,
    block.name, block.output, this->IsFirst() ? statistics : unused);
  qualities = qualities.empty() ? shown : qualities;
  if (this->IsFirst())
  {
    tautline::addHistory(
      history, run.result.history, tautline::objectiveNames(options.objectives), block.name);
  }
  if (!done)
  {
    const double diagonal = block.input->GetLength();
    // Without a tolerance, any distance is allowed.
    const bool stays = settings.boundary.motion != tautline::BoundaryMotion::Free &&
      !settings.boundary.geometry && settings.boundary.surfaceTolerance > 0;
    const double allowed =
      std::max(LeastSurfaceMotion, settings.boundary.surfaceTolerance) * diagonal;
    const bool moved = stays && run.result.surfaceError > allowed;
    run.moved = moved ? "The surface has moved by up to " +
        tautline::distanceText(run.result.surfaceError, diagonal) + "."
                      : "";
    run.summary = tautline::summarize(run.result, mesh, block.name, diagonal) + qualities;
    const std::string why = run.result.reason == tautline::StopReason::NoFreeVertices
      ? mesh.whyNoneIsFree(tautline::BoundaryRemedy)
      : std::string();
    for (const std::string& sentence :
      { why, setup.boundary().describeFeatures(), note, mesh.notice() })
    {
      run.summary += (sentence.empty() ? "" : "\n") + sentence;
    }
    this->Warn(mesh.coarseness());
  }
}

//------------------------------------------------------------------------------
/// The preset FINITE_VOLUMES.
void vtkMeshOptimizer::ImproveFaces(const tautline::OptimizerSettings& settings,
  const tautline::InputBlock& block, tautline::OptimizerRun& run, tautline::TableRows& history,
  tautline::TableRows& statistics)
{
  using namespace tautline;
  if (this->Animation || this->WorksOnPieces())
  {
    throw Error("The preset Finite volumes does not support an animation or the reproducible order "
                "of several processes: switch them off.");
  }
  PolyhedralMesh mesh(block, this->Threads);
  ImproveFacesOptions options;
  options.angle = this->NonOrthogonality;
  options.skewness = this->Skewness;
  options.maximumSeconds = this->GetRemainingSeconds();
  options.proceed = [this, &block](int round, double fraction)
  {
    this->ShowIteration(OptimizerName, round, {});
    return this->ProceedInBlock(block.number, fraction);
  };
  const ImproveFacesResult result = mesh.improve(settings.boundary, options);
  mesh.move(vtkPointSet::SafeDownCast(block.output), result);
  mesh.addMeasures(vtkPointSet::SafeDownCast(block.output), result);
  run.result.reason = result.reason;
  run.result.iterations = run.iterations = result.iterations;
  run.result.freeVertices = result.freePoints;
  run.result.invertedBefore = result.before[MeshCheckKind::PyramidVolume].offending;
  run.result.invertedAfter = result.after[MeshCheckKind::PyramidVolume].offending;
  run.summary = (block.name.empty() ? "" : block.name + ": ") + summarize(result) +
    (mesh.notice().empty() ? "" : "\n" + mesh.notice());
  const auto addRow = [&](Index wanting, Index inverted)
  {
    history.begin(block.name);
    history.add("Objective", static_cast<double>(wanting));
    history.add("Inverted", static_cast<double>(inverted));
  };
  addRow(result.wantingBefore, run.result.invertedBefore);
  addRow(result.wantingAfter, run.result.invertedAfter);
  for (std::size_t i = 0; i < result.after.checks.size(); ++i)
  {
    const MeshCheck &before = result.before.checks[i], &after = result.after.checks[i];
    statistics.begin(block.name);
    statistics.addText("Metric", after.name);
    statistics.addText("Label", after.label);
    statistics.add("OffendingBefore", static_cast<double>(before.offending));
    statistics.add("OffendingAfter", static_cast<double>(after.offending));
    statistics.add("MinimumBefore", before.least);
    statistics.add("MinimumAfter", after.least);
    statistics.add("MaximumBefore", before.most);
    statistics.add("MaximumAfter", after.most);
  }
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshOptimizer::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::SameMesh;
  return rules;
}

//------------------------------------------------------------------------------
bool vtkMeshOptimizer::TakesPieces(vtkInformationVector** inputs)
{
  const auto onAny = [](bool here) { return tautline::minimumOverProcesses(here ? 0 : 1) == 0; };
  this->InputsChanged = onAny(this->InputsChanged);
  // A mesh that must be gathered is not redistributed first.
  tautline::OptimizerSettings settings = this->GetSettings();
  settings.boundary.geometry = vtkDataObject::GetData(inputs[tautline::OptimizerPorts::Geometry]);
  vtkDataObject* input = vtkDataObject::GetData(inputs[MeshPort]);
  const bool features =
    onAny(tautline::choosesFeatures(settings.boundary, vtkDataSet::SafeDownCast(input)));
  const std::string what = this->Preset == FINITE_VOLUMES ? "measures of finite volumes"
    : onAny(tautline::hasCurvedCells(input))
    ? "curved cells"
    : tautline::needOfWholeMesh(settings, features, this->Animation).what;
  return this->TakePiece(input, what.empty() ? "" : what + " need the whole mesh");
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->Reason, this->StopReason, this->Iterations, this->FreePoints, this->InvertedBefore,
    this->InvertedAfter, this->SurfaceError, this->LastIteration);
  if (this->Animation)
  {
    this->RunTime.Modified();
    // All processes announce the same time steps.
    this->RequestInformation(nullptr, nullptr, this->GetExecutive()->GetOutputInformation());
  }
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::ClearResult()
{
  this->Runs.clear();
  this->LastIteration = -1;
  this->Report();
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
    this->AddToSummary(run->summary);
  }
  for (const std::string& warning : this->ResultWarnings())
  {
    this->Summary.insert(0, tautline::WarningPrefix + warning + "\n");
  }
  if (!this->Runs.empty())
  {
    this->AddToSummary(this->GetBlockNotice());
  }
}

//------------------------------------------------------------------------------
std::vector<std::string> vtkMeshOptimizer::ResultWarnings() const
{
  std::vector<std::string> warnings;
  for (const auto& run : this->Runs)
  {
    if (!run->moved.empty())
    {
      warnings.push_back(run->moved + SurfaceRemedy);
      break;
    }
  }
  // The last one is shown first.
  if (this->InvertedAfter > 0)
  {
    warnings.push_back(tautline::invalidSentence(this->InvertedBefore, this->InvertedAfter) +
      (this->FreeInvalid ? FreedRemedy : InvalidRemedy));
  }
  return warnings;
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Preset: " << this->Preset << "\n";
  os << indent << "NonOrthogonality: " << this->NonOrthogonality << "\n";
  os << indent << "Skewness: " << this->Skewness << "\n";
  for (int i = 0; i < this->Objectives; ++i)
  {
    const tautline::ObjectiveRow& row = this->Rows[i];
    os << indent << "Objective: metric " << row.metric << ", template " << row.objectiveTemplate
       << ", weight " << row.weight << ", target " << static_cast<int>(row.target) << "\n";
  }
  os << indent << "Power: " << this->Power << "\n";
  os << indent << "Combination: " << this->Combination << "\n";
  os << indent << "Beta: " << this->Beta << "\n";
  os << indent << "Scalarization: " << this->Scalarization << "\n";
  os << indent << "C: " << this->C << "\n";
  os << indent << "PatchScalarization: " << this->PatchScalarization << "\n";
  os << indent << "Exponent: " << this->Exponent << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Utopia values: " << this->Utopia.size() << "\n";
  os << indent << "Optimizer: " << this->Optimizer << "\n";
  os << indent << "MaximumIterations: " << this->MaximumIterations << "\n";
  os << indent << "GradientNorm: " << this->GradientNorm << "\n";
  os << indent << "RelativeChange: " << this->RelativeChange << "\n";
  os << indent << "TwoDigits: " << this->TwoDigits << "\n";
  os << indent << "Reduction: " << this->Reduction << "\n";
  os << indent << "UseBestKnown: " << this->UseBestKnown << "\n";
  os << indent << "BestKnown: " << this->BestKnown << "\n";
  os << indent << "StopWhenValid: " << this->StopWhenValid << "\n";
  os << indent << "LeaveSurface: " << this->LeaveSurface << "\n";
  os << indent << "MaximumDisplacement: " << this->MaximumDisplacement << "\n";
  os << indent << "ProjectToSurface: " << this->ProjectToSurface << "\n";
  os << indent << "AllowInversion: " << this->AllowInversion << "\n";
  os << indent << "UntangleFirst: " << this->UntangleFirst << "\n";
  os << indent << "RescaleUntangling: " << this->RescaleUntangling << "\n";
  os << indent << "Culling: " << this->Culling << "\n";
  os << indent << "PatchIterations: " << this->PatchIterations << "\n";
  os << indent << "Relaxation: " << this->Relaxation << "\n";
  os << indent << "ImproveWorst: " << this->ImproveWorst << "\n";
  os << indent << "WorstMetric: " << this->WorstMetric << "\n";
  os << indent << "HoldWorst: " << this->HoldWorst << "\n";
  os << indent << "ReproducibleOrder: " << this->ReproducibleOrder << "\n";
  os << indent << "Animation: " << this->Animation << "\n";
  os << indent << "AnimationMemory: " << this->AnimationMemory << "\n";
}
