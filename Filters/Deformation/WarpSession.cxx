#include "WarpSession.h"

#include "Processes.h"
#include "TargetMatch.h"
#include "tautline/Deformation/PointMotion.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkLinearTransform.h"
#include "vtkMatrix4x4.h"
#include "vtkPointData.h"
#include "vtkSelection.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <chrono>
#include <cmath>

using namespace tautline;

namespace
{
// Arrays to process. All are of the mesh: ParaView's pipeline takes those of one port at
// consecutive indices only.
enum Arrays
{
  DisplacementArray = 0,
  MovedArray = 1,
  FixedArray = 2,
  TensorArray = 3,
  RegionArray = 4
};

// Points of all time steps kept: 2^27 numbers, 1 GiB, of a data set.
constexpr std::size_t MostNumbersKept = std::size_t(1) << 27;

constexpr std::array<const char*, 11> MethodNames = { "Hybrid", "FEMWARP", "Anisotropic FEMWARP",
  "Small-step FEMWARP", "FEMWARP and untangling", "Elasticity, iterative stiffening",
  "Elasticity, Jacobian-based stiffening", "Biharmonic", "Inverse distance weighting",
  "Radial basis functions", "Weighted Laplacian" };

double norm3(const double* d)
{
  return std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

bool sameMesh(const MeshView& a, const MeshView& b)
{
  return a.numberOfPoints == b.numberOfPoints && a.numberOfCells == b.numberOfCells &&
    std::equal(a.points, a.points + 3 * a.numberOfPoints, b.points) &&
    std::equal(a.cellTypes, a.cellTypes + a.numberOfCells, b.cellTypes) &&
    std::equal(a.offsets, a.offsets + a.numberOfCells + 1, b.offsets) &&
    std::equal(a.connectivity, a.connectivity + a.offsets[a.numberOfCells], b.connectivity);
}

/// Points, cells and which are ghosts; without other arrays, whose changes do not matter.
vtkSmartPointer<vtkPointSet> structureOf(vtkPointSet* input)
{
  auto copy = vtkSmartPointer<vtkPointSet>::Take(input->NewInstance());
  copy->CopyStructure(input);
  if (vtkUnsignedCharArray* ghosts = input->GetCellGhostArray())
  {
    copy->GetCellData()->AddArray(ghosts);
  }
  return copy;
}

/// The target of a data set: that at its place, or the only one there is.
vtkDataSet* targetOf(const InputBlock& block, vtkDataObject* target)
{
  if (!target)
  {
    throw Error("There is no Target: choose the data set that has the boundary in its new place.");
  }
  vtkDataSet* only = nullptr;
  int leaves = 0;
  forEachLeaf(target,
    [&](unsigned int, vtkDataSet* leaf)
    {
      only = leaf;
      ++leaves;
    });
  if (leaves > 1 && block.name.empty())
  {
    throw Error("The target has several blocks and the mesh has none: run Merge Blocks or Extract "
                "Block on the target first.");
  }
  if (!block.name.empty())
  {
    only = counterpartOf(block, target);
  }
  if (!only)
  {
    throw Error("The target has no data set in the place of this one of the mesh.");
  }
  return only;
}

vtkDataArray* displacementArray(vtkAlgorithm* algorithm, vtkDataSet* input)
{
  const char* name =
    algorithm->GetInputArrayInformation(DisplacementArray)->Get(vtkDataObject::FIELD_NAME());
  if (name && *name && std::string(name) != "Automatic")
  {
    return chosenArray(algorithm, DisplacementArray, input, "of displacements");
  }
  vtkDataArray* named = input->GetPointData()->GetArray("Displacement");
  return named ? named : input->GetPointData()->GetVectors();
}

vtkDataArray* targetIds(vtkDataSet* target, const std::string& name)
{
  if (name.empty() || name == "None")
  {
    return nullptr;
  }
  vtkDataArray* array = target->GetPointData()->GetArray(name.c_str());
  if (!array)
  {
    throw Error(
      "The target has no point array '" + name + "' of point ids: choose another, or None.");
  }
  return array;
}

bool allZero(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double d) { return d == 0; });
}

/// Whether nothing moves, not even on the way: full turns end where they began.
bool staysAtRest(const WarpTask& task)
{
  constexpr double somewhere = 1.0 / 3;
  return allZero(task.displacement) && (!task.path || allZero(task.path(somewhere)));
}

