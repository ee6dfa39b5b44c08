// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMotionAlgorithm.h"

#include "BlockSeams.h"
#include "Blocks.h"
#include "GatheredExecution.h"
#include "LayerMesh.h"
#include "MovableMesh.h"
#include "ProcessGroup.h"
#include "Processes.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Mesh/DistributedMesh.h"

#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkSelection.h"
#include "vtkUnstructuredGrid.h"

//------------------------------------------------------------------------------
vtkMeshMotionAlgorithm::vtkMeshMotionAlgorithm() = default;

//------------------------------------------------------------------------------
vtkMeshMotionAlgorithm::~vtkMeshMotionAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkMeshMotionAlgorithm::ForEachBlock(vtkInformationVector** inputVector,
  vtkInformationVector* outputVector, vtkDataObject* reference, int fixedPort, bool boundaryMoves,
  const std::function<void(const tautline::InputBlock&)>& visit)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector, MeshPort);
  auto* selection = vtkSelection::GetData(inputVector[fixedPort]);
  this->BlockNotice.clear();
  this->NumberOfBlocks = 1;
  if (this->WorksOnPieces())
  {
    auto* piece = vtkDataSet::SafeDownCast(input);
    if (!piece)
    {
      throw tautline::Error("The reproducible order applies to a single mesh, but the input has "
                            "blocks: run Merge Blocks first, or switch Reproducible Order off.");
    }
    const bool empty = piece->GetNumberOfPoints() == 0;
    const auto marked = tautline::markSelected(piece, empty ? nullptr : selection);
    output->ShallowCopy(piece);
    visit({ piece, vtkDataSet::SafeDownCast(reference), vtkDataSet::SafeDownCast(marked),
      vtkDataSet::SafeDownCast(output), 0, "", 0, {} });
    return;
  }
  this->Group.reset(); // left by an earlier execution on pieces
  tautline::requireOneProcess(input);
  this->BlockNotice =
    this->MergeCoincidentPoints ? tautline::describeBlockSeams(input, this->Threads) : "";
  if (!this->BlockNotice.empty() && boundaryMoves)
  {
    throw tautline::Error("The boundary is not fixed, and blocks would come apart: " +
      this->BlockNotice + " Or switch Merge Coincident Points off.");
  }
  if (!this->BlockNotice.empty())
  {
    vtkWarningMacro(<< this->BlockNotice);
  }
  const auto fixed = tautline::markSelected(input, selection);
  this->NumberOfBlocks = tautline::countBlocks(input);
  tautline::forEachBlock(input, reference, fixed, output,
    [&](const tautline::InputBlock& block)
    {
      block.output->ShallowCopy(block.input);
      if (block.input->GetNumberOfPoints() > 0 && block.input->GetNumberOfCells() > 0)
      {
        this->VisitBlock(block, visit);
      }
    });
}

//------------------------------------------------------------------------------
void vtkMeshMotionAlgorithm::VisitBlock(
  const tautline::InputBlock& block, const std::function<void(const tautline::InputBlock&)>& visit)
{
  const auto layer = this->TreatsLayers() ? tautline::LayerMesh::find(block.input) : nullptr;
  if (!layer)
  {
    visit(block);
    return;
  }
  const auto planar = layer->planar(), selected = layer->side(block.selected),
             reference = layer->side(block.reference);
  vtkNew<vtkUnstructuredGrid> made;
  made->ShallowCopy(planar);
  tautline::InputBlock side = block;
  side.input = planar;
  side.selected = selected;
  side.reference = reference;
  side.output = made;
  visit(side);
  layer->expand(planar, made, vtkPointSet::SafeDownCast(block.output));
  this->BlockNotice += std::string(this->BlockNotice.empty() ? "" : " ") +
    (block.name.empty() ? "The mesh" : block.name) +
    " is one layer of cells and was treated as planar, perpendicular to " + "xyz"[layer->axis()] +
    ".";
}

