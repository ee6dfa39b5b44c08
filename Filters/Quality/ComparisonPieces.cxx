// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonPieces.h"

#include "RankMesh.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Quality/Compare.h"

#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr char OtherBlocks[] = "not all processes have the same blocks of both meshes";

/// The global ids of the points of a piece; empty if it has none.
std::vector<Index> idsOf(vtkDataSet* piece)
{
  std::vector<Index> ids;
  vtkDataArray* given = piece->GetPointData()->GetGlobalIds();
  for (vtkIdType p = 0; given && p < piece->GetNumberOfPoints(); ++p)
  {
    ids.push_back(static_cast<Index>(given->GetComponent(p, 0)));
  }
  return ids;
}

/// A piece of one of the meshes while it is matched.
struct MatchedPiece
{
  vtkDataSet* data;
  std::unique_ptr<MeshAdapter> adapter;
  std::vector<Index> ids;
  RankPiece piece;
};

std::vector<RankPiece> piecesOf(const std::vector<MatchedPiece>& matched)
{
  std::vector<RankPiece> pieces;
  for (const MatchedPiece& one : matched)
  {
    pieces.push_back(one.piece);
  }
  return pieces;
}

/// A piece with the same cells and other places of its points.
vtkSmartPointer<vtkDataSet> withPoints(vtkDataSet* piece, const std::vector<double>& points)
{
  auto moved = vtkSmartPointer<vtkDataSet>::Take(piece->NewInstance());
  moved->CopyStructure(piece);
  if (auto* set = vtkPointSet::SafeDownCast(moved))
  {
    set->SetPoints(makePoints(points, nullptr));
    return moved;
  }
  const MeshAdapter given(piece);
  const double* here = given.mesh().view().points;
  if (!std::equal(points.begin(), points.end(), here))
  {
    throw Error(std::string("The points of ") + piece->GetClassName() +
      " are implicit, and the two meshes are not cut alike: run Image Data to Point Set or "
      "Rectilinear Data to Point Set first, which give them coordinates.");
  }
  return moved;
}
}

//------------------------------------------------------------------------------
std::unique_ptr<ComparisonPieces> ComparisonPieces::take(
  RankGroup& group, vtkDataObject* before, vtkDataObject* after, int threads, std::string& why)
{
  why.clear();
  const bool here = group.rank() > 0 &&
    (before->GetNumberOfElements(vtkDataObject::CELL) > 0 ||
      after->GetNumberOfElements(vtkDataObject::CELL) > 0);
  if (!group.any(here))
  {
    return nullptr; // all is on the first process
  }
  Leaves first, second;
  int groups = 0, others = 0;
  group.together(
    [&]
    {
      first = listPieces(before, groups);
      second = listPieces(after, others);
    });
  const bool composite = vtkCompositeDataSet::SafeDownCast(before) != nullptr;
  const int most = static_cast<int>(group.maximum(static_cast<Index>(groups)));
  const bool alike = groups == others && groups == most &&
    composite == (vtkCompositeDataSet::SafeDownCast(after) != nullptr);
  if (group.any(!alike) || (group.any(composite) && group.any(!composite)))
  {
    why = OtherBlocks;
    return nullptr;
  }
  std::unique_ptr<ComparisonPieces> result(new ComparisonPieces(group, threads));
  result->pairOrMatch(first, second, groups);
  result->requireDistinctCells(groups);
  why = result->settle(groups);
  return why.empty() ? std::move(result) : nullptr;
}

//------------------------------------------------------------------------------
void ComparisonPieces::pairOrMatch(const Leaves& before, const Leaves& after, int groups)
{
  bool sameIds = true;
  const bool alike = this->pair(before, after, sameIds);
  if (alike && sameIds)
  {
    return;
  }
  try
  {
    this->match(before, after, groups);
  }
  catch (const Error&) // on all processes
  {
    if (!alike)
    {
      throw;
    }
    // The ids are not those of one mesh; the order of points and cells counts, as on one process.
    this->pair(before, after, sameIds);
  }
}

