// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMotionAlgorithm.h"

#include "Blocks.h"
#include "BlockSeams.h"
#include "GatheredExecution.h"
#include "Processes.h"

#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkSelection.h"

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
  const auto fixed = tautline::markSelected(input, vtkSelection::GetData(inputVector[fixedPort]));
  this->NumberOfBlocks = tautline::countBlocks(input);
  tautline::forEachBlock(input, reference, fixed, vtkDataObject::GetData(outputVector, MeshPort),
    [&visit](const tautline::InputBlock& block)
    {
      block.output->ShallowCopy(block.input);
      if (block.input->GetNumberOfPoints() > 0 && block.input->GetNumberOfCells() > 0)
      {
        visit(block);
      }
    });
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
  os << indent << "MergeCoincidentPoints: " << this->MergeCoincidentPoints << "\n";
  os << indent << "Redistribute: " << this->Redistribute << "\n";
}