bool chosenOfCells(vtkAlgorithm* algorithm, int index)
{
  return algorithm->GetInputArrayInformation(index)->Get(vtkDataObject::FIELD_ASSOCIATION()) ==
    vtkDataObject::FIELD_ASSOCIATION_CELLS;
}
}

//------------------------------------------------------------------------------
void RestingMesh::take(vtkPointSet* input, int threads)
{
  // What was taken shares its arrays with its owner, who may have changed them in place.
  if (this->data && this->data->GetMTime() <= this->time &&
    input->HasAnyGhostCells() == this->data->HasAnyGhostCells() &&
    sameMesh(MeshAdapter(input, threads).mesh().view(), this->mesh->mesh().view()))
  {
    return;
  }
  this->warper.reset();
  this->data = nullptr; // so that it is not taken for good if what follows throws
  vtkSmartPointer<vtkPointSet> copy = structureOf(input);
  this->mesh = std::make_unique<MovableMesh>(copy, threads);
  requireElements(*this->mesh);
  this->boundary = boundaryOf(this->mesh->mesh());
  this->Parts.reset();
  this->takeElements(threads);
  this->data = copy;
  this->time = copy->GetMTime();
}

//------------------------------------------------------------------------------
const BoundaryParts& RestingMesh::parts() const
{
  if (!this->Parts)
  {
    this->Parts = std::make_unique<BoundaryParts>(boundaryParts(this->mesh->mesh()));
  }
  return *this->Parts;
}

//------------------------------------------------------------------------------
void RestingMesh::takeElements(int threads)
{
  const Mesh& all = this->mesh->mesh();
  MeshView view = all.view();
  const int dimension = all.dimension() == Dimension::Volume ? 3 : 2;
  this->elements.reset();
  this->cells.clear();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    if (type != CellType::Unsupported && topology(type).dimension == dimension)
    {
      this->cells.push_back(cell);
    }
  }
  if (static_cast<Index>(this->cells.size()) == view.numberOfCells)
  {
    this->cells.clear();
    return;
  }
  this->types.clear();
  this->offsets.assign(1, 0);
  this->connectivity.clear();
  for (Index cell : this->cells)
  {
    this->types.push_back(view.cellTypes[cell]);
    this->connectivity.insert(this->connectivity.end(), view.connectivity + view.offsets[cell],
      view.connectivity + view.offsets[cell + 1]);
    this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
  }
  view.numberOfCells = static_cast<Index>(this->cells.size());
  view.cellTypes = this->types.data();
  view.offsets = this->offsets.data();
  view.connectivity = this->connectivity.data();
  this->elements = std::make_unique<Mesh>(view, threads);
  this->elements->setMirrored(all.mirrored());
}

//------------------------------------------------------------------------------
bool vtkMeshWarp::Session::sequence() const
{
  return !this->times.empty() &&
    (this->Self->Motion == TIME_STEPS ||
      (this->Self->StartFrom == PREVIOUS_STEP && this->Self->Motion != TRANSFORM));
}

//------------------------------------------------------------------------------
void vtkMeshWarp::Session::plan(double time, vtkMTimeType upstreamTime)
{
  // The last time step that is not later, as readers choose it.
  const auto later = std::upper_bound(this->times.begin(), this->times.end(), time);
  this->wanted = std::max<int>(0, int(later - this->times.begin()) - 1);
  if (this->looping)
  {
    return;
  }
  const bool changed = upstreamTime != this->upstream;
  for (auto& [number, kept] : this->blocks)
  {
    if (changed)
    {
      kept.first = nullptr;
    }
    const bool stopped = std::any_of(kept.frames.begin(), kept.frames.end(),
      [](const auto& frame) { return frame.second.aborted; });
    if (changed || stopped || this->Self->GetMTime() > this->own)
    {
      kept.frames.clear();
    }
  }
  this->upstream = upstreamTime;
  this->own = this->Self->GetMTime();

  this->begun = this->begun && !changed &&
    std::all_of(this->blocks.begin(), this->blocks.end(),
      [](const auto& entry) { return entry.second.first != nullptr; });
  this->current = this->begun ? this->wanted : 0;
  for (const auto& [number, kept] : this->blocks)
  {
    if (this->Self->StartFrom == PREVIOUS_STEP)
    {
      const auto after = kept.frames.upper_bound(this->wanted);
      const int last = after == kept.frames.begin() ? -1 : std::prev(after)->first;
      this->current = std::min(this->current, last + 1);
    }
  }
  // All processes take the same time steps, as what is upstream may need them all.
  this->current = minimumOverProcesses(this->current);
}

