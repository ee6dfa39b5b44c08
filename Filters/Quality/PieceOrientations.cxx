// SPDX-License-Identifier: BSD-3-Clause
#include "PieceOrientations.h"

#include "Blocks.h"
#include "MeshAdapter.h"

#include "vtkDataSet.h"
#include "vtkMultiProcessController.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
void PieceOrientations::find(vtkDataObject* input, int threads)
{
  forEachLeaf(input,
    [&](unsigned int index, vtkDataSet* data)
    {
      if (data->GetNumberOfCells() == 0)
      {
        return;
      }
      const MeshAdapter adapter(data, threads);
      const Mesh& mesh = adapter.mesh();
      std::vector<signed char> validity(static_cast<std::size_t>(mesh.view().numberOfCells));
      mesh.classifyCells(validity.data(), threads);
      const Orientation found = mesh.orientation(validity.data());
      this->Found.resize(std::max<std::size_t>(this->Found.size(), index + 1));
      Pieces& piece = this->Found[index];
      const bool reversed = found.state == Orientation::Reversed;
      piece.any = found.positiveCells + found.negativeCells > 0;
      piece.withReversed = reversed || found.reversedParts > 0;
      piece.withOthers = piece.any && !reversed;
      piece.disagreeing = found.disagreeing > 0;
    });
}

//------------------------------------------------------------------------------
void PieceOrientations::gather(vtkMultiProcessController* controller)
{
  const int own = static_cast<int>(this->Found.size());
  int size = own;
  controller->AllReduce(&own, &size, 1, vtkCommunicator::MAX_OP);
  if (size == 0)
  {
    return;
  }
  this->Found.resize(static_cast<std::size_t>(size));
  std::vector<int> mine;
  for (const Pieces& p : this->Found)
  {
    mine.insert(mine.end(), { p.any, p.withReversed, p.withOthers, p.disagreeing });
  }
  std::vector<int> sums(mine.size());
  controller->AllReduce(
    mine.data(), sums.data(), static_cast<vtkIdType>(mine.size()), vtkCommunicator::SUM_OP);
  const int* sum = sums.data();
  for (Pieces& p : this->Found)
  {
    p = { sum[0], sum[1], sum[2], sum[3] };
    sum += mine.size() / this->Found.size();
  }
}

//------------------------------------------------------------------------------
bool PieceOrientations::ambiguous(unsigned int flatIndex) const
{
  if (flatIndex >= this->Found.size())
  {
    return false;
  }
  const Pieces& pieces = this->Found[flatIndex];
  return pieces.any > 1 && pieces.withReversed > 0 && pieces.withOthers > 0 &&
    pieces.disagreeing == 0;
}
}
