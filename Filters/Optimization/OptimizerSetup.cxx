// SPDX-License-Identifier: BSD-3-Clause
#include "OptimizerSetup.h"

#include "tautline/Objectives/ObjectiveSum.h"
#include "tautline/Optimization/QualityGuard.h"
#include "tautline/Optimization/RoundedResult.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace tautline
{
//------------------------------------------------------------------------------
OptimizerSetup::OptimizerSetup(
  const OptimizerSettings& settings, const InputBlock& block, MovableMesh& mesh)
  : TheMesh(mesh)
  , Boundary(settings.boundary, block, mesh)
  , Options(settings.options)
{
  static_cast<BoundaryConstraints&>(this->Options) = this->Boundary.constraints();
  this->setLimits(settings, block);
  if (this->Options.limits)
  {
    this->Options.leaving = nullptr;
  }
  this->setObjectives(settings, block);
}

//------------------------------------------------------------------------------
void OptimizerSetup::setLimits(const OptimizerSettings& settings, const InputBlock& block)
{
  vtkDataArray* array =
    chosenArray(settings.boundary.arrays, LimitArray, block.input, "of limits", ArrayOf::Points);
  this->Limits = scalarsOf(array, "limits");
  for (double& limit : this->Limits)
  {
    limit = limit < 0 ? std::numeric_limits<double>::infinity() : limit;
  }
  const bool given =
    this->TheMesh.inPieces() ? this->TheMesh.group().any(!this->Limits.empty()) : array != nullptr;
  if (given)
  {
    // Merged points may move by the smallest of their limits.
    this->Limits = this->TheMesh.leastOf(this->Limits, std::numeric_limits<double>::infinity());
  }
  else if (settings.maximumDisplacement > 0)
  {
    this->Limits.assign(this->TheMesh.fixed().size(), settings.maximumDisplacement);
  }
  for (double& limit : this->Limits)
  {
    limit /= this->TheMesh.frame().unit();
  }
  this->Options.limits = this->Limits.empty() ? nullptr : this->Limits.data();
}

//------------------------------------------------------------------------------
const Targets* OptimizerSetup::target(
  const OptimizerSettings& settings, const InputBlock& block, TargetType type)
{
  const auto number = static_cast<std::size_t>(type);
  Targets& made = this->MadeTargets[number];
  if (type == TargetType::Ideal || this->HasTargets[number])
  {
    return type == TargetType::Ideal ? nullptr : &made;
  }
  this->HasTargets[number] = true;
  TargetChoice choice;
  choice.type = type;
  choice.reference = block.reference;
  const bool hasCells = block.input->GetNumberOfCells() > 0; // a piece may be empty
  if (hasCells && (type == TargetType::Size || type == TargetType::Tensor))
  {
    const bool size = type == TargetType::Size;
    (size ? choice.size : choice.tensor) =
      settings.targetArray(size ? SizeArray : TensorArray, block.input);
  }
  const MovableMesh& mesh = this->TheMesh;
  if (mesh.inPieces())
  {
    const std::vector<double> ofPiece =
      hasCells ? targetValues(mesh.piece(), choice) : std::vector<double>();
    // This comes first, so that errors refer to the input's cell numbers.
    this->TargetsOfPiece[number] = targetsOf(mesh.given(), type, ofPiece);
    made = targetsOf(mesh.local(), type, mesh.ofCells(ofPiece, targetComponents(type)));
    return &made;
  }
  made = makeTargets(mesh.given(), choice, this->Options.threads);
  // T has the size given in the coordinates of the input.
  scaleTargets(made, mesh.frame().unit());
  return &made;
}

//------------------------------------------------------------------------------
void OptimizerSetup::setObjectives(const OptimizerSettings& settings, const InputBlock& block)
{
  std::vector<Objective>& objectives = this->Options.objectives;
  if (settings.preset == Preset::UniformSize && settings.boundary.motion == BoundaryMotion::Free)
  {
    this->keepTotalSize();
  }
  this->setWeights(settings, block);
  if (settings.preset != Preset::Custom)
  {
    for (Objective& objective : objectives)
    {
      const auto family = metricInfo(objective.metric).family;
      if (settings.preset == Preset::PreserveShape && family == MetricFamily::Target)
      {
        objective.evaluation.targets = this->target(settings, block, TargetType::Reference);
      }
    }
  }
  else
  {
    objectives = customObjectives(settings);
    for (std::size_t i = 0; i < settings.objectives.size(); ++i)
    {
      objectives[i].evaluation.targets =
        this->target(settings, block, settings.objectives[i].target);
    }
  }
  for (Objective& objective : objectives)
  {
    this->setUnit(objective);
    objective.evaluation.threads = this->Options.threads;
    objective.elementWeights = this->Weights.capacity() > 0 ? this->Weights.data() : nullptr;
  }
}

//------------------------------------------------------------------------------
void OptimizerSetup::setWeights(const OptimizerSettings& settings, const InputBlock& block)
{
  if (block.input->GetNumberOfCells() > 0)
  {
    this->Weights = scalarsOf(chosenArray(settings.boundary.arrays, WeightArray, block.input,
                                "of element weights", ArrayOf::Cells),
      "weights");
  }
  if (!this->TheMesh.inPieces())
  {
    return;
  }
  for (std::size_t cell = 0; cell < this->Weights.size(); ++cell)
  {
    if (!this->TheMesh.skipped()[cell])
    {
      requireElementWeight(static_cast<Index>(cell), this->Weights[cell]);
    }
  }
  if (this->TheMesh.group().any(!this->Weights.empty()))
  {
    this->Weights = this->TheMesh.ofCells(this->Weights, 1);
    this->Weights.reserve(1); // not null, even without cells
  }
}

//------------------------------------------------------------------------------
void OptimizerSetup::keepTotalSize()
{
  const bool pieces = this->TheMesh.inPieces();
  const Mesh local = pieces ? this->TheMesh.local() : this->TheMesh.given();
  std::vector<double> sizes(local.view().numberOfCells), own;
  EvaluationOptions evaluation;
  evaluation.threads = this->Options.threads;
  std::vector<signed char> validity;
  if (!sizes.empty())
  {
    evaluateMetric(local, Metric::Size, evaluation, sizes.data());
  }
  if (pieces)
  {
    validity.resize(sizes.size());
    local.classifyCells(validity.data(), this->Options.threads);
  }
  else
  {
    validity = this->TheMesh.validity();
  }
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    if (validity[i] == Valid && (!pieces || this->TheMesh.distributed().ownedCells()[i]))
    {
      own.push_back(sizes[i]);
    }
  }
  auto valid = static_cast<Index>(own.size());
  double total = std::accumulate(own.begin(), own.end(), 0.0);
  constexpr auto size = static_cast<std::size_t>(TargetType::Size);
  if (pieces)
  {
    total = this->TheMesh.group().orderlessSum(own);
    valid = this->TheMesh.group().sum(valid);
    compareSizesWith(
      this->TheMesh.given(), total, valid, this->TargetsOfPiece[size], this->Options);
  }
  compareSizesWith(local, total, valid, this->MadeTargets[size], this->Options);
}