//------------------------------------------------------------------------------
void vtkMeshWarp::Session::visit(const InputBlock& block, vtkDataObject* target,
  vtkDataObject* selected, TableRows& history, TableRows& statistics, WarpTotals& totals)
{
  const auto start = std::chrono::steady_clock::now();
  block.output->ShallowCopy(block.input);
  if (block.input->GetNumberOfPoints() == 0 || block.input->GetNumberOfCells() == 0)
  {
    return;
  }
  auto* input = vtkPointSet::SafeDownCast(block.input);
  if (!input)
  {
    MovableMesh refused(block.input, this->Self->Threads); // throws and says what to do
  }
  WarpBlock& kept = this->blocks[block.number];
  const bool inSequence = this->sequence();
  if (inSequence && !kept.first)
  {
    kept.first = structureOf(input);
    kept.frames.clear();
  }
  const bool last = !inSequence || this->current == this->wanted;
  if (!last && this->Self->StartFrom == FIRST_STEP)
  {
    return; // only the mesh at the first time step was asked for
  }
  kept.rest.take(inSequence ? kept.first.Get() : input, this->Self->Threads);
  const MeshView& view = kept.rest.mesh->mesh().view();
  if (view.numberOfPoints != input->GetNumberOfPoints() ||
    view.numberOfCells != input->GetNumberOfCells())
  {
    throw Error("At this time step the mesh has " + std::to_string(input->GetNumberOfPoints()) +
      " points and " + std::to_string(input->GetNumberOfCells()) + " cells, at the first " +
      std::to_string(view.numberOfPoints) + " and " + std::to_string(view.numberOfCells) +
      ": only its points may change over time.");
  }
  WarpTask todo = this->task(block, kept.rest, target, selected);
  WarpFacts facts;
  WarpResult result = this->warp(kept, todo, block.number, facts.reused);
  if (!last)
  {
    return;
  }
  const bool anisotropic =
    this->Self->Method == HYBRID || this->Self->Method == ANISOTROPIC_FEMWARP;
  facts.method = MethodNames[this->Self->Method];
  facts.motion = todo.correspondence;
  facts.coefficients = anisotropic && todo.tensors.empty() && this->Self->Amount > 0;
  facts.amount = this->Self->Amount;
  facts.threads = this->Self->Threads;
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const double length = norm3(&todo.displacement[3 * i]);
    facts.boundaryPoints += todo.prescribed[i] != 0;
    facts.movedPoints += length > 0;
    facts.largestDisplacement = std::max(facts.largestDisplacement, length);
  }
  facts.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  addWarpOutput(*kept.rest.mesh, result, facts, block, history, statistics, totals);
}

//------------------------------------------------------------------------------
WarpTask vtkMeshWarp::Session::task(const InputBlock& block, const RestingMesh& rest,
  vtkDataObject* target, vtkDataObject* selected) const
{
  vtkMeshWarp* self = this->Self;
  const Mesh& mesh = rest.mesh->mesh();
  WarpTask task;
  this->move(block, rest, target, selected, task);

  PointFlags& stay = task.stay;
  stay.assign(rest.boundary.size(), 0);
  markPoints(mesh, chosenArray(self, FixedArray, block.input, "to tell what stays"), false, stay);
  markPoints(mesh, block.selected, stay);
  markGhosts(block.input, stay);
  task.prescribed = rest.boundary;
  for (std::size_t i = 0; i < stay.size(); ++i)
  {
    if (stay[i])
    {
      task.prescribed[i] = 1;
      std::fill_n(&task.displacement[3 * i], 3, 0.0);
    }
  }

  if (self->Method == HYBRID || self->Method == ANISOTROPIC_FEMWARP)
  {
    if (self->Coefficients == PER_CELL)
    {
      task.tensors = tensorsOf(chosenArray(self, TensorArray, block.input, "of coefficients"));
    }
    else if (self->Coefficients == PER_REGION)
    {
      task.tensors = tensorsOf(
        chosenArray(self, RegionArray, block.input, "of regions"), self->Regions, self->Tensor);
    }
  }
  return task;
}

