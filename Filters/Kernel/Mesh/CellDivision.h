// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellDivision.h
 * @brief Cells that ranks send each other so that each has a part, and values that go to the parts
 * and back to the pieces.
 * Internal: not installed.
 */
#ifndef tautline_CellDivision_h
#define tautline_CellDivision_h

#include "Mesh.h"
#include "tautline/Core/RankGroup.h"

#include <vector>

namespace tautline
{
/**
 * @brief The rank of each point by a k-d tree of the points of cells: boxes of about as many.
 * Collective.
 * @param ghosts one flag per cell, nonzero for those whose points do not count; or null
 * @return per point of the piece; -1 for one that no cell has, or that is not finite
 */
TAUTLINE_KERNEL_EXPORT std::vector<int> ownersByTree(
  RankGroup& group, const MeshView& piece, const unsigned char* ghosts);

/**
 * @class tautline::CellDivision
 * @brief The cells of the pieces of a mesh in parts: each goes to one rank, with its points.
 *
 * A cell goes to the highest of the ranks that own its points; then the lowest rank that has a
 * point, which has its rows (see PointNumbering), is the owner of nearly every point. A cell whose
 * points have no owner stays, and so do points without a cell. A part has the cells in the order of
 * the ranks they come from, and of their pieces. All methods are collective but for const
 * accessors.
 */
class TAUTLINE_KERNEL_EXPORT CellDivision
{
public:
  /**
   * @param piece all cells of this rank, also ghosts, which go like others
   * @param ids one per point, the same on all ranks for the same point, each once in a piece
   * @param owners one rank per point, or -1; copies of a point may have different ones
   * @param group must outlive this object
   */
  CellDivision(
    RankGroup& group, const MeshView& piece, const Index* ids, const std::vector<int>& owners);
  CellDivision(const CellDivision&) = delete;
  CellDivision& operator=(const CellDivision&) = delete;

  RankGroup& group() const { return this->Group; }
  /// The part of this rank.
  const MeshView& view() const { return this->View; }
  /// Of the points of the part; each is there once.
  const std::vector<Index>& ids() const { return this->Ids; }

  /// Values of the pieces, `components` per point, as those of the parts: of the copies of a point
  /// that of the lowest rank.
  template <class Value>
  std::vector<Value> pointsToParts(const std::vector<Value>& values, int components) const
  {
    return this->move(
      values, components, this->PiecePoints, this->PartPoints, this->View.numberOfPoints);
  }
  /// The same of cells.
  template <class Value>
  std::vector<Value> cellsToParts(const std::vector<Value>& values, int components) const
  {
    return this->move(
      values, components, this->PieceCells, this->PartCells, this->View.numberOfCells);
  }
  /// Values of the parts as those of the pieces.
  template <class Value>
  std::vector<Value> pointsToPieces(const std::vector<Value>& values, int components) const
  {
    return this->move(values, components, this->PartPoints, this->PiecePoints, this->PointsOfPiece);
  }
  template <class Value>
  std::vector<Value> cellsToPieces(const std::vector<Value>& values, int components) const
  {
    return this->move(values, components, this->PartCells, this->PieceCells, this->CellsOfPiece);
  }

private:
  using Lists = std::vector<std::vector<Index>>; ///< per rank

  void file(const MeshView& piece, const std::vector<int>& owners);
  std::vector<std::vector<Index>> cellLists(const MeshView& piece) const;
  void take(const std::vector<Index>& cells, const std::vector<Index>& points);

  template <class Value>
  std::vector<Value> move(const std::vector<Value>& values, int components, const Lists& from,
    const Lists& to, Index count) const
  {
    std::vector<std::vector<Value>> sent;
    std::vector<Value> result;
    result.resize(static_cast<std::size_t>(components * count));
    for (const std::vector<Index>& list : from)
    {
      sent.emplace_back();
      sent.back().reserve(components * list.size());
      for (const Index item : list)
      {
        const auto begin = values.begin() + components * item;
        sent.back().insert(sent.back().end(), begin, begin + components);
      }
    }
    const std::vector<std::vector<Value>> received = this->Group.exchangeItems(sent);
    for (std::size_t rank = to.size(); rank-- > 0;) // the lowest one prevails
    {
      for (std::size_t i = 0; i < to[rank].size(); ++i)
      {
        std::copy_n(received[rank].begin() + static_cast<std::ptrdiff_t>(components * i),
          components, result.begin() + components * to[rank][i]);
      }
    }
    return result;
  }

  RankGroup& Group;
  Index PointsOfPiece, CellsOfPiece;
  Lists PiecePoints, PieceCells; ///< that go to each rank
  Lists PartPoints, PartCells;   ///< that come from each rank
  std::vector<Index> Ids;
  std::vector<double> Points;
  std::vector<unsigned char> Types;
  std::vector<Index> Offsets = { 0 }, Connectivity;
  MeshView View;
};
}
#endif
