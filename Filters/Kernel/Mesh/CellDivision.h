// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellDivision.h
 * @brief Redistributes cells so that each rank has a part, and transfers values to the parts and
 * back to the pieces.
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
 * @brief The rank of each point, by a k-d tree of the points of cells: boxes of about equal numbers
 * of points. Collective.
 * @param ghosts one flag per cell: nonzero if its points are ignored; or null
 * @return per point of the piece; -1 if no cell has it or it is not finite
 */
TAUTLINE_KERNEL_EXPORT std::vector<int> ownersByTree(
  RankGroup& group, const MeshView& piece, const unsigned char* ghosts);

/**
 * @class tautline::CellDivision
 * @brief Divides the cells of the pieces of a mesh into parts: each goes to one rank, with its
 * points.
 *
 * A cell goes to the highest of the ranks that own its points; then the lowest rank that has a
 * point, which has its rows (see PointNumbering), is the owner of nearly every point. Cells whose
 * points have no owner stay, as do points without a cell. A part has the cells in the order of
 * their source ranks, then of their pieces. All methods except const accessors are collective.
 */
class TAUTLINE_KERNEL_EXPORT CellDivision
{
public:
  /**
   * @param piece all cells of this rank, including ghosts, which are sent like others
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
  /// The ids of the points of the part; each occurs once.
  const std::vector<Index>& ids() const { return this->Ids; }

  /// Transfers values of the pieces, `components` per point, to the parts: of the copies of a
  /// point, the value of the lowest rank is used.
  template <class Value>
  std::vector<Value> pointsToParts(const std::vector<Value>& values, int components) const
  {
    return this->move(
      values, components, this->PiecePoints, this->PartPoints, this->View.numberOfPoints);
  }
  /// The same for cells.
  template <class Value>
  std::vector<Value> cellsToParts(const std::vector<Value>& values, int components) const
  {
    return this->move(
      values, components, this->PieceCells, this->PartCells, this->View.numberOfCells);
  }
  /// Transfers values of the parts to the pieces.
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
    for (std::size_t rank = to.size(); rank-- > 0;) // the lowest rank prevails
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
