// SPDX-License-Identifier: BSD-3-Clause
// Optimize Mesh for a mesh on several processes, and in the order that does not depend on these.
#include "vtkMeshOptimizer.h"

#include "BeforeAfter.h"
#include "IterationHistory.h"
#include "OptimizerSetup.h"
#include "ProcessGroup.h"
#include "Processes.h"
#include "ProgressStep.h"
#include "GatheredExecution.h"
#include "RankMesh.h"
#include "TargetChoice.h"
#include "tautline/Objectives/ObjectiveSum.h"
#include "tautline/Optimization/Optimize.h"

#include "vtkDataSet.h"
#include "vtkExecutive.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

namespace
{
/// Whether an array of the input is chosen; also one that is missing, which others report.
bool isChosen(const tautline::OptimizerSettings& settings, int index, vtkDataSet* input)
{
  try
  {
    return input && input->GetNumberOfPoints() > 0 &&
      tautline::chosenArray(settings.arrays, index, input, "");
  }
  catch (const tautline::Error&)
  {
    return true;
  }
}

/// Whether something is true on any process. Collective.
bool onAny(bool here)
{
  return tautline::minimumOverProcesses(here ? 0 : 1) == 0;
}

/// Whether the objectives have targets of a reference mesh.
bool hasReference(const tautline::OptimizerSettings& settings)
{
  const auto& rows = settings.objectives;
  return settings.preset == tautline::Preset::PreserveShape ||
    (settings.preset == tautline::Preset::Custom &&
      std::any_of(rows.begin(), rows.end(),
        [](const tautline::ObjectiveRow& row)
        { return row.target == tautline::TargetType::Reference; }));
}

/**
 * @brief Why settings need the whole mesh in one place, if they do; `what` is a plural.
 * @param features whether feature kinds or regions are chosen, on any process
 */
tautline::NeedOfWholeMesh needOf(const tautline::OptimizerSettings& settings, bool features)
{
  using tautline::BoundaryMotion;
  if (settings.boundary == BoundaryMotion::OnSurface || settings.geometry)
  {
    return { "points that slide on curved surfaces and geometries",
      "choose the Boundary Fixed, Slide on flat parts (sliding) or Free, without a Geometry" };
  }
  if (features)
  {
    return { "regions and feature kinds", "choose None for these arrays" };
  }
  if (hasReference(settings))
  {
    return { "targets of a reference mesh", "choose another preset or target" };
  }
  if (settings.showFeatures)
  {
    return { "features that are shown", "switch Show Features off" };
  }
  tautline::OptimizeOptions options = settings.options;
  options.objectives = settings.preset == tautline::Preset::Custom
    ? tautline::customObjectives(settings)
    : options.objectives;
  return tautline::needOfWholeMesh(options);
}

constexpr const char* timeSteps = "iterations that are kept as time steps";

/// Throws Error for settings that need the whole mesh in one place, in its own order.
void requireLocalSettings(
  const tautline::OptimizerSettings& settings, bool features, bool animation)
{
  tautline::NeedOfWholeMesh need = animation
    ? tautline::NeedOfWholeMesh{ timeSteps, "switch Animation off" }
    : needOf(settings, features);
  if (!need.what.empty())
  {
    need.what[0] = static_cast<char>(std::toupper(need.what[0]));
    throw tautline::Error(need.what +
      " need one process and its own order: gather the mesh, in ParaView by Aggregate Dataset, "
      "with Reproducible Order off; or " +
      need.remedy + ".");
  }
}

/// Weights and targets of the local cells, and targets of the cells of the piece.
struct ElementOptions
{
  using ByType = std::array<tautline::Targets, 4>;
  std::vector<double> weights;
  ByType targets, targetsOfPiece;
};

/// The local cells, or those of the piece, where they are in the input.
tautline::Mesh inputOf(const tautline::RankMesh& mesh, const tautline::MeshView& view, int threads)
{
  tautline::Mesh input(view, threads);
  input.setMirrored(mesh.mirrored());
  return input;
}

/// What is measured on the cells of the piece, with their targets instead of those of local cells.
std::vector<tautline::MeasuredMetric> metricsOfPiece(
  const tautline::OptimizeOptions& options, const ElementOptions& elements)
{
  std::vector<tautline::MeasuredMetric> metrics =
    tautline::measuredMetrics(options, options.worstMetric.value_or(options.objectives[0].metric));
  for (tautline::MeasuredMetric& metric : metrics)
  {
    const tautline::Targets*& targets = metric.options.targets;
    targets = targets ? &elements.targetsOfPiece[targets - elements.targets.data()] : nullptr;
  }
  return metrics;
}

/// Compares the sizes of elements with their mean in the whole mesh.
void keepTotalSize(tautline::RankGroup& group, const tautline::RankMesh& mesh,
  ElementOptions& elements, tautline::OptimizeOptions& options)
{
  const tautline::DistributedMesh& local = mesh.mesh();
  std::vector<double> own;
  std::vector<double> sizes(local.view().numberOfCells);
  std::vector<signed char> validity(sizes.size());
  if (!sizes.empty())
  {
    const tautline::Mesh whole = inputOf(mesh, local.view(), options.threads);
    tautline::EvaluationOptions evaluation;
    evaluation.threads = options.threads;
    tautline::evaluateMetric(whole, tautline::Metric::Size, evaluation, sizes.data());
    whole.classifyCells(validity.data(), options.threads);
  }
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    if (local.ownedCells()[i] && validity[i] == tautline::Valid)
    {
      own.push_back(sizes[i]);
    }
  }
  const double total = group.orderlessSum(own);
  const auto valid = group.sum(static_cast<tautline::Index>(own.size()));
  constexpr auto size = static_cast<std::size_t>(tautline::TargetType::Size);
  tautline::compareSizesWith(inputOf(mesh, mesh.piece(), options.threads), total, valid,
    elements.targetsOfPiece[size], options);
  tautline::compareSizesWith(
    inputOf(mesh, local.view(), options.threads), total, valid, elements.targets[size], options);
}

