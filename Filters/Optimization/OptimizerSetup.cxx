#include "OptimizerSetup.h"

#include "TargetChoice.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"

#include <limits>

namespace
{
enum Arrays
{
  SizeArray = 0,
  TensorArray = 1,
  FixedArray = 2,
  LimitArray = 3,
  WeightArray = 4
};

/// Throws if an array does not have one component.
vtkDataArray* oneComponent(vtkDataArray* array, const char* what)
{
  if (array && array->GetNumberOfComponents() != 1)
  {
    throw tautline::Error(std::string("The array of ") + what + " has " +
      std::to_string(array->GetNumberOfComponents()) + " components; one is expected.");
  }
  return array;
}
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::Setup::setFixed(vtkMeshOptimizer* self, const tautline::InputBlock& block)
{
  const auto points = static_cast<std::size_t>(this->mesh.mesh().view().numberOfPoints);
  this->mesh.fix(
    tautline::chosenArray(self, FixedArray, block.input, "to tell the fixed points by"), false);
  tautline::fixSelected(this->mesh, block.selected);
  if (self->Boundary == FIXED)
  {
    this->mesh.fixBoundary();
  }
  else if (self->Boundary == SLIDING || self->Boundary == ON_SURFACE)
  {
    this->shape = tautline::boundaryShape(
      this->mesh.mesh(), self->FlatAngle, self->Boundary == ON_SURFACE ? self->FeatureAngle : 0.0);
    this->mesh.fixCorners(this->shape);
    for (std::size_t i = 0; i < 3 * points; ++i)
    {
      if (this->mesh.fixed()[i / 3])
      {
        this->shape.planes[i] = this->shape.lines[i] = 0;
      }
    }
    for (std::size_t i = 0; i < points; ++i)
    {
      this->shape.surface[i] &= !this->mesh.fixed()[i];
    }
    this->options.slideSurface = this->shape.onSurface > 0 ? this->shape.surface.data() : nullptr;
    this->options.slidePlanes = this->shape.planes.data();
    this->options.slideLines = this->shape.lines.data();
  }

  const double infinite = std::numeric_limits<double>::infinity();
  if (vtkDataArray* array =
        oneComponent(tautline::chosenArray(self, LimitArray, block.input, "of limits"), "limits"))
  {
    for (std::size_t i = 0; i < points; ++i)
    {
      const double limit = array->GetComponent(static_cast<vtkIdType>(i), 0);
      this->limits.push_back(limit < 0 ? infinite : limit);
    }
  }
  else if (self->MaximumDisplacement > 0)
  {
    this->limits.assign(points, self->MaximumDisplacement);
  }
  this->options.limits = this->limits.empty() ? nullptr : this->limits.data();
}

//------------------------------------------------------------------------------
const tautline::Targets* vtkMeshOptimizer::Setup::target(
  vtkMeshOptimizer* self, const tautline::InputBlock& block, int type)
{
  tautline::Targets& made = this->targets[type];
  if (type == IDEAL || !made.offsets.empty())
  {
    return type == IDEAL ? nullptr : &made;
  }
  tautline::TargetChoice choice;
  choice.type = static_cast<tautline::TargetType>(type);
  choice.reference = block.reference;
  if (type == SIZE || type == TENSOR)
  {
    tautline::ChosenArray& chosen = type == SIZE ? choice.size : choice.tensor;
    chosen.array = self->GetInputArrayToProcess(
      type == SIZE ? SizeArray : TensorArray, block.input, chosen.association);
  }
  made = tautline::makeTargets(this->mesh.mesh(), choice, self->Threads);
  return &made;
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::Setup::setObjectives(
  vtkMeshOptimizer* self, const tautline::InputBlock& block)
{
  std::vector<tautline::Objective>& objectives = this->options.objectives;
  if (vtkDataArray* array = oneComponent(
        tautline::chosenArray(self, WeightArray, block.input, "of element weights"), "weights"))
  {
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      this->weights.push_back(array->GetComponent(i, 0));
    }
  }
  if (self->Preset != CUSTOM)
  {
    tautline::applyPreset(static_cast<tautline::Preset>(self->Preset), this->options);
    for (tautline::Objective& objective : objectives)
    {
      const auto family = tautline::metricInfo(objective.metric).family;
      if (self->Preset == PRESERVE_SHAPE && family == tautline::MetricFamily::Target)
      {
        objective.evaluation.targets = this->target(self, block, REFERENCE);
      }
    }
  }
  else
  {
    objectives.resize(std::max(self->Objectives, 1));
    for (int i = 0; i < self->Objectives; ++i)
    {
      const Row& row = self->Rows[i];
      objectives[i].metric = static_cast<tautline::Metric>(row.metric);
      objectives[i].objectiveTemplate = static_cast<tautline::ObjectiveTemplate>(row.form);
      objectives[i].weight = row.weight;
      objectives[i].evaluation.targets = this->target(self, block, row.target);
    }
    for (tautline::Objective& objective : objectives)
    {
      objective.power = self->Power;
      objective.evaluation.parameters.beta = self->Beta;
      objective.evaluation.combination = static_cast<tautline::Combination>(self->Combination);
    }
  }
  for (tautline::Objective& objective : objectives)
  {
    objective.evaluation.threads = self->Threads;
    objective.elementWeights = this->weights.empty() ? nullptr : this->weights.data();
  }
}

//------------------------------------------------------------------------------
void vtkMeshOptimizer::Setup::setAlgorithm(vtkMeshOptimizer* self)
{
  if (self->Preset == CUSTOM)
  {
    tautline::ScalarizationOptions& s = this->options.scalarization;
    s.method = static_cast<tautline::Scalarization>(self->Scalarization);
    s.c = self->C;
    s.exponent = self->Exponent;
    s.tolerance = self->Tolerance;
    s.utopia = self->Utopia;
    tautline::StoppingCriteria& stop = this->options.stopping;
    stop.maximumIterations = self->MaximumIterations;
    stop.gradientNorm = self->GradientNorm;
    stop.relativeChange = self->RelativeChange;
    stop.twoDigits = self->TwoDigits;
    stop.reduction = self->Reduction;
    stop.bestKnown = self->BestKnown != 0 ? self->BestKnown : vtkMath::Nan();
    stop.allValid = self->StopWhenValid;
    this->options.optimizer = static_cast<tautline::Optimizer>(self->Optimizer);
    this->options.rescaleUntangling = self->RescaleUntangling;
    this->options.culling = self->Culling;
    this->options.patchIterations = self->PatchIterations;
    this->options.relaxation = self->Relaxation;
    this->options.improveWorst = self->ImproveWorst;
  }
  this->options.stopping.maximumSeconds = self->TimeLimit;
  this->options.surface.project = self->ProjectToSurface;
  this->options.allowInversion = self->AllowInversion;
  this->options.untangleFirst = self->UntangleFirst;
  this->options.threads = self->Threads;
}