//------------------------------------------------------------------------------
/// Whether the pieces of one mesh are those of the other one, on all processes.
/// @param sameIds gets whether their points have the same global ids, if they have some
bool ComparisonPieces::pair(const Leaves& before, const Leaves& after, bool& sameIds)
{
  bool alike = before.size() == after.size(), same = true;
  this->Pieces.clear();
  this->Group.together(
    [&]
    {
      for (std::size_t i = 0; alike && i < after.size(); ++i)
      {
        ComparedPiece piece;
        piece.group = after[i].group;
        piece.after = after[i].data;
        piece.before = before[i].data;
        alike = before[i].group == piece.group;
        if (!alike)
        {
          break;
        }
        piece.was = std::make_unique<MeshAdapter>(piece.before, this->Threads);
        piece.is = std::make_unique<MeshAdapter>(piece.after, this->Threads);
        piece.ids = idsOf(piece.before);
        const std::vector<Index> others = idsOf(piece.after);
        alike = connectivityDifference(piece.was->mesh(), piece.is->mesh()).empty();
        same = same && (piece.ids.empty() || others.empty() || piece.ids == others);
        this->Pieces.push_back(std::move(piece));
      }
    });
  sameIds = !this->Group.any(!same);
  return !this->Group.any(!alike);
}

//------------------------------------------------------------------------------
/// Brings the points of the first mesh to the pieces of the second.
void ComparisonPieces::match(const Leaves& before, const Leaves& after, int groups)
{
  this->Pieces.clear();
  for (int g = 0; g < groups; ++g)
  {
    std::vector<MatchedPiece> first, second;
    this->Group.together(
      [&]
      {
        const auto list = [&](const Leaves& leaves, std::vector<MatchedPiece>& pieces)
        {
          for (const GroupedPiece& leaf : leaves)
          {
            if (leaf.group == g && leaf.data->GetNumberOfPoints() > 0)
            {
              pieces.push_back({ leaf.data, std::make_unique<MeshAdapter>(leaf.data, this->Threads),
                idsOf(leaf.data), {} });
              MatchedPiece& made = pieces.back();
              made.piece = { &made.adapter->mesh(), made.adapter->ghostCells(),
                made.ids.empty() ? nullptr : made.ids.data() };
            }
          }
        };
        list(before, first);
        list(after, second);
      });
    const auto places = pointsInOther(this->Group, piecesOf(second), piecesOf(first));
    this->Group.together(
      [&]
      {
        std::size_t next = 0;
        for (const GroupedPiece& leaf : after)
        {
          if (leaf.group != g)
          {
            continue;
          }
          ComparedPiece piece;
          piece.group = g;
          piece.after = leaf.data;
          const bool filled = leaf.data->GetNumberOfPoints() > 0;
          piece.before = leaf.data;
          if (filled)
          {
            piece.before = withPoints(leaf.data, places[next]);
          }
          piece.ids = idsOf(leaf.data);
          piece.is = filled ? std::move(second[next++].adapter)
                            : std::make_unique<MeshAdapter>(leaf.data, this->Threads);
          piece.was = std::make_unique<MeshAdapter>(piece.before, this->Threads);
          this->Pieces.push_back(std::move(piece));
        }
      });
  }
}

//------------------------------------------------------------------------------
/// Throws Error, on all processes, if several cells that are not marked as ghosts have one global
/// id in one of the meshes. Each id has a process that gets it from all that have a cell with it.
void ComparisonPieces::requireDistinctCells(int groups)
{
  const auto size = static_cast<std::size_t>(this->Group.size());
  for (int k = 0; k < 2 * groups; ++k)
  {
    const bool after = k % 2 == 1;
    std::vector<std::vector<Index>> sent(size);
    bool lacking = false;
    this->Group.together(
      [&]
      {
        for (const ComparedPiece& piece : this->Pieces)
        {
          vtkDataSet* data = after ? piece.after : piece.before.Get();
          if (piece.group != k / 2 || data->GetNumberOfCells() == 0)
          {
            continue;
          }
          vtkDataArray* ids = data->GetCellData()->GetGlobalIds();
          const unsigned char* ghosts = (after ? piece.is : piece.was)->ghostCells();
          lacking = lacking || !ids;
          for (vtkIdType cell = 0; ids && cell < data->GetNumberOfCells(); ++cell)
          {
            const auto id = static_cast<Index>(ids->GetComponent(cell, 0));
            if (!ghosts || !ghosts[cell])
            {
              sent[static_cast<std::size_t>(id) % size].push_back(id);
            }
          }
        }
      });
    if (this->Group.any(lacking))
    {
      continue;
    }
    const std::vector<std::vector<Index>> received = this->Group.exchangeItems(sent);
    this->Group.together(
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
          throw Error(std::string("Several cells of the ") + (after ? "second" : "first") +
            " mesh have the global id " + std::to_string(*twice) +
            " and are not marked as ghost cells: run Generate Global Ids again, and keep the array "
            "vtkGhostType.");
        }
      });
  }
}

