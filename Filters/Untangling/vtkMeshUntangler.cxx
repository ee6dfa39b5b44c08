// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshUntangler.h"

#include "Blocks.h"
#include "GatheredExecution.h"
#include "IterationHistory.h"
#include "MovableMesh.h"
#include "ProcessGroup.h"
#include "ProgressStep.h"
#include "RankMesh.h"
#include "tautline/Untangling/Untangle.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"
#include "vtkSignedCharArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <sstream>

vtkStandardNewMacro(vtkMeshUntangler);

namespace
{
constexpr int SelectionPort = 1; // input
constexpr int NumberOfInputPorts = 2, NumberOfOutputPorts = 2;
constexpr int FixedArray = 0;

constexpr int ListedElements = 10;
constexpr const char* FilterName = "Untangle Mesh"; // in the menu
constexpr const char* BoundaryRemedy = "switch Fix Boundary off";

/// In the order of tautline::Obstacle.
constexpr std::array<const char*, 5> reasons = { "valid",
  "the iterations ended before it became valid; try a higher Effort",
  "all its points are fixed; free some, or repair it by hand",
  "the fixed points around leave no valid place for its free ones; free some of them",
  "a fixed point of it is NaN or infinite" };

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
  std::string name; ///< "Element 5"; of a mesh on several processes "Element": these have no ids
  tautline::Obstacle obstacle;
  tautline::Vec3 center;
};

