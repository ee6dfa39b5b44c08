// SPDX-License-Identifier: BSD-3-Clause
#include "PieceOrientations.h"

#include "Blocks.h"
#include "MeshAdapter.h"

#include "tautline/Mesh/RankPieces.h"

#include "vtkDataSet.h"
#include "vtkMultiProcessController.h"

#include <algorithm>
#include <map>
#include <memory>

namespace tautline
{
//------------------------------------------------------------------------------
void PieceOrientations::find(vtkDataObject* input, int threads, RankGroup* group)
{
  std::map<Index, vtkDataSet*> pieces; // by flat index
  forEachLeaf(input,
    [&](unsigned int index, vtkDataSet* data)
    {
      if (data->GetNumberOfCells() > 0)
      {
        pieces[index] = data;
      }
    });
  const Index own = pieces.empty() ? 0 : pieces.rbegin()->first + 1;
  const Index size = group ? group->maximum(own) : own;
  this->Found.resize(static_cast<std::size_t>(size));
  this->Spaces.resize(static_cast<std::size_t>(size));
  for (Index index = 0; index < size; ++index)
  {
    const auto piece = pieces.find(index);
    this->findPiece(piece != pieces.end() ? piece->second : nullptr, threads, group,
      static_cast<unsigned int>(index));
  }
}

//------------------------------------------------------------------------------
/// @param data null if this process has no cells of it
void PieceOrientations::findPiece(
  vtkDataSet* data, int threads, RankGroup* group, unsigned int index)
{
  const auto together = [group](const auto& work) { group ? group->together(work) : work(); };
  std::unique_ptr<MeshAdapter> adapter;
  std::vector<unsigned char> skip;
  std::vector<RankPiece> pieces;
  together(
    [&]
    {
      if (data)
      {
        adapter = std::make_unique<MeshAdapter>(data, threads);
        skip = cellsToSkip(*adapter);
        pieces.push_back({ &adapter->mesh(), skip.empty() ? nullptr : skip.data(), nullptr });
      }
    });
  if (group)
  {
    this->Spaces[index] = spaceOnRanks(*group, pieces);
  }
  together(
    [&]
    {
      if (!adapter)
      {
        return;
      }
      Mesh& mesh = adapter->mesh();
      mesh.setSpace(this->Spaces[index].value_or(mesh.space()));
      std::vector<signed char> validity(static_cast<std::size_t>(mesh.view().numberOfCells));
      mesh.classifyCells(validity.data(), threads);
      const Orientation found = mesh.orientation(validity.data());
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

//------------------------------------------------------------------------------
std::optional<MeshSpace> PieceOrientations::space(unsigned int flatIndex) const
{
  return flatIndex < this->Spaces.size() ? this->Spaces[flatIndex] : std::nullopt;
}
}
