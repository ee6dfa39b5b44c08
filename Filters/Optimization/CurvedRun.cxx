// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedRun.h"

#include "tautline/Curved/OptimizeCurved.h"

#include "vtkDataSet.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// The exponent p of the p-mean that the preset Worst element minimizes after the sum.
constexpr double WorstPower = 8;

/// The data that the targets of objectives refer to.
struct CurvedTargetData
{
  std::vector<double> sizes, tensors, reference;
};

void require(bool good, const char* setting, const char* remedy)
{
  if (!good)
  {
    throw Error(std::string(setting) + " is not available for curved cells: " + remedy +
      ", or reduce the cells to order 1 (Curve Mesh).");
  }
}

void requireSettings(
  const OptimizerSettings& settings, const OptimizeOptions& options, const InputBlock& block)
{
  require(!options.limits, "A limit of the displacement", "set Maximum Displacement to 0");
  require(!options.allowInversion, "Allow Inversion", "switch it off");
  require(!options.stopping.twoDigits, "Two Digits", "switch it off");
  require(options.optimizer == Optimizer::Automatic ||
      options.optimizer == Optimizer::NewtonConjugateGradient,
    "This optimizer", "choose Automatic");
  require(!choosesFeatures(settings.boundary, block.input), "An array of regions or feature kinds",
    "give the points that stay as Fixed Points");
}

/// The coordinates of the reference mesh, which must have the same cells.
std::vector<double> referencePoints(
  vtkDataSet* reference, vtkDataSet* input, const CoordinateFrame& frame)
{
  if (!reference || reference->GetNumberOfPoints() != input->GetNumberOfPoints() ||
    reference->GetNumberOfCells() != input->GetNumberOfCells())
  {
    throw Error("The reference mesh does not have the cells and points of the mesh: give one with "
                "the same cells at port 1 (Reference).");
  }
  std::vector<double> points;
  for (vtkIdType p = 0; p < reference->GetNumberOfPoints(); ++p)
  {
    double at[3];
    reference->GetPoint(p, at);
    points.insert(points.end(), at, at + 3);
  }
  frame.enter(points);
  return points;
}

/// Areas or volumes of targets with the ideal shape.
std::vector<double> sizesOf(const Targets& targets, const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  std::vector<double> sizes(view.numberOfCells, 1.0);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    if (type == CellType::Unsupported || targets.offsets[cell] == targets.offsets[cell + 1])
    {
      continue;
    }
    const CellTopology& t = topology(type);
    const double* w = targets.inverse.data() + 9 * targets.offsets[cell];
    const double inverse = t.dimension == 2 ? w[0] * w[4] - w[1] * w[3]
                                            : w[0] * (w[4] * w[8] - w[5] * w[7]) -
        w[1] * (w[3] * w[8] - w[5] * w[6]) + w[2] * (w[3] * w[7] - w[4] * w[6]);
    sizes[cell] = t.sizePerDeterminant / inverse;
  }
  return sizes;
}

TargetType targetOf(const OptimizerSettings& settings, const Objective& objective, std::size_t k)
{
  if (settings.preset == Preset::Custom)
  {
    return k < settings.objectives.size() ? settings.objectives[k].target : TargetType::Ideal;
  }
  if (settings.preset == Preset::PreserveShape &&
    metricInfo(objective.metric).family == MetricFamily::Target)
  {
    return TargetType::Reference;
  }
  return objective.evaluation.targets ? TargetType::Size : TargetType::Ideal;
}

CurvedObjective objectiveOf(const Objective& objective, TargetType target,
  const OptimizerSettings& settings, const CurvedMotion& motion, const MovableMesh& corners,
  const InputBlock& block, CurvedTargetData& data)
{
  CurvedObjective result;
  result.objective = objective;
  result.target = target;
  if (target == TargetType::Size)
  {
    data.sizes = sizesOf(*objective.evaluation.targets, motion.mesh());
    result.data = data.sizes.data();
  }
  else if (target == TargetType::Tensor)
  {
    TargetChoice choice;
    choice.type = target;
    choice.tensor = settings.targetArray(TensorArray, block.input);
    data.tensors = targetValues(corners.mesh().view(), choice);
    const double unit = corners.frame().unit();
    for (double& entry : data.tensors)
    {
      entry *= unit * unit;
    }
    result.data = data.tensors.data();
  }
  else if (target == TargetType::Reference)
  {
    data.reference = referencePoints(block.reference, block.input, corners.frame());
    result.data = data.reference.data();
  }
  return result;
}