/// Targets of a type, from the arrays of the pieces; null for the ideal one.
const tautline::Targets* targetOf(const tautline::OptimizerSettings& settings, vtkDataSet* input,
  const tautline::RankMesh& mesh, tautline::TargetType type, ElementOptions& elements)
{
  using tautline::TargetType;
  if (type == TargetType::Ideal)
  {
    return nullptr;
  }
  const auto number = static_cast<std::size_t>(type);
  const int threads = settings.options.threads;
  std::vector<double> ofPiece;
  tautline::TargetChoice choice;
  choice.type = type;
  if (input->GetNumberOfCells() > 0)
  {
    const bool size = type == TargetType::Size;
    (size ? choice.size : choice.tensor) =
      settings.targetArray(size ? tautline::SizeArray : tautline::TensorArray, input);
    ofPiece = tautline::targetValues(mesh.piece(), choice);
  }
  // First, so that errors have the numbers of the input's cells.
  elements.targetsOfPiece[number] =
    tautline::targetsOf(inputOf(mesh, mesh.piece(), threads), type, ofPiece);
  const std::vector<double> values = mesh.ofCells(ofPiece, tautline::targetComponents(type));
  elements.targets[number] =
    tautline::targetsOf(inputOf(mesh, mesh.mesh().view(), threads), type, values);
  return &elements.targets[number];
}

/// The objectives, with what they need of the local cells.
void setObjectives(const tautline::OptimizerSettings& settings, tautline::RankGroup& group,
  vtkDataSet* input, const tautline::RankMesh& mesh, ElementOptions& elements,
  tautline::OptimizeOptions& options)
{
  if (settings.preset == tautline::Preset::UniformSize &&
    settings.boundary == tautline::BoundaryMotion::Free)
  {
    keepTotalSize(group, mesh, elements, options);
  }
  if (settings.preset == tautline::Preset::Custom)
  {
    options.objectives = tautline::customObjectives(settings);
    for (std::size_t i = 0; i < settings.objectives.size(); ++i)
    {
      options.objectives[i].evaluation.targets =
        targetOf(settings, input, mesh, settings.objectives[i].target, elements);
    }
  }
  std::vector<double> weights;
  if (input->GetNumberOfCells() > 0)
  {
    weights = tautline::scalarsOf(tautline::chosenArray(settings.arrays, tautline::WeightArray,
                                    input, "of element weights", tautline::ArrayOf::Cells),
      "weights");
  }
  for (std::size_t cell = 0; cell < weights.size(); ++cell)
  {
    if (!mesh.skipped()[cell])
    {
      tautline::requireElementWeight(static_cast<tautline::Index>(cell), weights[cell]);
    }
  }
  const bool weighted = group.any(!weights.empty());
  elements.weights = weighted ? mesh.ofCells(weights, 1) : weights;
  elements.weights.reserve(1); // not null, also without cells
  for (tautline::Objective& objective : options.objectives)
  {
    objective.evaluation.threads = options.threads;
    objective.elementWeights = weighted ? elements.weights.data() : nullptr;
  }
}

