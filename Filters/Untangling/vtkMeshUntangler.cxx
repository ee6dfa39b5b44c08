// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshUntangler.h"

#include "Blocks.h"
#include "BoundarySetup.h"
#include "CurvedMotion.h"
#include "GatheredExecution.h"
#include "IterationHistory.h"
#include "MovableMesh.h"
#include "PolyhedralMesh.h"
#include "Processes.h"
#include "ProgressStep.h"
#include "tautline/Curved/UntangleCurved.h"
#include "tautline/Untangling/Untangle.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkSignedCharArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

vtkStandardNewMacro(vtkMeshUntangler);

namespace
{
constexpr int SelectionPort = 1, GeometryPort = 2; // input
constexpr int NumberOfInputPorts = 3, NumberOfOutputPorts = 2;
constexpr int FixedArray = 0, KindArray = 1, RegionArray = 2;

constexpr int ListedElements = 10;
constexpr const char* FilterName = "Untangle Mesh"; // in the menu
constexpr const char* BoundaryRemedy = "choose another Boundary";

/// In the order of tautline::Obstacle.
constexpr std::array<const char*, 5> reasons = { "valid",
  "the iterations ended before it became valid; try another Boundary or a higher Effort",
  "all its points are fixed; free some, or repair it manually",
  "the surrounding fixed points leave no valid position for its free ones; free some of them",
  "one of its fixed points is NaN or infinite" };

void addFlags(vtkDataSet* output, const char* name, const std::vector<signed char>& values)
{
  vtkNew<vtkSignedCharArray> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  output->GetCellData()->AddArray(array);
}

/// An element that is not valid.
struct Remaining
{
  std::string name; ///< "Element 3"; without the number for pieces
  tautline::Obstacle obstacle;
  tautline::Vec3 center;
};

/// The elements with an obstacle, by id, or for pieces by the numbers of their points.
std::vector<Remaining> remainingOf(
  const tautline::UntangleResult& result, const tautline::MovableMesh& mesh)
{
  std::vector<Remaining> remaining;
  if (mesh.inPieces())
  {
    for (const auto& [numbers, element] : result.remaining)
    {
      remaining.push_back({ "Element", element.obstacle, element.center });
    }
    return remaining;
  }
  const std::vector<double> points = mesh.actual(result.points);
  const tautline::Mesh moved = mesh.actualMesh(points);
  for (std::size_t cell = 0; cell < result.obstacles.size(); ++cell)
  {
    const auto obstacle = static_cast<tautline::Obstacle>(result.obstacles[cell]);
    if (obstacle != tautline::Obstacle::None)
    {
      const auto id = static_cast<tautline::Index>(cell);
      const auto type = tautline::cornerType(moved.view().cellTypes[cell]);
      remaining.push_back({ "Element " + std::to_string(cell), obstacle, moved.center(id, type) });
    }
  }
  return remaining;
}

/// The obstacles of the cells of the input.
std::vector<signed char> obstaclesOf(
  const tautline::UntangleResult& result, const tautline::MovableMesh& mesh)
{
  if (!mesh.inPieces())
  {
    return result.obstacles;
  }
  std::vector<signed char> obstacles(mesh.mesh().view().numberOfCells, 0);
  for (std::size_t cell = 0; cell < obstacles.size(); ++cell)
  {
    const auto found = result.remaining.find(mesh.numbersOf(static_cast<tautline::Index>(cell)));
    obstacles[cell] =
      found == result.remaining.end() ? 0 : static_cast<signed char>(found->second.obstacle);
  }
  return obstacles;
}

/// The reason why the boundary needs the whole mesh; pieces are supported only if it does not move.
tautline::NeedOfWholeMesh needOfUntangling(
  const tautline::BoundaryProperties& properties, bool features)
{
  return properties.motion == tautline::BoundaryMotion::FlatParts
    ? tautline::NeedOfWholeMesh{ "points that slide on flat parts",
        "choose the Boundary Fixed or Slide on smooth parts (on surface)" }
    : tautline::needOfWholeMesh(properties, features);
}

/// ", and N that were valid no longer are", or "".
std::string newlySentence(tautline::Index newlyInvalid)
{
  return newlyInvalid == 0
    ? ""
    : ", and " + std::to_string(newlyInvalid) + " that were valid no longer are";
}

/// "All elements are valid", or the number of invalid elements, with the position of and the reason
/// for the first ones.
std::string verdict(const tautline::UntangleResult& result, const std::vector<Remaining>& remaining)
{
  std::ostringstream text;
  if (remaining.empty())
  {
    text << "All elements are valid; " << result.invertedBefore << " were not.";
    return text.str();
  }
  text << remaining.size() << " elements are not valid, " << result.impossible
       << " of them because of fixed points; " << result.invertedBefore
       << " were inverted or degenerate before" << newlySentence(result.newlyInvalid) << ".";
  const auto listed = std::min<std::size_t>(remaining.size(), ListedElements);
  for (std::size_t i = 0; i < listed; ++i)
  {
    const auto& [name, obstacle, at] = remaining[i];
    text << "\n"
         << name << " at (" << at[0] << ", " << at[1] << ", " << at[2]
         << "): " << reasons[static_cast<std::size_t>(obstacle)] << ".";
  }
  if (remaining.size() > listed)
  {
    text << "\n... and " << remaining.size() - listed
         << " more: select the cells where the array Obstacle is not 0.";
  }
  return text.str();
}
}