OptimizeResult resultOf(CurvedOptimizeResult&& found)
{
  OptimizeResult result;
  result.points = std::move(found.points);
  result.history = std::move(found.history);
  result.reason = found.reason;
  result.iterations = found.iterations;
  result.freeVertices = found.freePoints;
  result.invertedBefore = found.invalidBefore;
  result.invertedAfter = found.invalidAfter;
  result.newlyInvalid = found.newlyInvalid;
  result.untangled = found.untangled;
  return result;
}
}

//------------------------------------------------------------------------------
OptimizerSettings settingsOfCorners(const OptimizerSettings& settings)
{
  OptimizerSettings corners = settings;
  BoundaryProperties& boundary = corners.boundary;
  boundary.motion = BoundaryMotion::Free;
  boundary.keepFeatures = boundary.showFeatures = boundary.leaving = false;
  boundary.surfaceTolerance = 0;
  boundary.geometry = nullptr;
  return corners;
}

//------------------------------------------------------------------------------
OptimizeResult runCurved(const OptimizerSettings& settings, OptimizerSetup& setup,
  CurvedMotion& motion, const InputBlock& block)
{
  const OptimizeOptions& given = setup.options();
  requireSettings(settings, given, block);
  motion.fix(chosenArray(
    settings.boundary.arrays, FixedArray, block.input, "of fixed points", ArrayOf::Points));
  motion.fixSelected(block.selected);
  if (settings.boundary.freeInvalid)
  {
    motion.freeInvalid();
  }
  CurvedOptimizeOptions options;
  static_cast<CurvedOptions&>(options) = motion.options();
  options.boundary = settings.boundary.motion;
  options.featureAngle = settings.boundary.featureAngle;
  options.flatAngle = settings.boundary.flatAngle;
  options.scalarization = given.scalarization;
  options.stopping = given.stopping;
  options.untangleFirst = given.untangleFirst;
  options.observer = given.observer;
  SurfaceModel model;
  if (settings.boundary.geometry && settings.boundary.motion == BoundaryMotion::OnSurface)
  {
    model = motion.geometry(
      settings.boundary.geometry, settings.boundary.featureAngle, settings.boundary.smoothSurface);
    options.geometry = &model;
  }
  std::vector<CurvedTargetData> data(given.objectives.size());
  options.objectives.clear();
  for (std::size_t k = 0; k < given.objectives.size(); ++k)
  {
    const Objective& objective = given.objectives[k];
    options.objectives.push_back(objectiveOf(objective, targetOf(settings, objective, k), settings,
      motion, motion.corners(), block, data[k]));
  }
  OptimizeResult result = resultOf(optimizeCurved(motion.mesh(), options));
  const bool ended = result.reason == StopReason::Aborted || result.reason == StopReason::TimeLimit;
  if (given.improveWorst > 0 && !ended && result.invertedAfter == 0)
  {
    // From there, improves the worst element by a mean that it dominates.
    options.objectives.resize(1);
    options.objectives[0].objective.objectiveTemplate = ObjectiveTemplate::PowerMean;
    options.objectives[0].objective.power = WorstPower;
    const std::vector<double> start = result.points;
    OptimizeResult worst = resultOf(optimizeCurved(motion.mesh().at(start.data()), options));
    worst.iterations += result.iterations;
    worst.invertedBefore = result.invertedBefore;
    worst.untangled = result.untangled;
    // The objectives of the two runs are not comparable: the history covers the first.
    worst.history = std::move(result.history);
    result = std::move(worst);
  }
  return result;
}
}
