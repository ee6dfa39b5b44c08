// SPDX-License-Identifier: BSD-3-Clause
#include "HorizonPieces.h"

#include "Blocks.h"
#include "Processes.h"
#include "tautline/Mesh/RankPieces.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Cells that are left out; poly data has them before its triangles.
bool isVertexOrLine(unsigned char type)
{
  return type == VTK_VERTEX || type == VTK_POLY_VERTEX || type == VTK_LINE || type == VTK_POLY_LINE;
}

std::array<Index, 3> sortedCorners(const MeshView& view, Index triangle)
{
  const Index* corner = view.connectivity + view.offsets[triangle];
  std::array<Index, 3> sorted = { corner[0], corner[1], corner[2] };
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}
}

//------------------------------------------------------------------------------
std::unique_ptr<HorizonPieces> HorizonPieces::take(
  vtkDataObject* input, bool mergePoints, int threads)
{
  std::unique_ptr<HorizonPieces> result(new HorizonPieces);
  result->Pieces =
    takePieces(result->Group, input, threads, mergePoints, Redistribution::None, nullptr);
  if (!result->Pieces)
  {
    return nullptr;
  }
  result->requireTriangles();
  if (!result->isRegular(input))
  {
    return nullptr;
  }
  std::unique_ptr<Mesh> local;
  result->Group->together([&] { local = std::make_unique<Mesh>(result->view(), threads); });
  const RankPiece piece = { local.get(), nullptr, nullptr };
  const MeshSpace space = spaceOnRanks(*result->Group, { piece });
  const std::array<double, 6>& box = result->Pieces->mesh().bounds();
  result->Plane = HorizonPlane(space, { box[0], box[1], box[2] });
  result->order(vtkDataSet::SafeDownCast(input));
  return result;
}

//------------------------------------------------------------------------------
/// Throws Error for cells of other types, of which the whole mesh has some.
void HorizonPieces::requireTriangles() const
{
  const MeshView& piece = this->Pieces->piece();
  std::array<Index, NumberOfCellTypes> counts{};
  for (Index cell = 0; cell < piece.numberOfCells; ++cell)
  {
    const int type = topologyIndex(cornerType(piece.cellTypes[cell]));
    counts[std::max(type, 0)] += type >= 0 && !this->Pieces->skipped()[cell];
  }
  for (int type = 0; type < NumberOfCellTypes; ++type)
  {
    const Index count = this->Group->sum(counts[type]);
    if (topologies()[type].type != CellType::Triangle && count > 0)
    {
      throwNoTriangles(count, topologies()[type]);
    }
  }
}

//------------------------------------------------------------------------------
/// Whether the triangles are found as they are, and come after all other cells of the whole mesh.
bool HorizonPieces::isRegular(vtkDataObject* input) const
{
  const MeshView& piece = this->Pieces->piece();
  // Where one piece is a grid, the cells of all types are in one order.
  const bool poly = !this->Group->any(piece.numberOfPoints > 0 && !input->IsA("vtkPolyData"));
  const MeshView& local = this->view();
  bool regular = this->Pieces->inverted() == 0;
  for (Index cell = 0; cell < piece.numberOfCells; ++cell)
  {
    const unsigned char type = piece.cellTypes[cell];
    regular = regular && (cornerType(type) == CellType::Triangle || (poly && isVertexOrLine(type)));
  }
  // Triangles with the same corners are next to each other.
  for (Index cell = 1; cell < local.numberOfCells; ++cell)
  {
    regular = regular && sortedCorners(local, cell) != sortedCorners(local, cell - 1);
  }
  return !this->Group->any(!regular);
}

