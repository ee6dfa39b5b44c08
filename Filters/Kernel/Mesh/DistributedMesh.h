// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DistributedMesh.h
 * @brief A mesh whose cells are distributed over ranks: global numbers, owners, halos, exchange.
 */
#ifndef tautline_DistributedMesh_h
#define tautline_DistributedMesh_h

#include "Mesh.h"
#include "tautline/Core/NumberIntervals.h"
#include "tautline/Core/RankGroup.h"

#include <vector>

namespace tautline
{
class TakenCells;

/// The part of the mesh on a rank; the arrays are only needed during construction.
struct MeshPiece
{
  MeshView view; ///< may be empty
  /// One id per point, the same on all ranks for the same point; or null, on all ranks with points:
  /// points with the same coordinates (0 and -0 are equal) are identified, also within a rank.
  const Index* globalIds = nullptr;
  /// One flag per cell, nonzero for a copy of a cell that another rank has (ghost); or null.
  const unsigned char* ghosts = nullptr;
  /// Whether the points are repartitioned among the ranks by a k-d tree of their coordinates: each
  /// rank then owns about the same number, regardless of their origin. Otherwise a rank owns points
  /// that it has. The same on all ranks.
  bool divideAnew = false;
  /// The rank that must own each point of a non-ghost cell, the same on all ranks for the same
  /// point, instead of a division; or null, on all ranks with points.
  const int* owners = nullptr;
  /// Whether cells that are copies of each other, with the same points and orientation, are treated
  /// as one, as where pieces overlap. Otherwise copies on different ranks are an Error. The same on
  /// all ranks.
  bool dropCopies = false;
  /// One flag per point: nonzero if it moves with an identical point of an element on any rank
  /// although no local cell has it, like the points of a surface whose volume is on another rank;
  /// or null. Without such an element, it is ignored.
  const unsigned char* followers = nullptr;
};

/**
 * @class tautline::DistributedMesh
 * @brief The cells around the points that this rank owns, numbered independently of the
 * decomposition of the mesh.
 *
 * Each point has a global number, 0 to globalPoints() - 1, along a space-filling curve of the
 * coordinates; ties are broken by the coordinates and by the given ids. It is owned by one of the
 * ranks that have it, or by any rank (MeshPiece::divideAnew, owners). A rank receives all cells
 * that have one of its owned points (a halo of vertex neighborhoods), in an order determined by the
 * numbers of their points. Results at an owned point are therefore bitwise identical for any owner.
 *
 * Local points are sorted by number: owned points, points of halo cells, and points of the piece.
 * Every cell is owned by the rank that owns its point of the lowest number.
 *
 * All methods except const accessors are collective.
 */
class TAUTLINE_KERNEL_EXPORT DistributedMesh
{
public:
  /**
   * @brief Throws Error on all ranks if, on any rank, a piece is malformed, a point used by cells
   * is not finite, ids are missing on some ranks or negative, or one id is at two locations.
   * @param group must outlive the mesh
   */
  DistributedMesh(RankGroup& group, const MeshPiece& piece);

  RankGroup& group() const { return *this->Group; }
  Index globalPoints() const { return this->GlobalPoints; } ///< only points of cells
  Index globalCells() const { return this->GlobalCells; }   ///< without ghosts
  /// The copies that were dropped, see MeshPiece::dropCopies.
  Index droppedCells() const { return this->DroppedCells; }
  /// Low x y z and high x y z of all points of cells; zero if there are none.
  const std::array<double, 6>& bounds() const { return this->Bounds; }

