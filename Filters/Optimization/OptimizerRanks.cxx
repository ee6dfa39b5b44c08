// SPDX-License-Identifier: BSD-3-Clause
// Optimize Mesh for a mesh on several processes, and in the order that does not depend on these.
#include "vtkMeshOptimizer.h"

#include "BeforeAfter.h"
#include "IterationHistory.h"
#include "OptimizerSetup.h"
#include "ProcessGroup.h"
#include "ProgressStep.h"
#include "RankMesh.h"
#include "tautline/Optimization/OptimizeOnRanks.h"

#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"

#include <limits>

namespace
{
constexpr int SelectionPort = 2, GeometryPort = 3; // input
constexpr const char* FilterName = "Optimize Mesh";

[[noreturn]] void refuse(const std::string& what, const std::string& remedy)
{
  throw tautline::Error(what +
    " on one process only, in its own order: gather the mesh, in ParaView "
    "by Aggregate Dataset, with Reproducible Order off; or " +
    remedy + ".");
}

/// Throws Error for settings that need the whole mesh in one place.
void requireLocalSettings(const tautline::OptimizerSettings& settings, bool animation)
{
  using tautline::BoundaryMotion;
  if (settings.boundary == BoundaryMotion::OnSurface || settings.geometry)
  {
    refuse("Points slide on curved surfaces and geometries",
      "choose the Boundary Fixed, Sliding or Free, without a Geometry");
  }
  if (settings.preset == tautline::Preset::PreserveShape ||
    (settings.preset == tautline::Preset::UniformSize && settings.boundary == BoundaryMotion::Free))
  {
    refuse("The targets of this preset are made", "choose the preset Best Shape");
  }
  if (settings.showFeatures)
  {
    refuse("Features are found", "switch Show Features off");
  }
  if (animation)
  {
    refuse("Iterations are kept as time steps", "switch Animation off");
  }
}

/// The options of the kernel but for those per point.
void setObjectives(const tautline::OptimizerSettings& settings, tautline::OptimizeOptions& options)
{
  if (settings.preset == tautline::Preset::Custom)
  {
    options.objectives.resize(std::max<std::size_t>(settings.objectives.size(), 1));
    for (std::size_t i = 0; i < settings.objectives.size(); ++i)
    {
      const tautline::ObjectiveRow& row = settings.objectives[i];
      if (row.target != tautline::TargetType::Ideal)
      {
        refuse("Targets other than the ideal element are made", "choose the target Ideal");
      }
      options.objectives[i].metric = static_cast<tautline::Metric>(row.metric);
      options.objectives[i].objectiveTemplate =
        static_cast<tautline::ObjectiveTemplate>(row.objectiveTemplate);
      options.objectives[i].weight = row.weight;
    }
    for (tautline::Objective& objective : options.objectives)
    {
      objective.power = settings.power;
      objective.evaluation.parameters.beta = settings.beta;
      objective.evaluation.combination = settings.combination;
    }
  }
  for (tautline::Objective& objective : options.objectives)
  {
    objective.evaluation.threads = options.threads;
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
  { return tautline::chosenArray(settings.arrays, index, input, purpose); };
  if (chosen(tautline::WeightArray, "of element weights") ||
    chosen(tautline::RegionArray, "of regions") || chosen(tautline::KindArray, "of feature kinds"))
  {
    refuse("Element Weights, Regions and Feature Kinds are used", "choose None for these arrays");
  }
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
  group.together([&] { limits = readArrays(settings, input, selection, mesh); });
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
    group.together(
      [&]
      {
        // Of the points that this process owns all facets are here.
        result.shape = tautline::boundaryShape(
          tautline::Mesh(mesh.mesh().view(), settings.options.threads), settings.flatAngle);
        for (std::size_t p = 0; p < result.fixed.size(); ++p)
        {
          result.fixed[p] |= result.shape.fixed[p];
        }
      });
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
void vtkMeshOptimizer::OptimizeOnRanks(vtkInformationVector** inputVector, vtkDataObject* output,
  tautline::TableRows& history, tautline::TableRows& statistics)
{
  const auto group = tautline::makeProcessGroup();
  this->Runs.clear();
  vtkDataSet* input = nullptr;
  tautline::OptimizerSettings settings = this->GetSettings();
  settings.geometry = vtkDataObject::GetData(inputVector[GeometryPort]);
  tautline::OptimizeOptions& options = settings.options;
  group->together(
    [&]
    {
      input = tautline::requirePiece(vtkDataObject::GetData(inputVector[MeshPort]));
      requireLocalSettings(settings, this->Animation);
      setObjectives(settings, options);
      tautline::requireLocalOptions(options);
    });
  tautline::RankMesh mesh(*group, input, this->Threads, this->MergeCoincidentPoints);
  output->ShallowCopy(input);
  const PointOptions points =
    pointOptions(settings, *group, input, vtkSelection::GetData(inputVector[SelectionPort]), mesh);
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
    this->ShowIteration(FilterName, record.iteration,
      { { "objective", record.objective },
        { "worst", record.worst.empty() ? vtkMath::Nan() : record.worst.front() } });
    return this->Proceed(std::max(state.progress, tautline::openEnded(record.iteration)));
  };
  this->Runs.push_back(std::make_unique<tautline::OptimizerRun>());
  tautline::OptimizerRun& run = *this->Runs.back();
  run.result = tautline::optimizeOnRanks(mesh.mesh(), mesh.mirrored(), options);
  run.iterations = run.result.iterations;
  const std::string note = mesh.move(vtkPointSet::SafeDownCast(output), run.result.points);
  tautline::TableRows rows;
  const std::string qualities = tautline::addBeforeAfterOnRanks(*group, mesh,
    mesh.ofPiece(run.result.points), tautline::measuredMetrics(options.objectives), this->Threads,
    vtkDataSet::SafeDownCast(output), rows);
  run.summary =
    tautline::summarize(run.result, mesh.mesh().globalPoints(), mesh.mesh().globalCells(), "") +
    qualities;
  const std::string why = run.result.reason == tautline::StopReason::NoFreeVertices
    ? "Every point is fixed: choose another Boundary, fix fewer points, or refine the mesh."
    : std::string();
  for (const std::string& sentence : { why, note, mesh.notice() })
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