//------------------------------------------------------------------------------
OptimizeResult OptimizerSetup::run()
{
  if (this->TheMesh.inPieces())
  {
    OptimizeResult result =
      optimize(this->TheMesh.local(), this->Options, {}, this->TheMesh.division());
    result.elements = {}; // not for the cells of the input
    return result;
  }
  // With a geometry, the initial mesh differs from the input.
  const bool asGiven = &this->Boundary.start() == &this->TheMesh.mesh();
  OptimizeResult result = optimize(this->Boundary.start(), this->Options,
    asGiven ? this->TheMesh.validity() : std::vector<signed char>());
  result.surfaceError *= this->TheMesh.frame().unit();
  return result;
}

//------------------------------------------------------------------------------
std::vector<MeasuredMetric> OptimizerSetup::metrics() const
{
  if (!this->TheMesh.inPieces())
  {
    return measuredMetrics(this->Options, worstMetric(this->TheMesh.mesh(), this->Options));
  }
  std::vector<MeasuredMetric> metrics = measuredMetrics(
    this->Options, this->Options.worstMetric.value_or(this->Options.objectives[0].metric));
  for (MeasuredMetric& metric : metrics)
  {
    const Targets*& targets = metric.options.targets;
    targets = targets ? &this->TargetsOfPiece[targets - this->MadeTargets.data()] : nullptr;
  }
  return metrics;
}