//------------------------------------------------------------------------------
/// The pieces of one of the meshes; with global ids if all have some.
std::vector<RankPiece> ComparisonPieces::ofGroup(int group, bool after)
{
  std::vector<RankPiece> pieces;
  bool lacking = false;
  for (const ComparedPiece& piece : this->Pieces)
  {
    if (piece.group == group && piece.after->GetNumberOfPoints() > 0)
    {
      pieces.push_back(
        { &(after ? piece.is : piece.was)->mesh(), piece.skip.empty() ? nullptr : piece.skip.data(),
          piece.ids.empty() ? nullptr : piece.ids.data() });
      lacking = lacking || piece.ids.empty();
    }
  }
  if (this->Group.any(lacking))
  {
    for (RankPiece& piece : pieces)
    {
      piece.globalIds = nullptr;
    }
  }
  return pieces;
}

//------------------------------------------------------------------------------
/// Gives the pieces what they need to know of the whole. @return why that is not possible, or ""
std::string ComparisonPieces::settle(int groups)
{
  bool extreme = false;
  this->Group.together(
    [&]
    {
      for (ComparedPiece& piece : this->Pieces)
      {
        const unsigned char *was = piece.was->ghostCells(), *is = piece.is->ghostCells();
        for (Index cell = 0; (was || is) && cell < piece.after->GetNumberOfCells(); ++cell)
        {
          piece.skip.push_back((was && was[cell]) || (is && is[cell]));
        }
        for (const MeshAdapter* adapter : { piece.was.get(), piece.is.get() })
        {
          const CoordinateRange range = coordinateRange(adapter->mesh().view());
          extreme = extreme || !CoordinateFrame(range, false).isIdentity();
        }
      }
    });
  if (this->Group.any(extreme))
  {
    return "its coordinates are of extreme size";
  }
  for (int g = 0; g < groups; ++g)
  {
    for (const bool after : { false, true })
    {
      const MeshSpace space = spaceOnRanks(this->Group, this->ofGroup(g, after));
      for (ComparedPiece& piece : this->Pieces)
      {
        if (piece.group == g)
        {
          (after ? piece.is : piece.was)->mesh().setSpace(space);
        }
      }
    }
    const std::string why = this->settleOrientation(g);
    if (!why.empty())
    {
      return why;
    }
  }
  return "";
}

//------------------------------------------------------------------------------
/// Mirrors both meshes if both are reversed. @return why they have to be gathered, or ""
std::string ComparisonPieces::settleOrientation(int group)
{
  const auto orientation = [&](bool after)
  {
    const std::vector<RankPiece> pieces = this->ofGroup(group, after);
    std::vector<std::vector<signed char>> validity;
    std::vector<const signed char*> values;
    this->Group.together(
      [&]
      {
        for (const RankPiece& piece : pieces)
        {
          validity.emplace_back(piece.mesh->view().numberOfCells);
          piece.mesh->classifyCells(validity.back().data(), this->Threads);
          values.push_back(validity.back().data());
        }
      });
    return orientationOnRanks(this->Group, pieces, values).state;
  };
  const auto isSurface = [&](bool after)
  {
    return this->Group.any(std::any_of(this->Pieces.begin(), this->Pieces.end(),
      [=](const ComparedPiece& piece)
      {
        return piece.group == group &&
          (after ? piece.is : piece.was)->mesh().dimension() == Dimension::Surface;
      }));
  };
  // The cells of a surface have no sign; where one of the meshes is flat, its cells have one.
  if (isSurface(false) && isSurface(true))
  {
    return "";
  }
  const Orientation::State before = orientation(false);
  if (before == Orientation::Mixed)
  {
    return oppositeOrders;
  }
  if (before == Orientation::Reversed && orientation(true) == Orientation::Reversed)
  {
    for (ComparedPiece& piece : this->Pieces)
    {
      if (piece.group == group)
      {
        piece.was->mesh().setMirrored(true);
        piece.is->mesh().setMirrored(true);
      }
    }
  }
  return "";
}
}
