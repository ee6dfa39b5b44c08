// SPDX-License-Identifier: BSD-3-Clause
#include "WarpSession.h"

#include "PointMerge.h"
#include "PointOrder.h"
#include "Processes.h"

#include "tautline/Core/Stopwatch.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
// The limit on the coordinates of kept time steps, per data set: 2^27 numbers, 1 GiB.
constexpr std::size_t MaximumNumbersKept = std::size_t(1) << 27;

constexpr std::array<const char*, 13> MethodNames = { "Hybrid", "FEMWARP", "Anisotropic FEMWARP",
  "Small-step FEMWARP", "FEMWARP and untangling", "Elasticity, iterative stiffening",
  "Elasticity, Jacobian-based stiffening", "Biharmonic", "Inverse distance weighting",
  "Radial basis functions", "Weighted Laplacian", "Inverse distance with rotations", "Automatic" };
static_assert(MethodNames.size() == static_cast<std::size_t>(WarpMethod::Automatic) + 1,
  "a name for each method");

double norm3(const double* d)
{
  return std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/// The target of a data set: the one at its position, or the only one.
vtkDataSet* targetOf(const InputBlock& block, vtkDataObject* target)
{
  if (!target)
  {
    throw Error(NoTarget);
  }
  vtkDataSet* only = nullptr;
  int leaves = 0;
  forEachLeaf(target,
    [&](unsigned int, vtkDataSet* leaf)
    {
      only = leaf;
      ++leaves;
    });
  if (leaves > 1 && block.flatIndex == 0)
  {
    throw Error("The target has several blocks and the mesh has none: run Merge Blocks or Extract "
                "Block on the target first.");
  }
  if (block.flatIndex > 0)
  {
    only = counterpartOf(block, target);
  }
  if (!only)
  {
    throw Error("The target has no data set at the position of this data set of the mesh.");
  }
  return only;
}

/// Throws Error if moved points were assembled in the order of their coordinates.
void requireOrderOverTime(vtkPointSet& first, vtkPointSet& now)
{
  bool moved = pointOrder(&now) == PointOrder::Coordinates && &first != &now;
  for (vtkIdType i = 0; moved && i < now.GetNumberOfPoints(); ++i)
  {
    Vec3 a, b;
    first.GetPoint(i, a.data());
    now.GetPoint(i, b.data());
    if (a != b)
    {
      throw Error(
        "The pieces of the mesh are joined, and its points have moved since the first time step, "
        "so that their order is not known: run Generate Global Ids first, or Aggregate Dataset.");
    }
  }
}

bool allZero(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double d) { return d == 0; });
}
}

//------------------------------------------------------------------------------
const char* nameOf(WarpMethod method)
{
  return MethodNames[static_cast<std::size_t>(method)];
}

//------------------------------------------------------------------------------
vtkDataArray* displacementArray(vtkAlgorithm* algorithm, vtkDataSet* input)
{
  const char* name =
    algorithm->GetInputArrayInformation(DisplacementArray)->Get(vtkDataObject::FIELD_NAME());
  if (name && *name && std::string(name) != "Automatic")
  {
    return chosenArray(algorithm, DisplacementArray, input, "of displacements", ArrayOf::Points);
  }
  vtkDataArray* named = input->GetPointData()->GetArray("Displacement");
  return named ? named : input->GetPointData()->GetVectors();
}

//------------------------------------------------------------------------------
PartChoice partChoice(const WarpSettings& settings, vtkDataSet* input)
{
  PartChoice choice;
  choice.part = settings.part == MovedPart::Automatic ? MovedPart::Inner : settings.part;
  choice.numbers = settings.partNumbers;
  choice.values = settings.partValues;
  if (choice.part == MovedPart::Values)
  {
    choice.array = chosenArray(settings.arrays, MovedArray, input, "of the part that moves");
    choice.ofCells = chosenOfCells(settings.arrays, MovedArray);
  }
  return choice;
}

