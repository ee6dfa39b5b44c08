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
#include "tautline/Untangling/UntangleOnRanks.h"

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

using Remaining = std::vector<std::pair<tautline::Index, tautline::CellType>>;

/// The elements with an obstacle, by id.
Remaining remainingOf(const tautline::UntangleResult& result, const tautline::Mesh& mesh)
{
  Remaining remaining;
  for (const tautline::CellBlock& block : mesh.blocks())
  {
    for (tautline::Index i = 0; i < block.count; ++i)
    {
      if (result.obstacles[block.cell(i)] != static_cast<signed char>(tautline::Obstacle::None))
      {
        remaining.emplace_back(block.cell(i), block.type);
      }
    }
  }
  std::sort(remaining.begin(), remaining.end());
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
std::string verdict(
  const tautline::UntangleResult& result, const Remaining& remaining, const tautline::Mesh& moved)
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
    const auto [cell, type] = remaining[i];
    const tautline::Vec3 at = moved.center(cell, type);
    text << "\nElement " << cell << " at (" << at[0] << ", " << at[1] << ", " << at[2]
         << "): " << reasons[result.obstacles[cell]] << ".";
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
namespace
{
/// The same of a mesh on several processes, whose elements have no ids.
std::string verdict(const tautline::RankUntangleResult& untangled)
{
  std::ostringstream text;
  if (untangled.remaining.empty())
  {
    text << "All elements are valid; " << untangled.result.invertedBefore << " were not.";
    return text.str();
  }
  text << untangled.remaining.size() << " elements are not valid, " << untangled.result.impossible
       << " of them because of fixed points; " << untangled.result.invertedBefore
       << " were inverted or degenerate before" << newlySentence(untangled.result.newlyInvalid)
       << ".";
  int listed = 0;
  for (const auto& [numbers, element] : untangled.remaining)
  {
    if (++listed > ListedElements)
    {
      text << "\n... and " << untangled.remaining.size() - ListedElements
           << " more: select the cells where the array Obstacle is not 0.";
      break;
    }
    const tautline::Vec3& at = element.center;
    text << "\nElement at (" << at[0] << ", " << at[1] << ", " << at[2]
         << "): " << reasons[static_cast<std::size_t>(element.obstacle)] << ".";
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
  const Remaining remaining = remainingOf(result, moved);
  this->NotValid += static_cast<vtkIdType>(remaining.size());
  this->AddToSummary((block.name.empty() ? "" : "In " + block.name + ": ") +
    verdict(result, remaining, moved) +
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
  const tautline::RankUntangleResult untangled =
    tautline::untangleOnRanks(mesh.mesh(), mesh.mirrored(), options);
  const tautline::UntangleResult& result = untangled.result;
  const std::string note = mesh.move(vtkPointSet::SafeDownCast(output), result.points);
  const std::vector<signed char> validity = mesh.validityAt(mesh.ofPiece(result.points));
  std::vector<signed char> obstacles(validity.size(), 0);
  for (std::size_t cell = 0; cell < validity.size(); ++cell)
  {
    const auto found = untangled.remaining.find(mesh.numbersOf(static_cast<tautline::Index>(cell)));
    obstacles[cell] =
      found == untangled.remaining.end() ? 0 : static_cast<signed char>(found->second.obstacle);
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
  this->NotValid = static_cast<vtkIdType>(untangled.remaining.size());
  this->AddToSummary(verdict(untangled));
  this->AddToSummary(untangled.exceededMemory
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