//------------------------------------------------------------------------------
vtkMeshUntangler::vtkMeshUntangler()
  : vtkMeshBoundaryAlgorithm(FixedArray, KindArray, RegionArray)
{
  this->Boundary = ON_SURFACE;
  this->DeclarePorts(NumberOfInputPorts, NumberOfOutputPorts, { SelectionPort });
}

//------------------------------------------------------------------------------
vtkMeshUntangler::~vtkMeshUntangler() = default;

//------------------------------------------------------------------------------
int vtkMeshUntangler::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ClearResult();
  this->SetProgressText(FilterName);
  return this->Attempt(outputVector, "untangle the mesh in parts",
    [&]
    {
      tautline::TableRows history;
      vtkDataObject* geometry = vtkDataObject::GetData(inputVector[GeometryPort]);
      // Touching blocks would come apart; a boundary that slides only if necessary is then fixed.
      const bool moves = this->Boundary == SLIDING || this->Boundary == FREE || geometry;
      this->ForEachBlock(inputVector, outputVector, nullptr, SelectionPort, moves,
        [&](const tautline::InputBlock& block)
        {
          tautline::hasPolyhedra(block.input) ? this->UntanglePolyhedra(block, geometry, history)
            : tautline::hasCurvedCells(block.input) ? this->UntangleCurved(block, geometry, history)
                                                    : this->Untangle(block, geometry, history);
        });
      if (this->NotValid > 0)
      {
        const bool one = this->GetNumberOfBlocks() == 1;
        this->Summary = tautline::WarningPrefix +
          (one ? "" : std::to_string(this->NotValid) + " elements are not valid.\n") +
          this->Summary;
      }
      this->AddToSummary(this->GetBlockNotice());
      this->AddToSummary(this->GetWhyGathered());
      history.fill(vtkTable::GetData(outputVector, HistoryPort));
      if (this->NotValid > 0 && this->IsFirst())
      {
        vtkWarningMacro(<< this->Summary);
      }
    });
}

//------------------------------------------------------------------------------
void vtkMeshUntangler::ClearResult()
{
  this->Superclass::ClearResult();
  this->Reason.clear();
  this->InvertedBefore = this->InvertedAfter = this->Impossible = this->NotValid = 0;
}