//------------------------------------------------------------------------------
std::vector<double> chosenTensors(const WarpSettings& settings, vtkDataSet* input)
{
  if (!settings.anisotropic() || input->GetNumberOfCells() == 0)
  {
    return {};
  }
  if (settings.tensorsByRegion)
  {
    return tensorsOf(chosenArray(settings.arrays, RegionArray, input, "of regions", ArrayOf::Cells),
      settings.regions, settings.options.tensor.data());
  }
  return settings.options.coefficients == WarpCoefficients::PerCell
    ? tensorsOf(chosenArray(settings.arrays, TensorArray, input, "of coefficients", ArrayOf::Cells))
    : std::vector<double>();
}

//------------------------------------------------------------------------------
void holdStaying(WarpTask& task)
{
  for (std::size_t p = 0; p < task.stay.size(); ++p)
  {
    if (task.stay[p])
    {
      task.prescribed[p] = 1;
      std::fill_n(&task.displacement[3 * p], 3, 0.0);
    }
  }
}

//------------------------------------------------------------------------------
bool staysAtRest(const WarpTask& task)
{
  constexpr double somewhere = 1.0 / 3;
  return allZero(task.displacement) && (!task.path || allZero(task.path(somewhere)));
}

//------------------------------------------------------------------------------
WarpResult resultAtRest(const WarpSettings& settings, std::vector<double> points)
{
  WarpResult result;
  result.points = std::move(points); // bitwise
  result.history.resize(1);
  result.history[0].stage = "rest";
  // For a motion over time, the first step is at rest.
  const bool still = settings.amount > 0 && settings.motion != MotionSource::TimeSteps;
  result.message = still ? NothingMoves : "";
  return result;
}

//------------------------------------------------------------------------------
WarpFacts factsOf(const WarpSettings& settings, const WarpTask& task)
{
  WarpFacts facts;
  facts.method = nameOf(settings.options.method);
  facts.motion = task.correspondence;
  facts.coefficients = settings.anisotropic() && settings.amount > 0 && task.tensors.empty() &&
    settings.options.coefficients != WarpCoefficients::PerCell &&
    settings.options.coefficients != WarpCoefficients::LocalGradients;
  facts.amount = settings.amount;
  facts.threads = settings.options.threads;
  return facts;
}

//------------------------------------------------------------------------------
bool WarpSession::overTime() const
{
  return this->settings.motion == MotionSource::TimeSteps ||
    (this->settings.fromPreviousStep && this->settings.motion != MotionSource::Transform);
}

//------------------------------------------------------------------------------
bool WarpSession::sequence() const
{
  return !this->times.empty() && this->overTime();
}

//------------------------------------------------------------------------------
void WarpSession::agreeOnTimes(bool needed)
{
  this->times = this->ownTimes;
  this->TimesProblem.clear();
  vtkMultiProcessController* controller = needed ? severalProcesses() : nullptr;
  if (!controller)
  {
    return;
  }
  const int rank = controller->GetLocalProcessId(), count = controller->GetNumberOfProcesses();
  const int first = minimumOverProcesses(this->ownTimes.empty() ? count : rank);
  if (first == count)
  {
    return;
  }
  auto number = static_cast<vtkIdType>(this->times.size());
  controller->Broadcast(&number, 1, first);
  this->times.resize(static_cast<std::size_t>(number));
  controller->Broadcast(this->times.data(), number, first);
  const bool differ = !this->ownTimes.empty() && this->ownTimes != this->times;
  const int other = minimumOverProcesses(differ ? rank : count);
  if (other < count)
  {
    this->TimesProblem = "The time steps of process " + std::to_string(other) +
      " differ from the time steps of process " + std::to_string(first) +
      ": give all processes the same time steps; a process without cells may have none.";
  }
}

//------------------------------------------------------------------------------
void WarpSession::requireSameTimes() const
{
  if (!this->TimesProblem.empty())
  {
    throw Error(this->TimesProblem);
  }
}

