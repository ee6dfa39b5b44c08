#include "vtkMeshMotionAlgorithm.h"

#include "Blocks.h"

#include "vtkDataSet.h"
#include "vtkInformationVector.h"
#include "vtkSelection.h"

//------------------------------------------------------------------------------
vtkMeshMotionAlgorithm::vtkMeshMotionAlgorithm() = default;

//------------------------------------------------------------------------------
vtkMeshMotionAlgorithm::~vtkMeshMotionAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkMeshMotionAlgorithm::ForEachBlock(vtkInformationVector** inputVector,
  vtkInformationVector* outputVector, vtkDataObject* reference, int fixedPort,
  const std::function<void(const tautline::InputBlock&)>& visit)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[MeshPort]);
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
bool vtkMeshMotionAlgorithm::ProceedInBlock(int block, double fraction)
{
  return this->Proceed((block + fraction) / static_cast<double>(this->NumberOfBlocks));
}