/// The elements with an obstacle, by id; on several processes by the numbers of their points.
std::vector<Remaining> remainingOf(
  const tautline::UntangleResult& result, const tautline::Mesh& moved)
{
  std::vector<Remaining> remaining;
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

std::vector<Remaining> remainingOf(const tautline::UntangleResult& result)
{
  std::vector<Remaining> remaining;
  for (const auto& [numbers, element] : result.remaining)
  {
    remaining.push_back({ "Element", element.obstacle, element.center });
  }
  return remaining;
}

/// ", and N that were valid are not any more", or "".
std::string newlySentence(tautline::Index newlyInvalid)
{
  return newlyInvalid == 0
    ? ""
    : ", and " + std::to_string(newlyInvalid) + " that were valid are not any more";
}

/// "All elements are valid", or how many are not, and for the first of them which, where and why.
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
{
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
      if (this->Pieces || this->ReproducibleOrder)
      {
        this->UntangleOnRanks(inputVector, vtkDataObject::GetData(outputVector, MeshPort), history);
        this->AddToSummary(this->WhyGathered);
        history.fill(vtkTable::GetData(outputVector, HistoryPort));
        return;
      }
      this->ForEachBlock(inputVector, outputVector, nullptr, SelectionPort, !this->FixBoundary,
        [&](const tautline::InputBlock& block) { this->Untangle(block, history); });
      this->AddToSummary(this->GetBlockNotice());
      this->AddToSummary(this->WhyGathered);
      history.fill(vtkTable::GetData(outputVector, HistoryPort));
      if (this->NotValid > 0)
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
void vtkMeshUntangler::Untangle(const tautline::InputBlock& block, tautline::TableRows& history)
{
  tautline::MovableMesh mesh(block.input, this->Threads, this->MergeCoincidentPoints, true);
  mesh.fix(tautline::chosenArray(
             this, FixedArray, block.input, "of fixed points", tautline::ArrayOf::Points),
    false);
  tautline::fixSelected(mesh, block.selected);
  if (this->FixBoundary)
  {
    mesh.fixBoundary();
  }

  const tautline::UntangleOptions options = this->GetOptions(mesh.fixed().data(), block.number);
  tautline::UntangleResult result = tautline::untangle(mesh.mesh(), options);
  this->HaveBest();
  std::string unsettled;
  result.points = mesh.settle(result.points, unsettled);
  if (!unsettled.empty())
  {
    result.invertedAfter = result.invertedBefore;
    result.newlyInvalid = 0;
    this->Warn(unsettled);
  }

  const std::string note = mesh.move(vtkPointSet::SafeDownCast(block.output), result.points);
  addFlags(block.output, "Validity", mesh.validityAt(result.points));
  addFlags(block.output, "Obstacle", result.obstacles);
  block.output->GetPointData()->SetActiveScalars(nullptr);
  block.output->GetCellData()->SetActiveScalars("Validity");
  tautline::addHistory(history, result.history, {}, block.name);

  this->Reason = tautline::describe(result.reason);
  this->InvertedBefore += result.invertedBefore;
  this->InvertedAfter += result.invertedAfter;
  this->Impossible += result.impossible;
  const std::vector<double> points = mesh.actual(result.points);
  const tautline::Mesh moved = mesh.actualMesh(points);
  const std::vector<Remaining> remaining = remainingOf(result, moved);
  this->NotValid += static_cast<vtkIdType>(remaining.size());
  this->AddToSummary((block.name.empty() ? "" : "In " + block.name + ": ") +
    verdict(result, remaining) +
    tautline::surfaceErrorSentence(mesh.frame().unit() * result.surfaceError));
  if (result.reason == tautline::StopReason::NoFreeVertices)
  {
    this->AddToSummary(mesh.whyNoneIsFree(BoundaryRemedy));
  }
  this->AddToSummary(note);
  this->AddToSummary(mesh.notice());
  this->Warn(mesh.coarseness());
}

//------------------------------------------------------------------------------
tautline::UntangleOptions vtkMeshUntangler::GetOptions(const unsigned char* fixed, int block)
{
  tautline::UntangleOptions options;
  options.method = static_cast<tautline::UntangleMethod>(this->Method);
  options.effort = static_cast<tautline::Effort>(this->Effort);
  options.maximumSeconds = this->GetRemainingSeconds();
  options.fixed = fixed;
  options.threads = this->Threads;
  options.observer = [this, block](const tautline::IterationState& state)
  {
    this->HaveBest();
    this->ShowIteration(FilterName, state.record.iteration,
      { { "objective", state.record.objective },
        { "inverted", static_cast<double>(state.record.inverted) } });
    return this->ProceedInBlock(
      block, std::max(state.progress, tautline::openEnded(state.record.iteration)));
  };
  return options;
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
  this->Pieces.reset();
  this->Group.reset();
  std::string why;
  this->Pieces =
    tautline::takePieces(this->Group, vtkDataObject::GetData(inputs[MeshPort]), this->Threads,
      this->MergeCoincidentPoints, static_cast<tautline::Redistribution>(this->Redistribute), &why);
  this->WhyGathered = tautline::gatheredSentence(why);
  return this->Pieces != nullptr;
}

//------------------------------------------------------------------------------
void vtkMeshUntangler::ExchangeResult(tautline::ResultStream& stream)
{
  this->Superclass::ExchangeResult(stream);
  stream(this->Reason, this->InvertedBefore, this->InvertedAfter, this->Impossible, this->NotValid);
}

//------------------------------------------------------------------------------
void vtkMeshUntangler::UntangleOnRanks(
  vtkInformationVector** inputVector, vtkDataObject* output, tautline::TableRows& history)
{
  std::unique_ptr<tautline::RankMesh> pieces = std::move(this->Pieces);
  const auto group = pieces ? std::move(this->Group) : tautline::makeProcessGroup();
  vtkDataObject* data = vtkDataObject::GetData(inputVector[MeshPort]);
  if (!pieces)
  {
    pieces = std::make_unique<tautline::RankMesh>(
      *group, tautline::requirePiece(data), this->Threads, this->MergeCoincidentPoints);
  }
  tautline::RankMesh& mesh = *pieces;
  output->ShallowCopy(data);
  auto* input = vtkDataSet::SafeDownCast(data);
  if (input->GetNumberOfPoints() > 0)
  {
    mesh.fix(
      tautline::chosenArray(this, FixedArray, input, "of fixed points", tautline::ArrayOf::Points),
      false);
    mesh.fixSelected(data, vtkSelection::GetData(inputVector[SelectionPort]));
  }
  const std::vector<unsigned char> fixed = mesh.fixed(this->FixBoundary);
  constexpr int onlyBlock = 0;
  const tautline::UntangleOptions options = this->GetOptions(fixed.data(), onlyBlock);
  tautline::Mesh local(mesh.mesh().view(), this->Threads);
  local.setMirrored(mesh.mirrored());
  const tautline::UntangleResult result =
    tautline::untangle(local, options, tautline::Ranks(mesh.mesh()));
  const std::string note = mesh.move(vtkPointSet::SafeDownCast(output), result.points);
  const std::vector<signed char> validity = mesh.validityAt(mesh.ofPiece(result.points));
  std::vector<signed char> obstacles(validity.size(), 0);
  for (std::size_t cell = 0; cell < validity.size(); ++cell)
  {
    const auto found = result.remaining.find(mesh.numbersOf(static_cast<tautline::Index>(cell)));
    obstacles[cell] =
      found == result.remaining.end() ? 0 : static_cast<signed char>(found->second.obstacle);
  }
  auto* set = vtkDataSet::SafeDownCast(output);
  addFlags(set, "Validity", validity);
  addFlags(set, "Obstacle", obstacles);
  set->GetPointData()->SetActiveScalars(nullptr);
  set->GetCellData()->SetActiveScalars("Validity");
  this->Reason = tautline::describe(result.reason);
  this->InvertedBefore = result.invertedBefore;
  this->InvertedAfter = result.invertedAfter;
  this->Impossible = result.impossible;
  this->NotValid = static_cast<vtkIdType>(result.remaining.size());
  this->AddToSummary(verdict(result, remainingOf(result)));
  this->AddToSummary(result.exceededMemory
      ? "The whole mesh did not fit into the memory of the first process, where the elements that "
        "are left would have been untangled: take fewer cells, or more memory."
      : "");
  if (result.reason == tautline::StopReason::NoFreeVertices)
  {
    this->AddToSummary(mesh.whyNoneIsFree(this->FixBoundary, false, BoundaryRemedy));
  }
  this->AddToSummary(note);
  this->AddToSummary(mesh.notice());
  if (group->rank() > 0)
  {
    return; // the table and the warning are those of the first process
  }
  tautline::addHistory(history, result.history, {}, "");
  if (this->NotValid > 0)
  {
    vtkWarningMacro(<< this->Summary);
  }
}

//------------------------------------------------------------------------------
void vtkMeshUntangler::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Effort: " << this->Effort << "\n";
  os << indent << "FixBoundary: " << this->FixBoundary << "\n";
  os << indent << "ReproducibleOrder: " << this->ReproducibleOrder << "\n";
}