//------------------------------------------------------------------------------
void WarpSession::plan(std::optional<double> time, vtkMTimeType upstream, vtkMTimeType own)
{
  if (this->looping)
  {
    return;
  }
  // The last time step that is not later, as chosen by readers; before all of them, the first.
  const auto later =
    time ? std::upper_bound(this->times.begin(), this->times.end(), *time) : this->times.begin();
  const int here = static_cast<int>(later - this->times.begin()) - 1;
  this->requested = std::max(0, -minimumOverProcesses(-here));
  // All processes start over together.
  const auto onAny = [](bool here) { return minimumOverProcesses(here ? 0 : 1) == 0; };
  const bool modified = onAny(own > this->Own);
  const bool changed =
    onAny(upstream != this->Upstream) || (severalProcesses() != nullptr && modified);
  this->gathers = this->gathers && !changed;
  for (auto& [number, kept] : this->Blocks)
  {
    if (changed)
    {
      kept.first = nullptr;
    }
    const bool stopped = std::any_of(kept.frames.begin(), kept.frames.end(),
      [](const auto& frame) { return frame.second.aborted; });
    if (changed || stopped || modified)
    {
      kept.frames.clear();
    }
  }
  this->Upstream = upstream;
  this->Own = own;

  this->begun = !onAny(!this->begun || changed ||
    std::any_of(this->Blocks.begin(), this->Blocks.end(),
      [](const auto& entry) { return entry.second.first == nullptr; }));
  this->current = this->begun ? this->requested : 0;
  for (const auto& [number, kept] : this->Blocks)
  {
    if (this->settings.fromPreviousStep)
    {
      const auto after = kept.frames.upper_bound(this->requested);
      const int last = after == kept.frames.begin() ? -1 : std::prev(after)->first;
      this->current = std::min(this->current, last + 1);
    }
  }
  // All processes request the same time steps, because the upstream filters may need all of them.
  this->current = minimumOverProcesses(this->current);
}

//------------------------------------------------------------------------------
void WarpSession::visit(const InputBlock& block, vtkDataObject* target, vtkDataObject* selected,
  TableRows& history, TableRows& statistics, WarpTotals& totals)
{
  const Stopwatch clock;
  auto* input = vtkPointSet::SafeDownCast(block.input);
  if (!input)
  {
    MovableMesh refused(block.input, this->settings.options.threads, false); // throws the remedy
  }
  WarpBlock& kept = this->Blocks[block.number];
  const bool inSequence = this->sequence();
  if (inSequence && !kept.first)
  {
    kept.first = structureOf(input);
    kept.frames.clear();
  }
  const bool last = this->atRequested();
  if (!last && !this->settings.fromPreviousStep)
  {
    return; // only the mesh at the first time step was requested
  }
  kept.rest.take(inSequence ? kept.first.Get() : input, this->settings.options.threads,
    this->settings.mergePoints);
  const MeshView& view = kept.rest.mesh->mesh().view();
  if (view.numberOfPoints != input->GetNumberOfPoints() ||
    view.numberOfCells != input->GetNumberOfCells())
  {
    throw Error("At this time step the mesh has " + std::to_string(input->GetNumberOfPoints()) +
      " points and " + std::to_string(input->GetNumberOfCells()) + " cells; at the first " +
      std::to_string(view.numberOfPoints) + " and " + std::to_string(view.numberOfCells) +
      ": only its points may change over time.");
  }
  requireOrderOverTime(*kept.rest.data, *input);
  WarpTask todo = this->task(block, kept.rest, target, selected);
  bool reused = false;
  WarpResult result = this->warp(kept, todo, block.number, reused);
  if (!last)
  {
    return;
  }
  WarpFacts facts = factsOf(this->settings, todo);
  facts.reused = reused;
  facts.following =
    kept.rest.curved ? static_cast<Index>(kept.rest.curved->nodes().points().size()) : 0;
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const double length = norm3(&todo.displacement[3 * i]);
    facts.boundaryPoints += todo.prescribed[i] != 0 || kept.rest.boundary[i];
    facts.movedPoints += length > 0;
    facts.largestDisplacement = std::max(facts.largestDisplacement, length);
  }
  facts.seconds = clock.seconds();
  addWarpOutput(*kept.rest.mesh, result, facts, block, history, statistics, totals);
}