//------------------------------------------------------------------------------
void vtkMeshUntangler::Untangle(
  const tautline::InputBlock& block, vtkDataObject* geometry, tautline::TableRows& history)
{
  const std::unique_ptr<tautline::MovableMesh> made = this->MakeMesh(block, true);
  tautline::MovableMesh& mesh = *made;
  tautline::BoundaryProperties properties = this->GetBoundaryProperties(geometry);
  // A default must not reject surfaces, pieces and touching blocks.
  const bool onSurface = mesh.mesh().dimension() == tautline::Dimension::Surface;
  const bool stays = this->Boundary == ON_SURFACE && !geometry &&
    (onSurface || mesh.inPieces() || !this->GetBlockNotice().empty());
  if (stays)
  {
    properties.motion = tautline::BoundaryMotion::Fixed;
  }
  if (onSurface && !geometry)
  {
    properties.keepFeatures = false; // points stay on the given facets
  }
  if (mesh.inPieces())
  {
    needOfUntangling(properties, tautline::choosesFeatures(properties, block.input)).refuse();
  }
  const tautline::BoundarySetup boundary(properties, block, mesh);
  tautline::UntangleOptions options = this->GetOptions(block.number);
  static_cast<tautline::BoundaryConstraints&>(options) = boundary.constraints();
  tautline::UntangleResult result =
    tautline::untangle(mesh.inPieces() ? mesh.local() : boundary.start(), options, mesh.division());
  this->HaveBest();
  std::string unsettled;
  result.points = mesh.settle(result.points, unsettled);
  if (!unsettled.empty())
  {
    result.invertedAfter = result.invertedBefore;
    result.newlyInvalid = 0;
    this->Warn(unsettled);
  }

  const bool asked = this->ShowFeatures || geometry;
  std::string more = asked ? boundary.describeFeatures() : "";
  if (this->ShowFeatures)
  {
    boundary.addFeatures(block.output);
  }
  if (result.offSurface > 0)
  {
    more += (more.empty() ? "" : " ") + std::to_string(result.offSurface) +
      (result.offSurface == 1 ? " point is" : " points are") +
      " not on the surface on which they slide, at most " +
      tautline::distanceText(
        mesh.frame().unit() * result.offSurfaceDistance, block.input->GetLength()) +
      " away.";
  }
  if (stays && result.invertedAfter > 0)
  {
    more += std::string(more.empty() ? "" : " ") +
      (onSurface ? "The boundary was kept fixed, as required for a surface in space."
                 : "The boundary was kept fixed, as required on several processes and if blocks "
                   "touch: merge the blocks, or aggregate the mesh with Reproducible Order off, to "
                   "allow it to slide.");
  }
  this->Show(block, mesh, result, more, history);
  this->AddToSummary(result.exceededMemory
      ? "The whole mesh did not fit into the memory of the first process, where the remaining "
        "elements would have been untangled: use fewer cells or more memory."
      : "");
}

