// SPDX-License-Identifier: BSD-3-Clause
#include "CellDivision.h"

#include "PointDivision.h"

#include <cmath>
#include <numeric>
#include <unordered_map>

namespace tautline
{
namespace
{
/// A point that is sent.
struct SentPoint
{
  Index id;
  double x[3];
};

// entries before the points of a cell: its type and number of points
constexpr std::size_t CellHead = 2;
}

//------------------------------------------------------------------------------
std::vector<int> ownersByTree(RankGroup& group, const MeshView& piece, const unsigned char* ghosts)
{
  enum Use : unsigned char
  {
    Unused = 0,
    OfGhost = 1,
    Counts = 2
  };
  std::vector<unsigned char> use;
  std::vector<Vec3> places;
  // 0 and -0 are the same location.
  const auto placeOf = [&piece](Index p) { return pointOf(piece, p) + Vec3{ 0, 0, 0 }; };
  use.assign(static_cast<std::size_t>(piece.numberOfPoints), Unused);
  for (Index cell = 0; cell < piece.numberOfCells; ++cell)
  {
    const unsigned char as = ghosts && ghosts[cell] ? OfGhost : Counts;
    for (Index n = piece.offsets[cell]; n < piece.offsets[cell + 1]; ++n)
    {
      unsigned char& of = use[piece.connectivity[n]];
      of = std::max(of, as);
    }
  }
  for (Index p = 0; p < piece.numberOfPoints; ++p)
  {
    const Vec3 x = placeOf(p);
    // Points that are not finite have no position in the tree.
    use[p] = std::isfinite(x[0] + x[1] + x[2]) ? use[p] : static_cast<unsigned char>(Unused);
    // Points of ghosts also get an owner, but only the points of own cells determine the tree.
    if (use[p] == Counts)
    {
      places.push_back(x);
    }
  }
  const PointDivision division(group, places);
  std::vector<int> owners;
  for (Index p = 0; p < piece.numberOfPoints; ++p)
  {
    owners.push_back(use[p] == Unused ? -1 : division.find(placeOf(p)));
  }
  return owners;
}

//------------------------------------------------------------------------------
CellDivision::CellDivision(
  RankGroup& group, const MeshView& piece, const Index* ids, const std::vector<int>& owners)
  : Group(group)
  , PointsOfPiece(piece.numberOfPoints)
  , CellsOfPiece(piece.numberOfCells)
{
  std::vector<std::vector<SentPoint>> points;
  Lists cells;
  this->file(piece, owners);
  cells = this->cellLists(piece);
  for (const std::vector<Index>& list : this->PiecePoints)
  {
    points.emplace_back();
    for (const Index p : list)
    {
      points.back().push_back({ ids[p], {} });
      std::copy_n(piece.points + 3 * p, 3, points.back().back().x);
    }
  }
  const std::vector<std::vector<SentPoint>> fromRanks = group.exchangeItems(points);
  points.clear();
  cells = group.exchangeItems(cells);
  std::unordered_map<Index, Index> known;
  this->PartPoints.resize(fromRanks.size());
  this->PartCells.resize(fromRanks.size());
  for (std::size_t rank = 0; rank < fromRanks.size(); ++rank)
  {
    for (const SentPoint& point : fromRanks[rank])
    {
      // A point that several ranks have sent is stored once.
      const auto [at, fresh] = known.emplace(point.id, static_cast<Index>(this->Ids.size()));
      this->PartPoints[rank].push_back(at->second);
      if (fresh)
      {
        this->Ids.push_back(point.id);
        this->Points.insert(this->Points.end(), point.x, point.x + 3);
      }
    }
    const auto first = static_cast<Index>(this->Types.size());
    this->take(cells[rank], this->PartPoints[rank]);
    this->PartCells[rank].resize(this->Types.size() - static_cast<std::size_t>(first));
    std::iota(this->PartCells[rank].begin(), this->PartCells[rank].end(), first);
  }
  this->View.numberOfPoints = static_cast<Index>(this->Ids.size());
  this->View.points = this->Points.data();
  this->View.numberOfCells = static_cast<Index>(this->Types.size());
  this->View.cellTypes = this->Types.data();
  this->View.offsets = this->Offsets.data();
  this->View.connectivity = this->Connectivity.data();
}

//------------------------------------------------------------------------------
/// Groups the cells and their points by the receiving rank.
void CellDivision::file(const MeshView& piece, const std::vector<int>& owners)
{
  const auto ranks = static_cast<std::size_t>(this->Group.size());
  const int self = this->Group.rank();
  this->PieceCells.resize(ranks);
  this->PiecePoints.resize(ranks);
  for (Index cell = 0; cell < piece.numberOfCells; ++cell)
  {
    // The highest rank of the owners of its points gets the cell, so that each cell goes to one
    // rank.
    int rank = -1;
    for (Index n = piece.offsets[cell]; n < piece.offsets[cell + 1]; ++n)
    {
      rank = std::max(rank, owners[piece.connectivity[n]]);
    }
    this->PieceCells[rank < 0 ? self : rank].push_back(cell);
  }
  // List each point once per rank: `last` is the last rank for which it was listed.
  std::vector<int> last(static_cast<std::size_t>(piece.numberOfPoints), -1);
  for (int rank = 0; rank < this->Group.size(); ++rank)
  {
    std::vector<Index>& points = this->PiecePoints[rank];
    for (const Index cell : this->PieceCells[rank])
    {
      for (Index n = piece.offsets[cell]; n < piece.offsets[cell + 1]; ++n)
      {
        const Index point = piece.connectivity[n];
        if (last[point] != rank)
        {
          last[point] = rank;
          points.push_back(point);
        }
      }
    }
  }
  // Points without cells stay on this rank.
  for (Index p = 0; p < piece.numberOfPoints; ++p)
  {
    if (last[p] < 0)
    {
      this->PiecePoints[self].push_back(p);
    }
  }
}

//------------------------------------------------------------------------------
/// The cells that go to each rank: type, number of points, and the positions of the points in its
/// list.
std::vector<std::vector<Index>> CellDivision::cellLists(const MeshView& piece) const
{
  Lists lists;
  std::vector<Index> place(static_cast<std::size_t>(piece.numberOfPoints));
  for (std::size_t rank = 0; rank < this->PieceCells.size(); ++rank)
  {
    const std::vector<Index>& points = this->PiecePoints[rank];
    // The table is reused: only the entries of the points of this rank are valid.
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      place[points[i]] = static_cast<Index>(i);
    }
    lists.emplace_back();
    for (const Index cell : this->PieceCells[rank])
    {
      const Index begin = piece.offsets[cell], end = piece.offsets[cell + 1];
      lists.back().push_back(piece.cellTypes[cell]);
      lists.back().push_back(end - begin);
      for (Index n = begin; n < end; ++n)
      {
        lists.back().push_back(place[piece.connectivity[n]]);
      }
    }
  }
  return lists;
}

//------------------------------------------------------------------------------
/// Adds the cells from a rank. @param points of the part, by position in its list
void CellDivision::take(const std::vector<Index>& cells, const std::vector<Index>& points)
{
  for (std::size_t i = 0; i < cells.size();)
  {
    const std::size_t end = i + CellHead + static_cast<std::size_t>(cells[i + 1]);
    this->Types.push_back(static_cast<unsigned char>(cells[i]));
    for (i += CellHead; i < end; ++i)
    {
      this->Connectivity.push_back(points[cells[i]]);
    }
    this->Offsets.push_back(static_cast<Index>(this->Connectivity.size()));
  }
}
}