//------------------------------------------------------------------------------
PointFlags WarpSession::movingPoints(
  const InputBlock& block, vtkDataObject* target, vtkDataObject* selected)
{
  auto* input = vtkPointSet::SafeDownCast(block.input);
  if (!input)
  {
    MovableMesh refused(block.input, this->settings.options.threads, false); // throws the remedy
  }
  RestingMesh& rest = this->Blocks[block.number].rest;
  rest.take(input, this->settings.options.threads, this->settings.mergePoints);
  WarpTask task;
  const auto moveAlongX = [&task](const PointFlags& moved)
  {
    task.displacement.assign(3 * moved.size(), 0.0);
    for (std::size_t i = 0; i < moved.size(); ++i)
    {
      task.displacement[3 * i] = moved[i];
    }
  };
  switch (this->settings.motion)
  {
    case MotionSource::Displacement:
      this->moveByArray(block, rest, task);
      break;
    case MotionSource::Target:
      this->moveToTarget(block, rest, target, this->movedPart(block, rest, selected), task);
      break;
    case MotionSource::Transform: // which may not be chosen yet
      moveAlongX(this->movedPart(block, rest, selected));
      break;
    case MotionSource::TimeSteps:
      moveAlongX(rest.boundary);
      break;
  }
  this->prescribe(block, rest, task);
  PointFlags moving(rest.boundary.size());
  for (std::size_t i = 0; i < moving.size(); ++i)
  {
    moving[i] = norm3(&task.displacement[3 * i]) > 0;
  }
  return moving;
}

//------------------------------------------------------------------------------
void WarpSession::forgetFrom(int block)
{
  this->Blocks.erase(this->Blocks.lower_bound(block), this->Blocks.end());
}

//------------------------------------------------------------------------------
void WarpSession::clear()
{
  this->looping = this->begun = this->piecewise = this->gathers = this->startsAgain = false;
  this->Blocks.clear();
}

//------------------------------------------------------------------------------
WarpTask WarpSession::task(const InputBlock& block, const RestingMesh& rest, vtkDataObject* target,
  vtkDataObject* selected) const
{
  const WarpSettings& set = this->settings;
  WarpTask task;
  switch (set.motion)
  {
    case MotionSource::Displacement:
      this->moveByArray(block, rest, task);
      break;
    case MotionSource::TimeSteps:
      this->moveOverTime(block, rest, task);
      break;
    case MotionSource::Target:
      this->moveToTarget(block, rest, target, this->movedPart(block, rest, selected), task);
      break;
    case MotionSource::Transform:
      this->moveByTransform(rest, this->movedPart(block, rest, selected), task);
      break;
  }
  if (!task.path) // the path is straight
  {
    for (double& d : task.displacement)
    {
      d *= set.amount;
    }
  }
  this->prescribe(block, rest, task);
  task.tensors = chosenTensors(set, block.input);
  // As cells of the input; the warper leaves out lines, vertices and the surfaces of volumes.
  const auto checked = rest.cells.empty() ? task.tensors.size() / 6 : rest.cells.size();
  for (std::size_t i = 0; i < checked && !task.tensors.empty(); ++i)
  {
    const Index cell = rest.cells.empty() ? static_cast<Index>(i) : rest.cells[i];
    requireTensor(&task.tensors[6 * cell], cell, "mesh");
  }
  return task;
}