/// What holds and limits the points of a mesh on several processes.
struct PointOptions
{
  std::vector<unsigned char> fixed;
  tautline::BoundaryShape shape;
  std::vector<double> limits;
};

/// Reads the arrays of the piece; empty pieces have none.
std::vector<double> readArrays(const tautline::OptimizerSettings& settings, vtkDataSet* input,
  vtkSelection* selection, tautline::RankMesh& mesh)
{
  if (input->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const auto chosen = [&](int index, const char* purpose)
  {
    return tautline::chosenArray(settings.arrays, index, input, purpose, tautline::ArrayOf::Points);
  };
  mesh.fix(chosen(tautline::FixedArray, "of fixed points"), false);
  mesh.fixSelected(input, selection);
  std::vector<double> limits =
    tautline::scalarsOf(chosen(tautline::LimitArray, "of limits"), "limits");
  for (double& limit : limits)
  {
    limit = limit < 0 ? std::numeric_limits<double>::infinity() : limit;
  }
  return limits;
}

PointOptions pointOptions(const tautline::OptimizerSettings& settings, tautline::RankGroup& group,
  vtkDataSet* input, vtkSelection* selection, tautline::RankMesh& mesh)
{
  PointOptions result;
  std::vector<double> limits;
  limits = readArrays(settings, input, selection, mesh);
  result.fixed = mesh.fixed(settings.boundary == tautline::BoundaryMotion::Fixed);
  const double any = std::numeric_limits<double>::infinity();
  if (group.any(!limits.empty()))
  {
    result.limits = mesh.leastOf(limits, any);
  }
  else if (settings.maximumDisplacement > 0)
  {
    result.limits.assign(mesh.mesh().localPoints(), settings.maximumDisplacement);
  }
  if (settings.boundary == tautline::BoundaryMotion::Sliding)
  {
    const tautline::Mesh local(mesh.mesh().view(), settings.options.threads);
    result.shape =
      tautline::boundaryShape(local, settings.flatAngle, 0.0, tautline::Ranks(mesh.mesh()));
    for (std::size_t p = 0; p < result.fixed.size(); ++p)
    {
      result.fixed[p] |= result.shape.fixed[p];
    }
    mesh.mesh().exchange(result.fixed.data());
    for (std::size_t i = 0; i < 3 * result.fixed.size(); ++i)
    {
      if (result.fixed[i / 3])
      {
        result.shape.planes[i] = result.shape.lines[i] = 0;
      }
    }
  }
  return result;
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
  this->Pieces.reset();
  this->Group.reset();
  this->InputsChanged = onAny(this->InputsChanged);
  // What needs the whole mesh is not divided first.
  tautline::OptimizerSettings settings = this->GetSettings();
  settings.geometry = vtkDataObject::GetData(inputs[tautline::OptimizerPorts::Geometry]);
  vtkDataObject* data = vtkDataObject::GetData(inputs[MeshPort]);
  auto* input = vtkDataSet::SafeDownCast(data);
  const bool features = onAny(isChosen(settings, tautline::KindArray, input) ||
    isChosen(settings, tautline::RegionArray, input));
  const std::string what = this->Animation ? timeSteps : needOf(settings, features).what;
  std::string why = what.empty() ? "" : what + " need the whole mesh";
  if (what.empty())
  {
    this->Pieces = tautline::takePieces(this->Group, data, this->Threads,
      this->MergeCoincidentPoints, static_cast<tautline::Redistribution>(this->Redistribute), &why);
  }
  else if (!tautline::isScattered(data))
  {
    why.clear(); // it is in one place
  }
  this->WhyGathered = tautline::gatheredSentence(why);
  return this->Pieces != nullptr;
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
void vtkMeshOptimizer::OptimizeOnRanks(vtkInformationVector** inputVector, vtkDataObject* output,
  tautline::TableRows& history, tautline::TableRows& statistics)
{
  const std::unique_ptr<tautline::RankMesh> pieces = std::move(this->Pieces);
  const auto group = pieces ? std::move(this->Group) : tautline::makeProcessGroup();
  this->Runs.clear();
  vtkDataSet* input = nullptr;
  tautline::OptimizerSettings settings = this->GetSettings();
  settings.geometry = vtkDataObject::GetData(inputVector[tautline::OptimizerPorts::Geometry]);
  tautline::OptimizeOptions& options = settings.options;
  input = tautline::requirePiece(vtkDataObject::GetData(inputVector[MeshPort]));
  const bool features = isChosen(settings, tautline::KindArray, input) ||
    isChosen(settings, tautline::RegionArray, input);
  requireLocalSettings(settings, features, this->Animation);
  std::unique_ptr<tautline::RankMesh> alone;
  if (!pieces)
  {
    alone = std::make_unique<tautline::RankMesh>(
      *group, input, this->Threads, this->MergeCoincidentPoints);
  }
  tautline::RankMesh& mesh = pieces ? *pieces : *alone;
  output->ShallowCopy(input);
  ElementOptions elements;
  setObjectives(settings, *group, input, mesh, elements, options);
  const PointOptions points = pointOptions(settings, *group, input,
    vtkSelection::GetData(inputVector[tautline::OptimizerPorts::Selection]), mesh);
  options.fixed = points.fixed.data();
  options.limits = points.limits.empty() ? nullptr : points.limits.data();
  if (!points.shape.planes.empty())
  {
    options.slidePlanes = points.shape.planes.data();
    options.slideLines = points.shape.lines.data();
  }
  options.stopping.maximumSeconds = this->GetRemainingSeconds();
  options.observer = [&](const tautline::IterationState& state)
  {
    const tautline::IterationRecord& record = state.record;
    this->ShowIteration(tautline::OptimizerName, record.iteration,
      { { "objective", record.objective },
        { "worst", record.worst.empty() ? vtkMath::Nan() : record.worst.front() } });
    return this->Proceed(std::max(state.progress, tautline::openEnded(record.iteration)));
  };
  this->Runs.push_back(std::make_unique<tautline::OptimizerRun>());
  tautline::OptimizerRun& run = *this->Runs.back();
  run.result = tautline::optimize(
    tautline::localMesh(mesh.mesh(), mesh.mirrored()), options, {}, tautline::Ranks(mesh.mesh()));
  run.iterations = run.result.iterations;
  tautline::roundOnRanks(mesh, options, run);
  mesh.move(vtkPointSet::SafeDownCast(output), run.result.points, run.single);
  tautline::TableRows rows;
  const std::string qualities =
    tautline::addBeforeAfterOnRanks(*group, mesh, mesh.ofPiece(run.result.points),
      metricsOfPiece(options, elements), this->Threads, vtkDataSet::SafeDownCast(output), rows);
  run.summary =
    tautline::summarize(run.result, mesh.mesh().globalPoints(), mesh.mesh().globalCells(), "") +
    qualities;
  const std::string why = run.result.reason == tautline::StopReason::NoFreeVertices
    ? mesh.whyNoneIsFree(settings.boundary == tautline::BoundaryMotion::Fixed,
        settings.boundary == tautline::BoundaryMotion::Sliding, tautline::BoundaryRemedy)
    : std::string();
  for (const std::string& sentence : { why, run.note, mesh.notice() })
  {
    run.summary += (sentence.empty() ? "" : "\n") + sentence;
  }
  if (group->rank() == 0)
  {
    // Tables of several processes would be joined.
    statistics = rows;
    tautline::addHistory(
      history, run.result.history, tautline::objectiveNames(options.objectives), "");
  }
}