  /// The local part; its coordinates are points().
  const MeshView& view() const { return this->View; }
  std::vector<double>& points() { return this->Points; }
  const std::vector<double>& points() const { return this->Points; }
  Index localPoints() const { return static_cast<Index>(this->Numbers.size()); }
  /// Per local point, in increasing order.
  const std::vector<Index>& numbers() const { return this->Numbers; }
  /// The local point of a global number, or -1.
  Index local(Index number) const;
  /// Per local point: the rank that owns it.
  const std::vector<int>& owners() const { return this->Owners; }
  /// Among the ranks with a cell at a point, the one with the smallest hash owns it, unless the
  /// points are repartitioned or have owners; ties go to the lowest rank.
  static std::uint64_t ownerHash(Index number, int rank);
  bool owned(Index point) const { return this->Owners[point] == this->Group->rank(); }
  /// One flag per local cell: whether this rank owns it.
  const std::vector<unsigned char>& ownedCells() const { return this->OwnedCells; }
  /// Per point of the piece: the local point, or -1 for a point without a cell.
  const std::vector<Index>& localOfPiece() const { return this->LocalOfPiece; }
  /// The number of ranks with which this one exchanges values.
  int neighbours() const { return static_cast<int>(this->Halo.size()); }
  /// The number of local points owned by others, whose values are received in an exchange.
  Index haloPoints() const;

  /// Sends the values of owned points to all ranks that have these points: `components` per local
  /// point, packed once per neighbor.
  void exchange(double* values, int components) const;
  void exchange(unsigned char* flags) const;
  /// The points of a set that are sent to and received from each rank.
  struct Subset
  {
    struct Neighbour
    {
      int rank;
      std::vector<std::int32_t> sent, received; ///< local points
    };
    std::vector<Neighbour> neighbours;
  };
  /// The part of the exchange for points with nonzero flags: one per local point; the flags of the
  /// owner are used.
  Subset subset(const std::vector<unsigned char>& flags) const;
  void exchange(const Subset& subset, double* values, int components) const;
  /// Combines flags of local points at their owners by logical or, and sends them back to all
  /// ranks.
  void either(unsigned char* flags) const;

  /**
   * @brief Sets of points no two of which share a cell, by coloring in the order of a hash of the
   * numbers: independent of the ranks.
   * @param wanted one flag per local point: nonzero for points to color (the flags of the owner are
   *   used)
   * @return per local point: the number of its set, or -1
   */
  std::vector<int> independentSets(const std::vector<unsigned char>& wanted) const;

private:
  struct PointKey;
  struct SentPoint;
  void build(const MeshPiece& piece);
  void addFollowers(const MeshPiece& piece, std::vector<char>& used) const;
  void findBounds(const MeshPiece& piece, const std::vector<char>& used);
  std::vector<PointKey> makeKeys(const MeshPiece& piece, const std::vector<char>& used);
  void numberPoints(const MeshPiece& piece, const std::vector<char>& used);
  std::vector<PointKey> distribute(const std::vector<PointKey>& keys) const;
  void takeCells(const MeshPiece& piece, const std::vector<char>& used);
  void dropCopies(TakenCells& taken);
  void copyCells(const TakenCells& taken);
  void takePoints(
    const MeshPiece& piece, const std::vector<char>& used, std::vector<SentPoint>& points);
  void exchangePoints(
    const MeshPiece& piece, const std::vector<char>& used, std::vector<std::vector<Index>> needed);
  std::vector<std::vector<std::int32_t>> exchangeCells(
    const MeshPiece& piece, const std::vector<char>& used);
  void connect();

  RankGroup* Group;
  Index GlobalPoints = 0, GlobalCells = 0, DroppedCells = 0;
  std::array<double, 6> Bounds = { 0, 0, 0, 0, 0, 0 };
  std::vector<Index> PieceNumbers; ///< per point of the piece; -1 for a point without a cell
  std::vector<int> PieceOwners;
  std::vector<Index> Numbers, LocalOfPiece;
  NumberIntervals Intervals; ///< of the numbers
  std::vector<int> Owners;
  std::vector<double> Points;
  std::vector<unsigned char> CellTypes, OwnedCells;
  std::vector<Index> Offsets, Connectivity;
  MeshView View;
  std::vector<Subset::Neighbour> Halo;
};
}
#endif