//------------------------------------------------------------------------------
/// Untangles all cells of a mesh with polyhedra, as finite volumes.
void vtkMeshUntangler::UntanglePolyhedra(
  const tautline::InputBlock& block, vtkDataObject* geometry, tautline::TableRows& history)
{
  using namespace tautline;
  if (this->ReproducibleOrder)
  {
    throw Error("Polyhedra do not support the reproducible order of several processes: switch "
                "Reproducible Order off.");
  }
  PolyhedralMesh mesh(block, this->Threads);
  BoundaryProperties properties = this->GetBoundaryProperties(geometry);
  if (this->Boundary == ON_SURFACE && !geometry)
  {
    properties.motion = BoundaryMotion::Fixed;
  }
  ImproveFacesOptions options;
  options.untangleOnly = true;
  options.maximumSeconds = this->GetRemainingSeconds();
  options.proceed = [&](int round, double fraction)
  {
    this->ShowIteration(FilterName, round, {});
    return this->ProceedInBlock(block.number, fraction);
  };
  const std::vector<signed char> before = mesh.validity();
  const ImproveFacesResult found = mesh.improve(properties, options);
  const std::vector<signed char> after = mesh.move(vtkPointSet::SafeDownCast(block.output), found);
  UntangleResult result;
  std::vector<signed char> obstacles(after.size(), static_cast<signed char>(Obstacle::None));
  std::vector<Remaining> remaining;
  const auto isInvalid = [](signed char value) { return value != Valid && value != NotMeasured; };
  for (std::size_t cell = 0; cell < after.size(); ++cell)
  {
    result.invertedBefore += isInvalid(before[cell]);
    if (isInvalid(after[cell]))
    {
      result.newlyInvalid += !isInvalid(before[cell]);
      obstacles[cell] = static_cast<signed char>(Obstacle::Unknown);
      const double* box = block.output->GetCell(static_cast<vtkIdType>(cell))->GetBounds();
      remaining.push_back({ "Element " + std::to_string(cell), Obstacle::Unknown,
        { (box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2 } });
    }
  }
  addFlags(block.output, "Obstacle", obstacles);
  block.output->GetPointData()->SetActiveScalars(nullptr);
  block.output->GetCellData()->SetActiveScalars("Validity");
  result.history.resize(2);
  result.history[0].inverted = result.invertedBefore;
  result.history[1].inverted = static_cast<Index>(remaining.size());
  result.history[1].iteration = found.rounds;
  addHistory(history, result.history, {}, block.name);
  this->Reason = describe(found.reason);
  this->InvertedBefore += result.invertedBefore;
  this->InvertedAfter += static_cast<vtkIdType>(remaining.size());
  this->NotValid += static_cast<vtkIdType>(remaining.size());
  this->AddToSummary(
    (block.name.empty() ? "" : "In " + block.name + ": ") + verdict(result, remaining));
  this->AddToSummary(mesh.notice());
}

//------------------------------------------------------------------------------
void vtkMeshUntangler::UntangleCurved(
  const tautline::InputBlock& block, vtkDataObject* geometry, tautline::TableRows& history)
{
  if (this->ReproducibleOrder)
  {
    throw tautline::Error("Curved cells do not support the reproducible order of several "
                          "processes: switch Reproducible Order off.");
  }
  tautline::CurvedMotion motion(block, this->Threads, this->MergeCoincidentPoints);
  motion.fix(tautline::chosenArray(
    this, FixedArray, block.input, "of fixed points", tautline::ArrayOf::Points));
  motion.fixSelected(block.selected);
  if (this->FreeInvalid)
  {
    motion.freeInvalid();
  }
  tautline::CurvedOptions options = motion.options();
  options.boundary = static_cast<tautline::BoundaryMotion>(this->Boundary);
  options.featureAngle = this->FeatureAngle;
  options.flatAngle = this->FlatAngle;
  options.midNodesOnly = this->MidNodesOnly;
  options.straighten = this->Straighten;
  options.maximumSeconds = this->GetRemainingSeconds();
  options.observer = [&](const tautline::IterationState& state)
  { return this->ShowState(state, block.number); };
  tautline::SurfaceModel model;
  if (geometry && this->Boundary == ON_SURFACE)
  {
    model = motion.geometry(geometry, this->FeatureAngle, this->SmoothSurface);
    options.geometry = &model;
  }
  const tautline::CurvedUntangleResult found = tautline::untangleCurved(motion.mesh(), options);
  tautline::UntangleResult result;
  result.points = found.points;
  result.history = found.history;
  result.reason = found.reason;
  result.invertedBefore = found.invalidBefore;
  result.invertedAfter = found.invalidAfter;
  result.newlyInvalid = found.newlyInvalid;
  result.obstacles.assign(motion.mesh().view().numberOfCells, 0);
  for (const tautline::Index cell : found.remaining)
  {
    result.obstacles[cell] = static_cast<signed char>(tautline::Obstacle::Unknown);
  }
  this->HaveBest();
  std::string more = "Curved cells are certified throughout the cell.";
  if (found.straightened > 0)
  {
    more += " " + std::to_string(found.straightened) +
      " cells were straightened and may be off the surface.";
  }
  if (found.reason == tautline::StopReason::NoFreeVertices)
  {
    more += " No node of or around the invalid cells is free: choose another Boundary, switch Mid "
            "Nodes Only off, or fix fewer points.";
  }
  this->Show(block, motion.corners(), result, more, history);
}

//------------------------------------------------------------------------------
/// Writes a result to the output and adds to the summary. @param more further sentences, or ""
void vtkMeshUntangler::Show(const tautline::InputBlock& block, const tautline::MovableMesh& mesh,
  tautline::UntangleResult& result, const std::string& more, tautline::TableRows& history)
{
  const std::string note = mesh.move(vtkPointSet::SafeDownCast(block.output), result.points);
  addFlags(block.output, "Validity", mesh.validityAt(result.points));
  addFlags(block.output, "Obstacle", obstaclesOf(result, mesh));
  block.output->GetPointData()->SetActiveScalars(nullptr);
  block.output->GetCellData()->SetActiveScalars("Validity");
  if (this->IsFirst())
  {
    tautline::addHistory(history, result.history, {}, block.name);
  }

  this->Reason = tautline::describe(result.reason);
  this->InvertedBefore += result.invertedBefore;
  this->InvertedAfter += result.invertedAfter;
  this->Impossible += result.impossible;
  const std::vector<Remaining> remaining = remainingOf(result, mesh);
  this->NotValid += static_cast<vtkIdType>(remaining.size());
  this->AddToSummary((block.name.empty() ? "" : "In " + block.name + ": ") +
    verdict(result, remaining) +
    tautline::surfaceErrorSentence(
      mesh.frame().unit() * result.surfaceError, block.input->GetLength()));
  this->AddToSummary(!remaining.empty() && !mesh.inPieces() &&
        mesh.mesh().dimension() == tautline::Dimension::Surface
      ? "Improve Mesh removes triangles without area."
      : "");
  this->AddToSummary(more);
  if (result.reason == tautline::StopReason::NoFreeVertices)
  {
    this->AddToSummary(mesh.whyNoneIsFree(BoundaryRemedy));
  }
  this->AddToSummary(note);
  this->AddToSummary(mesh.notice());
  this->Warn(mesh.coarseness());
}

//------------------------------------------------------------------------------
tautline::UntangleOptions vtkMeshUntangler::GetOptions(int block)
{
  tautline::UntangleOptions options;
  options.method = static_cast<tautline::UntangleMethod>(this->Method);
  options.effort = static_cast<tautline::Effort>(this->Effort);
  options.maximumSeconds = this->GetRemainingSeconds();
  options.threads = this->Threads;
  options.observer = [this, block](const tautline::IterationState& state)
  { return this->ShowState(state, block); };
  return options;
}

//------------------------------------------------------------------------------
/// Shows the progress. @return false to stop
bool vtkMeshUntangler::ShowState(const tautline::IterationState& state, int block)
{
  this->HaveBest();
  this->ShowIteration(FilterName, state.record.iteration,
    { { "objective", state.record.objective },
      { "inverted", static_cast<double>(state.record.inverted) } });
  return this->ProceedInBlock(
    block, std::max(state.progress, tautline::openEnded(state.record.iteration)));
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshUntangler::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.result = tautline::GatheredResult::SameMesh;
  return rules;
}

//------------------------------------------------------------------------------
bool vtkMeshUntangler::TakesPieces(vtkInformationVector** inputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[MeshPort]);
  const auto onAny = [](bool here) { return tautline::minimumOverProcesses(here ? 0 : 1) == 0; };
  tautline::BoundaryProperties properties =
    this->GetBoundaryProperties(vtkDataObject::GetData(inputs[GeometryPort]));
  if (this->Boundary == ON_SURFACE && !properties.geometry)
  {
    properties.motion = tautline::BoundaryMotion::Fixed;
  }
  const bool features =
    onAny(tautline::choosesFeatures(properties, vtkDataSet::SafeDownCast(input)));
  const std::string what = onAny(tautline::hasPolyhedra(input)) ? "polyhedra"
    : onAny(tautline::hasCurvedCells(input))                    ? "curved cells"
                                             : needOfUntangling(properties, features).what;
  return this->TakePiece(input, what.empty() ? "" : what + " need the whole mesh");
}

//------------------------------------------------------------------------------
void vtkMeshUntangler::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->Reason, this->InvertedBefore, this->InvertedAfter, this->Impossible, this->NotValid);
}

//------------------------------------------------------------------------------
void vtkMeshUntangler::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Effort: " << this->Effort << "\n";
  os << indent << "MidNodesOnly: " << this->MidNodesOnly << "\n";
  os << indent << "Straighten: " << this->Straighten << "\n";
  os << indent << "ReproducibleOrder: " << this->ReproducibleOrder << "\n";
}