//------------------------------------------------------------------------------
void vtkMeshWarp::Session::move(const InputBlock& block, const RestingMesh& rest,
  vtkDataObject* target, vtkDataObject* selected, WarpTask& task) const
{
  vtkMeshWarp* self = this->Self;
  const Mesh& mesh = rest.mesh->mesh();
  const MeshView& view = mesh.view();
  const auto scaleByAmount = [&]
  {
    for (double& d : task.displacement)
    {
      d *= self->Amount;
    }
  };
  if (self->Motion == DISPLACEMENT)
  {
    task.displacement = displacementsOf(displacementArray(self, block.input), rest.boundary);
    scaleByAmount();
    return;
  }
  if (self->Motion == TIME_STEPS)
  {
    if (this->times.empty())
    {
      throw Error(
        "The input has no time steps its boundary could move over: choose another Motion.");
    }
    task.displacement.assign(3 * view.numberOfPoints, 0.0);
    for (Index i = 0; i < view.numberOfPoints; ++i)
    {
      if (rest.boundary[i])
      {
        double now[3];
        block.input->GetPoint(i, now);
        std::transform(
          now, now + 3, view.points + 3 * i, &task.displacement[3 * i], std::minus<>());
      }
    }
    scaleByAmount();
    return;
  }

  PartChoice choice;
  choice.parts = [&rest]() -> const BoundaryParts& { return rest.parts(); };
  choice.part = static_cast<tautline::MovedPart>(self->MovedPart);
  choice.numbers = self->Parts;
  choice.values = self->Values;
  choice.selected = counterpartOf(block, selected);
  choice.elsewhere = selected && !block.name.empty();
  if (self->MovedPart == ARRAY_VALUES)
  {
    choice.array = chosenArray(self, MovedArray, block.input, "to tell what moves");
    choice.ofCells = chosenOfCells(self, MovedArray);
  }
  const bool automatic = self->MovedPart == AUTOMATIC_PART;
  choice.part = automatic ? tautline::MovedPart::Inner : choice.part;
  const PointFlags moved = movedPoints(mesh, rest.boundary, choice);
  if (self->Motion == TARGET)
  {
    TargetRequest request;
    request.mesh = block.input;
    request.view = &mesh;
    request.target = targetOf(block, target);
    request.correspondence = static_cast<tautline::Correspondence>(self->Correspondence);
    request.ids = targetIds(request.target, self->TargetIds);
    request.projected = &moved;
    request.matched = automatic ? &rest.boundary : &moved;
    request.threads = self->Threads;
    TargetPlaces places = placesOf(request);
    task.displacement = std::move(places.displacement);
    task.correspondence = places.how;
    scaleByAmount();
    return;
  }
  PointMotion motion;
  motion.kind = static_cast<MotionKind>(self->TransformKind);
  if (self->Transform)
  {
    const double* matrix = self->Transform->GetMatrix()->GetData();
    std::copy_n(matrix, motion.matrix.size(), motion.matrix.begin());
  }
  std::copy_n(self->Translation, 3, motion.translation.begin());
  motion.angle = self->Angle;
  std::copy_n(self->Axis, 3, motion.axis.begin());
  std::copy_n(self->ScaleFactors, 3, motion.factors.begin());
  std::copy_n(self->Direction, 3, motion.direction.begin());
  motion.ownCenter = self->OwnCenter;
  std::copy_n(self->Center, 3, motion.center.begin());
  task.path = [motion, view, moved, amount = self->Amount](double part)
  { return displacements(motion, part * amount, view.numberOfPoints, view.points, moved.data()); };
  task.displacement = task.path(1.0);
}

//------------------------------------------------------------------------------
std::vector<double> vtkMeshWarp::Session::options() const
{
  const vtkMeshWarp* self = this->Self;
  std::vector<double> values = { double(self->Method), double(self->Coefficients),
    double(self->Steps), double(self->MaximumSteps), double(self->AutomaticSolver),
    double(self->Solver), double(self->Preconditioner), self->Tolerance, self->PoissonRatio,
    self->StiffeningPower, self->StiffeningFactor, double(self->MaximumStiffenings),
    self->DistancePower, self->SupportRadius, self->FitTolerance, double(self->UntangleFirst),
    self->UntanglingBeta, double(self->MaximumIterations), self->TimeLimit, double(self->Threads) };
  values.insert(values.end(), self->Tensor, self->Tensor + 6);
  return values;
}