//------------------------------------------------------------------------------
void compareSizesWith(
  const Mesh& mesh, double total, Index valid, Targets& mean, OptimizeOptions& options)
{
  if (valid == 0)
  {
    throw Error("No element is valid, so there is no mean size for the target: untangle the mesh "
                "first, or fix its boundary.");
  }
  const std::vector<double> sizes(mesh.view().numberOfCells, total / static_cast<double>(valid));
  mean = sizeTargets(mesh, sizes.data());
  Objective& size = options.objectives[1];
  size.metric = Metric::SizeBarrier;
  size.objectiveTemplate = ObjectiveTemplate::Sum;
  size.evaluation.targets = &mean;
  options.scalarization.method = Scalarization::WeightedSum;
}

//------------------------------------------------------------------------------
std::vector<Objective> customObjectives(const OptimizerSettings& settings)
{
  std::vector<Objective> objectives(std::max<std::size_t>(settings.objectives.size(), 1));
  for (std::size_t i = 0; i < settings.objectives.size(); ++i)
  {
    const ObjectiveRow& row = settings.objectives[i];
    objectives[i].metric = static_cast<Metric>(row.metric);
    objectives[i].objectiveTemplate = static_cast<ObjectiveTemplate>(row.objectiveTemplate);
    objectives[i].weight = row.weight;
  }
  for (Objective& objective : objectives)
  {
    objective.power = settings.power;
    objective.evaluation.parameters.beta = settings.beta;
    objective.evaluation.combination = settings.combination;
  }
  return objectives;
}

//------------------------------------------------------------------------------
void OptimizerSetup::setUnit(Objective& objective) const
{
  const double unit = this->TheMesh.frame().unit();
  const MetricInfo& info = metricInfo(objective.metric);
  if (unit == 1 || info.scaleInvariant)
  {
    return;
  }
  // A metric with a unit is minimized in the unit of the frame; a metric relative to the target,
  // unchanged.
  const int power = info.lengthPower(this->TheMesh.mesh().dimension() == Dimension::Volume ? 3 : 2);
  const double value = std::pow(unit, power);
  double& beta = objective.evaluation.parameters.beta;
  beta /= power > 0 ? value : 1.0;
  const bool ofTarget = power == 0 && !objective.evaluation.targets;
  if (ofTarget || !std::isnormal(value) || !std::isfinite(beta))
  {
    std::ostringstream text;
    text.precision(2);
    text << info.label << " cannot be optimized on elements that are about " << unit << " long: "
         << (ofTarget ? "it compares them with a target of length 1. Choose a target by reference, "
                        "size or tensor, or scale"
                      : "it is beyond the range of double precision. Scale")
         << " the mesh first (filter Transform).";
    throw Error(text.str());
  }
}

//------------------------------------------------------------------------------
void OptimizerRun::keep(const IterationState& state, std::size_t coordinates, double megabytes)
{
  if (this->iterations % this->stride != 0)
  {
    return;
  }
  this->frames.push_back({ this->iterations, std::vector<double>(coordinates) });
  state.points(this->frames.back().points.data());
  const auto bytes = static_cast<double>(this->frames.size() * coordinates * sizeof(double));
  if (bytes > megabytes * 1e6)
  {
    this->stride *= 2;
    const auto dropped = std::remove_if(this->frames.begin(), this->frames.end(),
      [this](const Frame& frame) { return frame.iteration % this->stride != 0; });
    this->frames.erase(dropped, this->frames.end());
  }
}

//------------------------------------------------------------------------------
std::vector<double> OptimizerRun::at(double time, const MeshView& input) const
{
  if (std::isnan(time) || time >= this->iterations)
  {
    return this->result.points;
  }
  const auto later = std::find_if(this->frames.begin(), this->frames.end(),
    [time](const Frame& frame) { return frame.iteration > time; });
  return later == this->frames.begin()
    ? std::vector<double>(input.points, input.points + 3 * input.numberOfPoints)
    : (later - 1)->points;
}
}
