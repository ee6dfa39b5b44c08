// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedFacts.h"

#include "MeshAdapter.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPointData.h"

namespace tautline
{
//------------------------------------------------------------------------------
CurvedFacts::CurvedFacts(vtkDataSet* input, const MeshAdapter& adapter)
{
  vtkDataArray* degrees =
    adapter.mesh().higherOrderCells() > 0 ? input->GetCellData()->GetHigherOrderDegrees() : nullptr;
  if (degrees && degrees->GetNumberOfComponents() != 3)
  {
    throw Error("The cell array HigherOrderDegrees has " +
      std::to_string(degrees->GetNumberOfComponents()) +
      " components; three are expected: the orders along the axes of a cell.");
  }
  if (degrees)
  {
    this->Degrees.resize(3 * static_cast<std::size_t>(degrees->GetNumberOfTuples()));
    for (vtkIdType cell = 0; cell < degrees->GetNumberOfTuples(); ++cell)
    {
      degrees->GetTuple(cell, this->Degrees.data() + 3 * cell);
    }
    this->Facts.degrees = this->Degrees.data();
  }
  const std::vector<unsigned char>& reversed = adapter.reversedCells();
  this->Facts.reversed = reversed.empty() ? nullptr : reversed.data();
  this->Facts.wedgesTurned = true; // by MeshAdapter
  this->Facts.rational = input->GetPointData()->GetRationalWeights() != nullptr;
}
}
