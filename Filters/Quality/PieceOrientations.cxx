// SPDX-License-Identifier: BSD-3-Clause
#include "PieceOrientations.h"

#include "Blocks.h"
#include "MeshAdapter.h"
#include "MeshGroups.h"
#include "PieceFindings.h"
#include "vtkElementQuality.h"

#include "vtkDataObjectTree.h"
#include "vtkDataSet.h"
#include "vtkPointData.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
std::string describeOrder(const RankOrder& found, Dimension dimension, int mode)
{
  if (mode == vtkElementQuality::MEASURE_AS_GIVEN)
  {
    const std::string text = describe(found.orientation, dimension);
    return text + (text.empty() ? "" : " Cells of negative size count as inverted.");
  }
  const bool flipped = found.order.reversed > 0 || found.orientation.state == Orientation::Reversed;
  return describe(found, dimension) +
    (flipped && mode == vtkElementQuality::FLIP_OUTPUT ? " These cells are flipped in the output."
                                                       : "");
}

//------------------------------------------------------------------------------
void PieceOrientations::find(
  vtkDataObject* input, int threads, RankGroup& group, int mode, bool elements)
{
  std::map<int, std::vector<vtkDataSet*>> meshes;
  const auto add = [&meshes](int number, vtkDataSet* data)
  {
    if (data->GetNumberOfCells() > 0)
    {
      meshes[number].push_back(data);
    }
  };
  if (vtkDataObjectTree::SafeDownCast(input))
  {
    int groups = 0;
    for (const GroupedPiece& piece : listPieces(input, groups))
    {
      add(piece.group, piece.data);
    }
  }
  else
  {
    forEachLeaf(
      input, [&add](unsigned int index, vtkDataSet* data) { add(static_cast<int>(index), data); });
  }
  const Index size = group.maximum(meshes.empty() ? Index(0) : Index(meshes.rbegin()->first) + 1);
  for (Index index = 0; index < size; ++index)
  {
    this->Meshes.push_back(meshes[static_cast<int>(index)]);
    this->findMesh(this->Meshes.back(), threads, group, mode, elements);
  }
}

//------------------------------------------------------------------------------
/// @param data the pieces of this process, with cells
void PieceOrientations::findMesh(
  const std::vector<vtkDataSet*>& data, int threads, RankGroup& group, int mode, bool elements)
{
  const std::size_t count = data.size();
  std::vector<std::unique_ptr<MeshAdapter>> adapters(count);
  std::vector<std::vector<unsigned char>> skips(count);
  std::vector<std::vector<Index>> ids(count);
  std::vector<RankPiece> pieces;
  this->Found.push_back(std::make_unique<WholeOrientation>());
  WholeOrientation& whole = *this->Found.back();
  for (std::size_t i = 0; i < count; ++i)
  {
    adapters[i] = std::make_unique<MeshAdapter>(data[i], threads);
    skips[i] = cellsToSkip(*adapters[i]);
    ids[i] = idsOf(data[i]->GetPointData()->GetGlobalIds());
    pieces.push_back({ &adapters[i]->mesh(), skips[i].empty() ? nullptr : skips[i].data(),
      ids[i].empty() ? nullptr : ids[i].data() });
    this->Pieces[data[i]] = { &whole, i };
  }
  whole.space = spaceOf(group, pieces);
  const bool lacking =
    group.any(std::any_of(ids.begin(), ids.end(), [](const auto& list) { return list.empty(); }));
  std::vector<std::vector<signed char>> validity(count);
  std::vector<const signed char*> validities;
  for (std::size_t i = 0; i < count; ++i)
  {
    Mesh& mesh = adapters[i]->mesh();
    mesh.setSpace(whole.space);
    validity[i].resize(mesh.view().numberOfCells);
    mesh.classifyCells(validity[i].data(), threads);
    validities.push_back(validity[i].data());
    pieces[i].ghosts = adapters[i]->ghostCells();
    pieces[i].globalIds = lacking ? nullptr : pieces[i].globalIds;
  }
  whole.order = consistentOrder(group, pieces, validities);
  std::vector<PieceFindings> findings;
  const bool reversed = whole.order.order.reversed > 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    findings.push_back(findingsOf(*adapters[i], reversed ? whole.order.reverse[i].data() : nullptr,
      skips[i].empty() ? nullptr : skips[i].data(), 0, elements));
  }
  const std::string remarks = describeFindings(group, findings);
  if (group.rank() == 0)
  {
    for (const std::string& sentences :
      { describeOrder(whole.order, whole.space.dimension, mode), remarks })
    {
      this->Notice += (this->Notice.empty() || sentences.empty() ? "" : " ") + sentences;
    }
  }
}

//------------------------------------------------------------------------------
const OrientedPiece* PieceOrientations::piece(vtkDataSet* data) const
{
  const auto found = this->Pieces.find(data);
  return found != this->Pieces.end() ? &found->second : nullptr;
}
}