//------------------------------------------------------------------------------
/// Finds what orders the triangles.
void HorizonPieces::order(vtkDataSet* input)
{
  const MeshView& piece = this->Pieces->piece();
  const std::vector<unsigned char>& owned = this->Pieces->mesh().ownedCells();
  this->Group->together(
    [&]
    {
      for (Index cell = 0; cell < this->view().numberOfCells; ++cell)
      {
        if (owned[cell])
        {
          this->Owned.push_back(cell);
        }
      }
    });
  this->PointIds = this->Pieces->pointIds();
  vtkUnsignedCharArray* ghosts = input->GetCellGhostArray();
  Index before = 0;
  for (Index cell = 0; cell < piece.numberOfCells; ++cell)
  {
    const bool copy = ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL);
    before += isVertexOrLine(piece.cellTypes[cell]) && !copy;
  }
  this->Before = this->Group->sum(before);
  vtkDataArray* given = input->GetCellData()->GetGlobalIds();
  const Index filled = this->Group->sum(static_cast<Index>(piece.numberOfPoints > 0));
  this->Single = filled == 1;
  if (!this->Single && this->Group->any(piece.numberOfCells > 0 && !given))
  {
    return;
  }
  std::vector<double> ids;
  this->Group->together(
    [&]
    {
      for (Index cell = 0; cell < piece.numberOfCells; ++cell)
      {
        ids.push_back(this->Single ? static_cast<double>(cell) : given->GetComponent(cell, 0));
      }
    });
  const std::vector<double> local = this->Pieces->ofCells(ids, 1);
  this->Group->together([&] { this->CellIds.assign(local.begin(), local.end()); });
  if (!this->Single)
  {
    this->requireDistinctIds();
  }
}

//------------------------------------------------------------------------------
/// Throws Error, on all processes, if several triangles have one global id. Each id has a process
/// that gets it from all that own a triangle with it.
void HorizonPieces::requireDistinctIds() const
{
  const auto size = static_cast<std::size_t>(this->Group->size());
  std::vector<std::vector<Index>> sent(size);
  this->Group->together(
    [&]
    {
      for (const Index triangle : this->Owned)
      {
        const Index id = this->CellIds[triangle];
        sent[static_cast<std::size_t>(id) % size].push_back(id);
      }
    });
  const std::vector<std::vector<Index>> received = this->Group->exchangeItems(sent);
  this->Group->together(
    [&]
    {
      std::vector<Index> ids;
      for (const std::vector<Index>& ofRank : received)
      {
        ids.insert(ids.end(), ofRank.begin(), ofRank.end());
      }
      std::sort(ids.begin(), ids.end());
      const auto twice = std::adjacent_find(ids.begin(), ids.end());
      if (twice != ids.end())
      {
        throw Error("Several cells have the global id " + std::to_string(*twice) +
          " and are not marked as ghost cells: run Generate Global Ids again.");
      }
    });
}

//------------------------------------------------------------------------------
TriangleKey HorizonPieces::keyOf(Index triangle) const
{
  if (this->Single || !this->CellIds.empty())
  {
    return { this->CellIds[triangle], 0, 0 };
  }
  const Index* corner = this->view().connectivity + this->view().offsets[triangle];
  TriangleKey key;
  std::transform(
    corner, corner + 3, key.begin(), [this](Index point) { return this->PointIds[point]; });
  std::sort(key.begin(), key.end());
  return key;
}

//------------------------------------------------------------------------------
std::vector<Index> HorizonPieces::cellNumbers(const std::vector<TriangleKey>& keys) const
{
  const bool first = this->Group->rank() == 0;
  std::vector<Index> numbers;
  std::vector<std::vector<Index>> sent(this->Group->size());
  this->Group->together([&] { numbers.resize(keys.size(), 0); });
  if (this->Single)
  {
    std::transform(
      keys.begin(), keys.end(), numbers.begin(), [](const TriangleKey& key) { return key[0]; });
    return numbers;
  }
  // How many triangles of this process come before each.
  for (const Index triangle : this->Owned)
  {
    const auto next = std::upper_bound(keys.begin(), keys.end(), this->keyOf(triangle));
    if (next != keys.end())
    {
      ++numbers[next - keys.begin()];
    }
  }
  for (std::size_t i = 1; i < numbers.size(); ++i)
  {
    numbers[i] += numbers[i - 1];
  }
  sent[0] = std::move(numbers);
  this->Group->together([&] { numbers.assign(keys.size(), this->Before); });
  for (const std::vector<Index>& ofRank : this->Group->exchangeItems(sent))
  {
    for (std::size_t i = 0; first && i < ofRank.size(); ++i)
    {
      numbers[i] += ofRank[i];
    }
  }
  return numbers;
}

//------------------------------------------------------------------------------
bool havePointIds(vtkDataObject* input)
{
  bool have = true;
  forEachLeaf(input,
    [&have](unsigned int, vtkDataSet* data)
    { have = have && (data->GetNumberOfPoints() == 0 || data->GetPointData()->GetGlobalIds()); });
  return minimumOverProcesses(have ? 1 : 0) == 1;
}
}