//------------------------------------------------------------------------------
WarpOptions vtkMeshWarp::Session::optionsFor(const RestingMesh& rest, int blockNumber)
{
  const vtkMeshWarp* self = this->Self;
  WarpOptions options;
  options.method = static_cast<WarpMethod>(self->Method);
  options.coefficients = static_cast<WarpCoefficients>(std::min<int>(self->Coefficients, PER_CELL));
  std::copy_n(self->Tensor, 6, options.tensor.begin());
  options.tensors = rest.tensors.empty() ? nullptr
    : rest.elements                      ? rest.elementTensors.data()
                                         : rest.tensors.data();
  options.prescribed = rest.prescribed.data();
  options.steps = self->Steps;
  options.maximumSteps = self->MaximumSteps;
  options.automaticSolver = self->AutomaticSolver;
  options.solver.method = static_cast<KrylovMethod>(self->Solver);
  options.solver.preconditioner = static_cast<tautline::Preconditioner>(self->Preconditioner);
  options.solver.threads = self->Threads;
  options.tolerance = self->Tolerance;
  options.poissonRatio = self->PoissonRatio;
  options.stiffeningPower = self->StiffeningPower;
  options.stiffeningFactor = self->StiffeningFactor;
  options.maximumStiffenings = self->MaximumStiffenings;
  options.distancePower = self->DistancePower;
  options.supportRadius = self->SupportRadius;
  options.fitTolerance = self->FitTolerance;
  options.untangleFirst = self->UntangleFirst;
  options.untanglingBeta = self->UntanglingBeta;
  options.optimization.stopping.maximumIterations = self->MaximumIterations;
  options.maximumSeconds = self->TimeLimit;
  options.threads = self->Threads;
  options.progress = [this, blockNumber](double fraction)
  {
    this->Self->UpdateProgress((blockNumber + fraction) / this->numberOfBlocks);
    return !this->Self->GetAbortExecute();
  };
  return options;
}

//------------------------------------------------------------------------------
/// Whether the warper there was can go on; makes a new one if not.
bool vtkMeshWarp::Session::prepare(RestingMesh& rest, WarpTask& task, int blockNumber)
{
  const std::vector<double> values = this->options();
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
WarpResult vtkMeshWarp::Session::warp(
  WarpBlock& kept, WarpTask& task, int blockNumber, bool& reused)
{
  RestingMesh& rest = kept.rest;
  const MeshView& view = rest.mesh->mesh().view();
  const bool stepwise = this->sequence() && this->Self->StartFrom == PREVIOUS_STEP;
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
    result.points = atRest; // bitwise
    result.history.resize(1);
    result.history[0].stage = "rest";
  }
  else if (before == kept.frames.end())
  {
    reused = this->prepare(rest, task, blockNumber);
    result = this->run(*rest.warper, task);
  }
  else
  {
    auto previous = structureOf(rest.data);
    previous->SetPoints(makePoints(before->second.points, nullptr));
    RestingMesh step;
    std::string note;
    try
    {
      step.take(previous, this->Self->Threads);
    }
    catch (const Error&) // tangled; the step goes the whole way from the mesh at rest
    {
      note = "The time step before was not valid, so this one started from the first.";
    }
    WarpTask rise = task;
    for (std::size_t i = 0; note.empty() && i < rise.displacement.size(); ++i)
    {
      rise.displacement[i] += atRest[i] - before->second.points[i];
    }
    RestingMesh& from = note.empty() ? step : rest;
    this->prepare(from, rise, blockNumber);
    result = this->run(*from.warper, rise);
    result.message += (result.message.empty() || note.empty() ? "" : " ") + note;
  }
  if (rest.elements && result.message.find("cell ") != std::string::npos)
  {
    result.message += " Cells are counted without lines, vertices and the surfaces of volumes.";
  }
  if (stepwise)
  {
    this->forget(kept);
    kept.frames[this->current] = result;
  }
  return result;
}

//------------------------------------------------------------------------------
WarpResult vtkMeshWarp::Session::run(Warper& warper, const WarpTask& task) const
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
void vtkMeshWarp::Session::forget(WarpBlock& kept) const
{
  const auto numbers = 3 * static_cast<std::size_t>(kept.rest.data->GetNumberOfPoints());
  if ((kept.frames.size() + 1) * numbers > MostNumbersKept)
  {
    kept.frames.clear(); // going back starts from the first, and ends in the same place
  }
}