//------------------------------------------------------------------------------
void WarpSession::prescribe(const InputBlock& block, const RestingMesh& rest, WarpTask& task) const
{
  const Mesh& mesh = rest.mesh->mesh();
  task.stay.assign(rest.boundary.size(), 0);
  markPoints(mesh.view(),
    chosenArray(this->settings.arrays, FixedArray, block.input, "of fixed points", ArrayOf::Points),
    false, task.stay);
  markPoints(mesh.view(), block.selected, task.stay);
  markGhosts(block.input, task.stay);
  // Only the representative of merged points belongs to the mesh.
  const std::vector<Index>& one = rest.mesh->representative();
  for (std::size_t p = 0; p < one.size(); ++p)
  {
    task.stay[one[p]] |= task.stay[p];
    task.stay[p] = static_cast<std::size_t>(one[p]) == p && task.stay[p];
  }
  task.prescribed = rest.boundary;
  holdStaying(task);
  // The nodes between corners do not belong to the warped mesh.
  for (std::size_t i = 0; rest.curved && i < rest.curved->nodes().points().size(); ++i)
  {
    task.prescribed[rest.curved->nodes().points()[i]] = 0;
  }
}

//------------------------------------------------------------------------------
void WarpSession::moveByArray(
  const InputBlock& block, const RestingMesh& rest, WarpTask& task) const
{
  vtkDataArray* array = displacementArray(this->settings.arrays, block.input);
  requireEqualValues(array, rest.mesh->representative(), "displacements");
  task.displacement = displacementsOf(array, rest.boundary);
}

//------------------------------------------------------------------------------
void WarpSession::moveOverTime(
  const InputBlock& block, const RestingMesh& rest, WarpTask& task) const
{
  if (this->times.empty())
  {
    throw Error(NoTimeSteps);
  }
  requireEqualValues(vtkPointSet::SafeDownCast(block.input)->GetPoints()->GetData(),
    rest.mesh->representative(), "positions at this time step");
  const MeshView& view = rest.mesh->mesh().view();
  task.displacement.assign(3 * view.numberOfPoints, 0.0);
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    if (rest.boundary[i])
    {
      double now[3];
      block.input->GetPoint(i, now);
      std::transform(now, now + 3, view.points + 3 * i, &task.displacement[3 * i], std::minus<>());
    }
  }
}

//------------------------------------------------------------------------------
PointFlags WarpSession::movedPart(
  const InputBlock& block, const RestingMesh& rest, vtkDataObject* selected) const
{
  PartChoice choice = partChoice(this->settings, block.input);
  choice.parts = [&rest]() -> const BoundaryParts& { return rest.parts(); };
  choice.selected = counterpartOf(block, selected);
  choice.elsewhere = selected && block.flatIndex > 0;
  PointFlags moved = movedPoints(rest.mesh->mesh(), rest.boundary, choice);
  // Nodes between moving corners belong to the same part.
  for (std::size_t i = 0; rest.curved && i < rest.curved->nodes().points().size(); ++i)
  {
    const Index point = rest.curved->nodes().points()[i];
    moved[point] |=
      static_cast<unsigned char>(rest.boundary[point] && rest.curved->nodes().allCorners(i, moved));
  }
  return moved;
}

//------------------------------------------------------------------------------
void WarpSession::moveToTarget(const InputBlock& block, const RestingMesh& rest,
  vtkDataObject* target, const PointFlags& moved, WarpTask& task) const
{
  const WarpSettings& set = this->settings;
  TargetRequest request;
  request.mesh = block.input;
  request.view = &rest.mesh->given();
  request.target = targetOf(block, target);
  request.correspondence = set.correspondence;
  request.ids = chosenTargetIds(request.target, set.targetIds);
  request.projected = &moved;
  request.matched = set.part == MovedPart::Automatic ? &rest.boundary : &moved;
  request.threads = set.options.threads;
  TargetPlaces places = placesOf(request);
  task.displacement = std::move(places.displacement);
  task.own = std::move(places.given);
  task.correspondence = places.how;
}

//------------------------------------------------------------------------------
void WarpSession::moveByTransform(
  const RestingMesh& rest, const PointFlags& moved, WarpTask& task) const
{
  task.path = [motion = this->settings.transform, view = rest.mesh->mesh().view(), moved,
                amount = this->settings.amount](double fraction)
  {
    return displacements(motion, fraction * amount, view.numberOfPoints, view.points, moved.data());
  };
  task.displacement = task.path(1.0);
  task.own = moved;
}

