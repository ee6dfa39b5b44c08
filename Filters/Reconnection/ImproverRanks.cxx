// SPDX-License-Identifier: BSD-3-Clause
// Improve Mesh for a mesh of tetrahedra on several processes.
#include "vtkMeshImprover.h"

#include "Blocks.h"
#include "ImprovedPiece.h"
#include "ImproverReport.h"
#include "MovableMesh.h"
#include "PieceResults.h"
#include "ProcessGroup.h"
#include "Processes.h"
#include "ReconnectablePiece.h"
#include "TableRows.h"
#include "tautline/Reconnection/ReconnectionRounds.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"

namespace
{
constexpr int VolumeDimension = 3;

/// Whether the piece of this process has elements without volume.
bool hasDegenerate(const tautline::MovableMesh& mesh, int threads)
{
  std::vector<signed char> validity(mesh.mesh().view().numberOfCells);
  mesh.mesh().classifyCells(validity.data(), threads);
  const unsigned char* skipped = mesh.skipped();
  bool found = false;
  for (std::size_t cell = 0; cell < validity.size(); ++cell)
  {
    found = found || (validity[cell] == tautline::Degenerate && !(skipped && skipped[cell]));
  }
  return found;
}
}

//------------------------------------------------------------------------------
bool vtkMeshImprover::TakesPieces(vtkInformationVector** inputs)
{
  this->Pieces.reset();
  this->Group.reset();
  this->PieceError.clear();
  this->LeftOut.clear();
  this->WhyGathered.clear();
  vtkDataObject* input = vtkDataObject::GetData(inputs[MeshPort]);
  std::string why;
  try
  {
    this->Group = tautline::makeProcessGroup();
  }
  catch (const tautline::Error&) // on all processes
  {
    why = "the processes do not communicate by MPI";
  }
  try
  {
    const bool elsewhere = this->Group && this->Group->rank() > 0 && input &&
      input->GetNumberOfElements(vtkDataObject::CELL) > 0;
    if (this->Group && !this->Group->any(elsewhere))
    {
      return false; // it is on one process
    }
    if (why.empty())
    {
      this->Group->together([&] { why = this->FindReasonToGather(input); });
    }
    if (why.empty())
    {
      this->Pieces = tautline::MovableMesh::makePiece(
        *this->Group, vtkDataSet::SafeDownCast(input), this->Threads, this->MergeCoincidentPoints);
      const bool degenerate =
        this->Group->any(this->Pieces && hasDegenerate(*this->Pieces, this->Threads));
      if (this->Pieces && this->Pieces->inverted() == 0 && !degenerate)
      {
        return true;
      }
      why = !this->Pieces ? tautline::oppositeOrders
        : degenerate      ? "cells have no volume"
                          : "cells are inverted, or parts list their points in the opposite order";
      this->Pieces.reset();
    }
  }
  catch (const std::exception& error) // on all processes, reported in RequestData()
  {
    this->PieceError = error.what();
    return true;
  }
  this->WhyGathered = tautline::gatheredSentence(why);
  return false;
}

//------------------------------------------------------------------------------
/// The reason why the mesh must be gathered on one process, or "". Throws Error on all processes.
std::string vtkMeshImprover::FindReasonToGather(vtkDataObject* input)
{
  tautline::RankGroup& group = *this->Group;
  auto* piece = vtkPointSet::SafeDownCast(input);
  if (group.any(!piece))
  {
    return "it has blocks, or is not an unstructured grid";
  }
  const tautline::CellKinds kinds = tautline::kindsOnRanks(group, piece);
  this->LeftOut = kinds.leftOut;
  tautline::ReconnectionOptions options;
  this->SetOptions(options);
  tautline::applyPreset(static_cast<tautline::ReconnectionPreset>(this->Preset), options);
  const bool partly =
    this->Selected == CHANGES || this->IsArrayChosen(tautline::ImproverArrays::Changing);
  const std::string setting = partly ? "a part that changes" : tautline::needsOneRank(options);
  const bool unnamed = piece->GetNumberOfPoints() > 0 && !piece->GetPointData()->GetGlobalIds();
  if (kinds.dimension < VolumeDimension)
  {
    return "it is made of triangles";
  }
  if (!setting.empty())
  {
    return setting + " needs the whole mesh";
  }
  if (kinds.taken < this->GatherBelow)
  {
    return "it has fewer than " + std::to_string(this->GatherBelow) + " tetrahedra (Gather Below)";
  }
  return !this->MergeCoincidentPoints && group.any(unnamed)
    ? "Merge Coincident Points is off, and the points have no global ids"
    : "";
}

//------------------------------------------------------------------------------
void vtkMeshImprover::ImproveOnRanks(vtkInformationVector** inputVector, vtkDataObject* output,
  tautline::TableRows& history, tautline::TableRows& remaining)
{
  std::unique_ptr<tautline::MovableMesh> mesh = std::move(this->Pieces);
  if (!mesh)
  {
    throw tautline::Error(this->PieceError);
  }
  tautline::RankGroup& group = *this->Group;
  auto* input = vtkDataSet::SafeDownCast(vtkDataObject::GetData(inputVector[MeshPort]));
  mesh->fix(tautline::chosenArray(this, tautline::ImproverArrays::Fixed, input, "of fixed points",
              tautline::ArrayOf::Points),
    false);
  const auto marked =
    tautline::markSelected(input, vtkSelection::GetData(inputVector[SelectionPort]));
  mesh->fixSelected(vtkDataSet::SafeDownCast(marked));
  vtkDataArray* regions = tautline::chosenArray(
    this, tautline::ImproverArrays::Region, input, "of regions", tautline::ArrayOf::Cells);
  tautline::ReconnectablePiece piece = tautline::takePiece(group, *mesh, input, regions);
  mesh.reset(); // frees its memory
  tautline::ReconnectionOptions options;
  constexpr double onlyBlock = 0.0, blocks = 1.0;
  this->PrepareOptions(options, onlyBlock, blocks);
  const tautline::RankReconnection result =
    tautline::improveConnectivity(group, std::move(piece.mesh), options, this->Rounds);
  const tautline::ImprovedCells cells =
    tautline::writePiece(group, piece, result, this->Threads, vtkPointSet::SafeDownCast(output));
  std::vector<std::vector<tautline::RemainingElement>> sent(group.size());
  const auto count = static_cast<tautline::Index>(result.originalCells.size());
  sent[0] = tautline::remainingOf(
    result.obstacles, result.qualities, result.bounds, cells, tautline::sumBefore(group, count));
  this->Remaining = group.sum(static_cast<tautline::Index>(sent[0].size()));
  std::vector<tautline::RemainingElement> left; // on the first process
  for (const auto& list : group.exchangeItems(sent))
  {
    left.insert(left.end(), list.begin(), list.end());
  }
  tautline::ReconnectionResult whole;
  whole.history = result.history;
  whole.reason = result.reason;
  whole.markedFacets = result.markedFacets;
  whole.forcedInverseMeanRatio = result.forcedInverseMeanRatio;
  const bool first = group.rank() == 0;
  tautline::TableRows unused; // otherwise tables of several processes would be joined
  this->Report(whole, std::move(left),
    { "",
      "In parts on " + std::to_string(group.size()) + " processes, in " +
        std::to_string(result.history.size() - 1) + " rounds.",
      cells.note, first ? this->LeftOut : "",
      piece.mirrored ? "The mesh is reversed: its cells list their points in the opposite order, "
                       "and it is treated as its mirror image."
                     : "",
      false, options.targetAngle },
    first ? history : unused, first ? remaining : unused);
  this->Summary = group.fromFirst(this->Summary);
}