//------------------------------------------------------------------------------
bool vtkMeshMotionAlgorithm::TakePiece(vtkDataObject* input, const std::string& why)
{
  this->Piece.reset();
  this->Group.reset();
  this->WhyGathered.clear();
  const auto gather = [this](const std::string& reason)
  {
    this->WhyGathered = tautline::gatheredSentence(reason);
    return false;
  };
  const bool scattered = tautline::isScattered(input);
  const bool layer =
    this->TreatsLayers() && tautline::LayerMesh::find(vtkDataSet::SafeDownCast(input));
  if (tautline::minimumOverProcesses(layer ? 0 : 1) == 0)
  {
    return gather(scattered ? "it is one layer of cells, which is treated as planar" : "");
  }
  if (!why.empty())
  {
    return gather(scattered ? why : "");
  }
  this->Group = tautline::tryProcessGroup();
  if (!this->Group)
  {
    return gather("the processes do not communicate by MPI");
  }
  tautline::RankGroup& group = *this->Group;
  if (group.size() == 1 || (this->Redistribute == NO_REDISTRIBUTION && !scattered))
  {
    return false;
  }
  auto* data = vtkDataSet::SafeDownCast(input);
  if (group.any(!data))
  {
    return gather(scattered ? "it has blocks" : "");
  }
  std::unique_ptr<tautline::MovableMesh> mesh;
  try
  {
    mesh = tautline::MovableMesh::makePiece(group, data, this->Threads, this->MergeCoincidentPoints,
      static_cast<tautline::Redistribution>(this->Redistribute));
  }
  catch (const tautline::Error& error) // the same on all processes; one process may also reject it
  {
    return gather(
      scattered ? std::string("its pieces could not be joined. ") + error.what() : std::string());
  }
  if (mesh && mesh->distributed().globalCells() == 0)
  {
    return false;
  }
  const auto isFramed = [](const tautline::MeshView& view)
  { return !tautline::CoordinateFrame(tautline::coordinateRange(view), false).isIdentity(); };
  const std::string reason = !mesh                    ? tautline::oppositeOrders
    : group.any(isFramed(mesh->distributed().view())) ? "its coordinates are of extreme size"
    : !mesh->inSpaceOrPlane()
    ? "it is a surface in space, or in a plane that is not perpendicular to an axis"
    : "";
  if (!reason.empty())
  {
    return gather(scattered ? reason : "");
  }
  this->Piece = std::move(mesh);
  return true;
}

//------------------------------------------------------------------------------
void vtkMeshMotionAlgorithm::DropPiece()
{
  this->Piece.reset();
}

//------------------------------------------------------------------------------
std::unique_ptr<tautline::MovableMesh> vtkMeshMotionAlgorithm::MakeMesh(
  const tautline::InputBlock& block, bool framed)
{
  if (this->Piece || !this->ReproducibleOrder)
  {
    return this->Piece ? std::move(this->Piece)
                       : std::make_unique<tautline::MovableMesh>(
                           block.input, this->Threads, this->MergeCoincidentPoints, framed);
  }
  this->Group = tautline::makeProcessGroup();
  return std::make_unique<tautline::MovableMesh>(
    *this->Group, block.input, this->Threads, this->MergeCoincidentPoints);
}

//------------------------------------------------------------------------------
bool vtkMeshMotionAlgorithm::IsFirst() const
{
  return !this->Group || this->Group->rank() == 0;
}

//------------------------------------------------------------------------------
tautline::GatheredRules vtkMeshMotionAlgorithm::GetGatheredRules()
{
  tautline::GatheredRules rules = this->Superclass::GetGatheredRules();
  rules.joinsPartitions = this->MergeCoincidentPoints || this->PartitionsHaveIds();
  return rules;
}

//------------------------------------------------------------------------------
bool vtkMeshMotionAlgorithm::ProceedInBlock(int block, double fraction)
{
  return this->Proceed((block + fraction) / static_cast<double>(this->NumberOfBlocks));
}

//------------------------------------------------------------------------------
void vtkMeshMotionAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PlanarLayers: " << this->PlanarLayers << "\n";
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
  os << indent << "Redistribute: " << this->Redistribute << "\n";
}