//------------------------------------------------------------------------------
std::vector<double> WarpSession::optionValues() const
{
  const WarpOptions& o = this->settings.options;
  std::vector<double> values = { double(o.method), double(o.coefficients), double(o.steps),
    double(o.maximumSteps), double(o.automaticSolver), double(o.solver.method),
    double(o.solver.preconditioner), o.tolerance, o.poissonRatio, o.stiffeningPower,
    o.stiffeningFactor, double(o.maximumStiffenings), o.distancePower, o.supportRadius,
    o.fitTolerance, double(o.untangleFirst), o.untanglingBeta,
    double(o.optimization.stopping.maximumIterations), o.maximumSeconds, double(o.threads) };
  values.insert(values.end(), o.tensor.begin(), o.tensor.end());
  return values;
}

//------------------------------------------------------------------------------
WarpOptions WarpSession::optionsFor(const RestingMesh& rest, int blockNumber)
{
  WarpOptions options = this->settings.options;
  options.tensors = rest.tensors.empty() ? nullptr
    : rest.elements                      ? rest.elementTensors.data()
                                         : rest.tensors.data();
  options.prescribed = rest.prescribed.data();
  options.progress = [this, blockNumber](double fraction)
  { return this->settings.progress(blockNumber, fraction); };
  return options;
}

//------------------------------------------------------------------------------
/// Whether the existing warper can be reused; makes a new one if not.
bool WarpSession::prepare(RestingMesh& rest, WarpTask& task, int blockNumber)
{
  const std::vector<double> values = this->optionValues();
  if (rest.warper && rest.options == values && rest.prescribed == task.prescribed &&
    rest.tensors == task.tensors)
  {
    return true;
  }
  rest.warper.reset();
  rest.options = values;
  rest.prescribed = task.prescribed;
  rest.tensors = task.tensors;
  rest.elementTensors.clear();
  for (Index cell : rest.tensors.empty() ? std::vector<Index>() : rest.cells)
  {
    const double* tensor = &rest.tensors[6 * cell];
    rest.elementTensors.insert(rest.elementTensors.end(), tensor, tensor + 6);
  }
  rest.warper = std::make_unique<Warper>(rest.warped(), this->optionsFor(rest, blockNumber));
  return false;
}

//------------------------------------------------------------------------------
WarpResult WarpSession::warp(WarpBlock& kept, WarpTask& task, int blockNumber, bool& reused)
{
  RestingMesh& rest = kept.rest;
  const MeshView& view = rest.mesh->mesh().view();
  const bool stepwise = this->sequence() && this->settings.fromPreviousStep;
  const auto done = stepwise ? kept.frames.find(this->current) : kept.frames.end();
  WarpResult result;
  reused = false;
  if (done != kept.frames.end())
  {
    return done->second;
  }
  const std::vector<double> atRest(view.points, view.points + 3 * view.numberOfPoints);
  const auto before = stepwise ? kept.frames.find(this->current - 1) : kept.frames.end();
  if (staysAtRest(task) && before == kept.frames.end())
  {
    result = resultAtRest(this->settings, atRest);
  }
  else if (before == kept.frames.end())
  {
    reused = this->prepare(rest, task, blockNumber);
    rest.warper->setMaximumSeconds(this->settings.secondsLeft());
    result = runWarp(*rest.warper, task);
    if (rest.curved)
    {
      followCorners(rest, task, this->settings.options.threads, result.points, result.amount);
    }
  }
  else
  {
    result = this->warpFromPrevious(rest, before->second, task, blockNumber);
    notePrevious(before->second, result);
  }
  if (rest.elements && result.message.find("cell ") != std::string::npos)
  {
    result.message += " Lines, vertices and the surfaces of volumes are not counted as cells.";
  }
  spread(result.points, 3, rest.mesh->representative());
  if (rest.curved)
  {
    rest.curved->nodes().unite(result.points);
  }
  if (stepwise)
  {
    limitFrames(kept, 3 * static_cast<std::size_t>(kept.rest.data->GetNumberOfPoints()));
    kept.frames[this->current] = result;
  }
  return result;
}

