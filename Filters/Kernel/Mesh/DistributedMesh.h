// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DistributedMesh.h
 * @brief One mesh whose cells are spread over ranks: global numbers, owners, halos, exchange.
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

/// What a rank has of the mesh; the arrays must outlive the construction only.
struct MeshPiece
{
  MeshView view; ///< may be empty
  /// One id per point, the same on all ranks for the same point; or null, on all ranks with points:
  /// points with the same coordinates (0 and -0 are equal) are one, also within a rank.
  const Index* globalIds = nullptr;
  /// One flag per cell, nonzero for a copy of a cell that another rank has (ghost); or null.
  const unsigned char* ghosts = nullptr;
  /// Whether the points are divided anew among the ranks, by a k-d tree of their coordinates: each
  /// rank then owns about as many, whoever has them. Else a rank owns points that it has. The same
  /// on all ranks.
  bool divideAnew = false;
  /// The rank that shall own each point that a cell has which is no ghost, the same on all ranks
  /// for the same point, instead of a division; or null, on all ranks with points.
  const int* owners = nullptr;
  /// Whether cells that are copies of each other, with the same points in the same sense, count as
  /// one, as where pieces overlap. Else those of different ranks are an Error. The same on all
  /// ranks.
  bool dropCopies = false;
  /// One flag per point, nonzero for one that moves with the point of an element that is one with
  /// it, of any rank, though no cell given here has it, as the points of a surface whose volume is
  /// on another rank; or null. Without such an element it does not count.
  const unsigned char* followers = nullptr;
};

/**
 * @class tautline::DistributedMesh
 * @brief The cells about the points that this rank owns, numbered so that nothing depends on how
 * the mesh is cut.
 *
 * Each point has a global number, 0 to globalPoints() - 1, along a space-filling curve of the
 * coordinates; ties are broken by the coordinates and by the ids given. It is owned by one of the
 * ranks that have it, or by any (MeshPiece::divideAnew, owners). A rank gets all cells that have
 * one of its own points (halo of vertex neighbourhoods), in an order that follows from the numbers
 * of their points. So what is computed about an own point is bitwise the same whoever owns it.
 *
 * Local points come in the order of their numbers: own ones, those of the halo cells, and those of
 * the piece. Every cell is owned by the rank that owns its point of the lowest number.
 *
 * All methods are collective but for const accessors.
 */
class TAUTLINE_KERNEL_EXPORT DistributedMesh
{
public:
  /**
   * @brief Throws Error on all ranks, if on any a piece is malformed, a point that cells use is not
   * finite, ids are missing on some ranks or negative, or one id is at two places.
   * @param group must outlive the mesh
   */
  DistributedMesh(RankGroup& group, const MeshPiece& piece);

  RankGroup& group() const { return *this->Group; }
  Index globalPoints() const { return this->GlobalPoints; } ///< those that cells have
  Index globalCells() const { return this->GlobalCells; }   ///< ghosts do not count
  /// The copies that were dropped, see MeshPiece::dropCopies.
  Index droppedCells() const { return this->DroppedCells; }
  /// Low x y z and high x y z of all points that cells have; zero without one.
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
  /// Of the ranks with a cell at a point, the one with the least of these numbers owns it, unless
  /// the points are divided anew or have owners; of equal ones the lowest rank.
  static std::uint64_t ownerHash(Index number, int rank);
  bool owned(Index point) const { return this->Owners[point] == this->Group->rank(); }
  /// One flag per local cell: whether this rank owns it.
  const std::vector<unsigned char>& ownedCells() const { return this->OwnedCells; }
  /// Per point of the piece: the local point, or -1 for one without a cell.
  const std::vector<Index>& localOfPiece() const { return this->LocalOfPiece; }
  /// Ranks that this one exchanges values with.
  int neighbours() const { return static_cast<int>(this->Halo.size()); }
  /// Local points that others own, whose values are received in an exchange.
  Index haloPoints() const;

  /// Values of the points that this rank owns go to all that have these points: `components` per
  /// local point, packed once per neighbour.
  void exchange(double* values, int components) const;
  void exchange(unsigned char* flags) const;
  /// Which points of a set are sent to and received from each rank.
  struct Subset
  {
    struct Neighbour
    {
      int rank;
      std::vector<std::int32_t> sent, received; ///< local points
    };
    std::vector<Neighbour> neighbours;
  };
  /// The part of the exchange of points with nonzero flags: one per local point, the owner's count.
  Subset subset(const std::vector<unsigned char>& flags) const;
  void exchange(const Subset& subset, double* values, int components) const;
  /// Sends flags of local points to their owners, where nonzero ones stay, and back to all.
  void either(unsigned char* flags) const;

  /**
   * @brief Sets of points no two of which share a cell, by colouring in the order of a hash of the
   * numbers: they do not depend on the ranks.
   * @param wanted one flag per local point: those to colour (the owner's count)
   * @return per local point the number of its set, or -1
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
  std::vector<Index> PieceNumbers; ///< per point of the piece, -1 without a cell
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