//------------------------------------------------------------------------------
WarpResult WarpSession::warpFromPrevious(
  RestingMesh& rest, const WarpResult& previous, const WarpTask& task, int blockNumber)
{
  const double* atRest = rest.mesh->mesh().view().points;
  auto data = structureOf(rest.data);
  data->SetPoints(makePoints(previous.points, nullptr));
  RestingMesh step;
  std::string note;
  try
  {
    step.take(data, this->settings.options.threads, this->settings.mergePoints);
  }
  catch (const Error&) // tangled; the step covers the whole motion from the mesh at rest
  {
    note = PreviousInvalid;
  }
  WarpTask rise = task;
  for (std::size_t i = 0; note.empty() && i < rise.displacement.size(); ++i)
  {
    rise.displacement[i] += atRest[i] - previous.points[i];
  }
  RestingMesh& from = note.empty() ? step : rest;
  this->prepare(from, rise, blockNumber);
  from.warper->setMaximumSeconds(this->settings.secondsLeft());
  WarpResult result = runWarp(*from.warper, rise);
  if (from.curved)
  {
    followCorners(from, rise, this->settings.options.threads, result.points, result.amount);
  }
  result.message += (result.message.empty() || note.empty() ? "" : " ") + note;
  return result;
}

//------------------------------------------------------------------------------
WarpResult runWarp(Warper& warper, const WarpTask& task)
{
  if (!task.path)
  {
    return warper.warp(task.displacement.data());
  }
  return warper.warp(
    [&task](double part, double* displacement)
    {
      const std::vector<double> d = task.path(part);
      for (std::size_t i = 0; i < d.size(); ++i)
      {
        displacement[i] = task.stay[i / 3] ? 0.0 : d[i];
      }
    });
}

//------------------------------------------------------------------------------
void followCorners(const RestingMesh& rest, const WarpTask& task, int threads,
  std::vector<double>& points, double amount)
{
  const FollowingNodes& nodes = rest.curved->nodes();
  const double* before = rest.mesh->mesh().view().points;
  nodes.place(before, points, threads);
  for (std::size_t i = 0; amount == 1.0 && i < nodes.points().size(); ++i)
  {
    const Index point = nodes.points()[i];
    // Boundary nodes between fixed corners stay; beside a moving corner, nodes without a motion
    // follow.
    const bool own = task.own.empty() || task.own[point] || !nodes.anyCorner(i, task.own);
    if (task.stay[point] || (nodes.boundary()[point] && own))
    {
      for (Index c = 3 * point; c < 3 * point + 3; ++c)
      {
        points[c] = before[c] + task.displacement[c];
      }
    }
  }
  nodes.unite(points);
}

//------------------------------------------------------------------------------
vtkPointSet* WarpSession::firstPiece(vtkDataObject* input)
{
  auto* piece = vtkPointSet::SafeDownCast(input);
  if (!piece)
  {
    return nullptr;
  }
  WarpBlock& kept = this->ownPiece();
  if (!kept.first)
  {
    kept.first = structureOf(piece);
    kept.first->GetPointData()->SetGlobalIds(piece->GetPointData()->GetGlobalIds());
    kept.frames.clear();
  }
  return kept.first;
}

//------------------------------------------------------------------------------
void WarpSession::beginGathered()
{
  this->clear();
  this->gathers = this->startsAgain = true;
}

//------------------------------------------------------------------------------
void notePrevious(const WarpResult& previous, WarpResult& result)
{
  if (previous.timeLimit || previous.message.find(PreviousLimited) != std::string::npos)
  {
    result.message += (result.message.empty() ? "" : " ") + std::string(PreviousLimited);
  }
}

//------------------------------------------------------------------------------
void limitFrames(WarpBlock& block, std::size_t numbers)
{
  if ((block.frames.size() + 1) * numbers > MaximumNumbersKept)
  {
    block.frames.clear();
  }
}
}
