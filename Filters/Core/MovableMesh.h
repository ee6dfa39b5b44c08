// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MovableMesh.h
 * @brief The mesh of a filter that moves points: its orientation, its fixed points and its new
 * points.
 */
#ifndef tautline_MovableMesh_h
#define tautline_MovableMesh_h

#include "TautlineCoreModule.h" // for export macro

#include "MeshAdapter.h"
#include "Redistribution.h"
#include "tautline/Mesh/Ranks.h"

#include <memory>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkPointSet;

namespace tautline
{
struct BoundaryShape;
class CurvedMesh;

/// Neighbouring cells list their points in opposite orders, or parts of the mesh are reversed and
/// others are not: a mesh in pieces can be gathered.
class OppositeOrders : public Error
{
public:
  using Error::Error;
};

/// That as the reason of gatheredSentence().
constexpr const char* oppositeOrders =
  "neighbouring cells list their points in opposite orders, or parts of it are reversed and others "
  "are not";

/// "The mesh was put together on the first process: why.", or "" without a reason; a full stop at
/// the end of the reason is not doubled.
TAUTLINECORE_EXPORT std::string gatheredSentence(const std::string& why);

/**
 * @class tautline::MovableMesh
 * @brief A data set whose points can move: a mesh of this process alone, or one that each process
 * has a piece of.
 *
 * Alone, its orientation is made consistent, see MeshAdapter::orient(), and the points that move
 * are those of mesh().
 *
 * In pieces, the points that move are the local points of distributed(). Cells marked as ghosts
 * are copies. Points with the same coordinates are one, or, with mergePoints off, those with the
 * same global id. Copies of a point with the same global id whose places differ by rounding are
 * one, too, and get one place, see joinCopies(). All methods but const accessors are then
 * collective. The reproducible order of one process is the order of one piece.
 */
class TAUTLINECORE_EXPORT MovableMesh
{
public:
  /**
   * @brief A mesh of this process alone. Throws Error that names the remedy for points that are
   * implicit (image data), cells of higher order, no cell at all that is measured, and parts
   * without a consistent orientation.
   * @param mergePoints whether coincident points on seams are one: they move together
   * @param framed whether mesh() is in a frame of its own where cells are of extreme size or far
   * from the origin; all points and lengths given and taken here are then in it
   */
  MovableMesh(vtkDataSet* input, int threads, bool mergePoints, bool framed = false);
  /**
   * @brief The piece of this process. Throws Error if a piece is malformed, has implicit points or
   * cells of higher order, and OppositeOrders, on all processes, if neighbouring cells list their
   * points so. Collective.
   * @param group outlives the mesh
   */
  MovableMesh(RankGroup& group, vtkDataSet* input, int threads, bool mergePoints,
    Redistribution redistribution = Redistribution::None);

  /// As the constructor for pieces; what one process throws is thrown on all. Null, on all
  /// processes, if neighbouring cells list their points in opposite orders.
  static std::unique_ptr<MovableMesh> makePiece(RankGroup& group, vtkDataSet* input, int threads,
    bool mergePoints, Redistribution redistribution = Redistribution::None);

  /// Makes validity(), validityAt() and move() judge curved cells as a whole, where this is the
  /// mesh of their corners. Not in pieces.
  /// @param curved outlives the mesh
  void certifyBy(const CurvedMesh& curved);

  bool inPieces() const { return this->Spread != nullptr; }

  /// The mesh of this process, or its piece with all its cells as they are given.
  const Mesh& mesh() const { return this->Adapter.mesh(); }
  /// The same with the points that the cells have in the data set, for what is compared with it.
  const Mesh& given() const { return this->Adapter.given(); }
  /// One per point, see CoincidentPoints; empty if no points are one, and in pieces.
  const std::vector<Index>& representative() const
  {
    return this->Adapter.coincident().representative;
  }
  /// How mesh() is placed in the coordinates of the input.
  const CoordinateFrame& frame() const { return this->Adapter.frame(); }
  /// Points of mesh() in the coordinates of the input.
  std::vector<double> actual(const std::vector<double>& points) const
  {
    return this->Adapter.leaveFrame(points);
  }
  /// The input with other points, given in its own coordinates, which must outlive the mesh.
  Mesh actualMesh(const std::vector<double>& actualPoints) const;
  /**
   * @brief Rounds points to the digits that coordinates have in the input. If more elements would
   * be invalid than in the input, the points of the input are returned. In pieces nothing is done.
   * @param note gets a sentence if so
   */
  std::vector<double> settle(const std::vector<double>& points, std::string& note) const;
  /// Whether the points of the input, on all processes that have some, are in single precision.
  bool isSingle() const;
  /// Points, rounded to the digits that coordinates have in the input, or in double precision.
  std::vector<double> rounded(const std::vector<double>& points, bool single) const;
  /// A sentence on coordinates that are too coarse, see MeshAdapter::coarseness().
  std::string coarseness() const;
  /// One per cell of the input.
  const std::vector<signed char>& validity() const;
  /// Remarks for the user on how the mesh is interpreted, as sentences, or "".
  std::string notice() const;
  /// Cells to leave out of statistics, ghosts and those of lower dimension; null if there are none.
  const unsigned char* skipped() const;
  /// The parts of the whole mesh among the processes; of a mesh of this process alone: itself.
  Ranks division() { return this->inPieces() ? Ranks(this->distributed()) : Ranks(); }
  /// The processes that have pieces; null for a mesh of this process alone.
  RankGroup* ranks() const { return this->inPieces() ? &this->Spread->group : nullptr; }
  /// Of the whole mesh: 3, or 2 for planes and surfaces.
  int dimension() const;
  /// The points of the whole mesh, and its elements: the cells of its own dimension.
  Index allPoints() const;
  Index allCells() const;

  /// The same with other points.
  std::vector<signed char> validityAt(const std::vector<double>& points) const;
  /**
   * @brief The cells of the input with other points.
   * @param storage gets the points in pieces; it and `points` must outlive the mesh
   */
  Mesh placed(const std::vector<double>& points, std::vector<double>& storage) const;

  /// Marks points with a value other than 0 in a point array, or of cells with one in a cell array.
  /// @param array null: none
  void fix(vtkDataArray* array, bool ofCells);
  /// Marks the points that markSelected() found, and the points of the cells it found; null: none.
  void fixSelected(vtkDataSet* selected);
  void fixBoundary();
  /**
   * @brief Frees the points of elements that are inverted or degenerate, however they were fixed so
   * far, except those that always stay (see fixed()). Not in pieces.
   */
  void freeInvalid();
  /// Marks points of the boundary that cannot slide; see boundaryShape().
  void fixCorners(const BoundaryShape& shape);
  /**
   * @brief The flags set so far, and those that are always set: points of ghost cells (not in
   * pieces), of cells that are not measured (lines, polygons, polyhedra) and of surfaces inside a
   * volume mesh. Of pieces one per local point.
   */
  const std::vector<unsigned char>& fixed() const { return this->Fixed; }
  /**
   * @brief Why no point is free, and what to do about it, in sentences; "" if one is.
   * @param boundaryRemedy how to free the boundary in this filter: "choose another Boundary"
   */
  std::string whyNoneIsFree(const std::string& boundaryRemedy) const;
  /// Of values per point of the input the least of points that are one; in pieces per local point.
  /// @param none the value of points without one @param ofPiece may be empty without points
  std::vector<double> leastOf(const std::vector<double>& ofPiece, double none) const;

  /**
   * @brief Gives the output new points, in the precision of the input unless a valid cell would not
   * be valid in it, and the point array `Displacement`. Points that are one get the same place.
   * @return a sentence if single precision did not do, else ""
   */
  std::string move(vtkPointSet* output, const std::vector<double>& moved) const;
  /// The same in the precision of the input, or in double precision.
  void move(vtkPointSet* output, const std::vector<double>& moved, bool single) const;

  /// @name Of a mesh in pieces.
  ///@{
  RankGroup& group() const { return this->Spread->group; }
  /// The mesh of the local cells and points.
  Mesh local() const;
  DistributedMesh& distributed() { return *this->Spread->mesh; }
  const DistributedMesh& distributed() const { return *this->Spread->mesh; }
  /// Frees the memory of distributed(), after which mesh(), skipped(), dimension(), mirrored() and
  /// notice() remain. Not collective.
  void releaseDistributed() { this->Spread->mesh.reset(); }
  /// Whether the mesh is reversed throughout, see Mesh::setMirrored().
  bool mirrored() const { return this->Adapter.mesh().mirrored(); }
  /// The elements of the whole mesh that are negative (mirrored: positive).
  Index inverted() const { return this->Spread->inverted; }
  /// Whether it is a volume mesh, or lies in a plane at right angles to an axis.
  bool inSpaceOrPlane() const;
  /// The piece as it is given, with all cells.
  const MeshView& piece() const { return this->Adapter.inputView(); }
  /// The points of the piece with copies at one place, where the mesh has them.
  const double* joinedPoints() const;

  /// Flags per point of the piece as flags of the local points: set on any process.
  std::vector<unsigned char> anyOf(const std::vector<unsigned char>& ofPiece) const;
  /**
   * @brief Values per cell of the piece, `components` each, as values of the local cells;
   * cells that are skipped() do not count. Of cells with the same points the least. Throws Error on
   * all processes if a process has cells but no values.
   * @param ofPiece may be empty where the piece has no cells
   */
  std::vector<double> ofCells(const std::vector<double>& ofPiece, int components) const;
  /**
   * @brief One number per local point that identifies it however the mesh is cut: the global ids if
   * all pieces have them, of points that are one the least; else coordinateOrder(). Throws Error if
   * one id is at two places.
   */
  std::vector<Index> pointIds() const;
  /**
   * @brief The same per point of the piece, also where only other pieces have an element at it; -1
   * where none has.
   * @param ids what pointIds() returned
   */
  std::vector<Index> idsOfPiece(const std::vector<Index>& ids) const;
  /// Flags per point of the piece: marked by fix() or fixSelected() on any process.
  std::vector<unsigned char> markedOfPiece(const std::vector<Index>& idsOfPiece) const;
  /// Coordinates of the piece's points, from those of local points; those without a cell stay.
  std::vector<double> ofPiece(const std::vector<double>& local) const;
  /// The numbers of the points of a cell of the piece, in increasing order.
  std::vector<Index> numbersOf(Index cell) const;
  ///@}

private:
  /// What is known of the whole mesh that this is a piece of.
  struct Pieces
  {
    Pieces(RankGroup& ranks, Redistribution redistribution)
      : group(ranks)
      , divided(redistribution)
    {
    }
    RankGroup& group;
    Redistribution divided;
    std::string whyTree; ///< the error of PT-Scotch, behind a blank
    int dimension = 0;
    Index inverted = 0;
    Index dropped = 0;   ///< cells that are copies of others
    JoinedCopies copies; ///< of the points of the pieces
    std::unique_ptr<DistributedMesh> mesh;
    std::vector<unsigned char> marked; ///< per point of the piece
    std::vector<unsigned char> copied; ///< per cell of the piece: a copy; empty without any
  };

  void divide(const MeshPiece& piece);
  std::string findSkin();
  void checkOrder();
  void skipCopies();
  void requireOneLayer(const Mesh* mesh, const std::vector<signed char>& validity) const;
  void fixHeld(const std::vector<unsigned char>& held);
  void fixWhatStays();
  void addFixed(const std::vector<unsigned char>& flags);
  /// Points in the coordinates of the input, those that are one at the same place.
  std::vector<double> written(const std::vector<double>& points, bool single) const;
  void uniteFixed();

  const CurvedMesh* Curved = nullptr;
  vtkPointSet* Input; ///< null for an empty piece of another kind
  MeshAdapter Adapter;
  int Threads;
  bool MergePoints;
  std::unique_ptr<Pieces> Spread;
  std::vector<char> Skin;     ///< one flag per point: on the boundary; in pieces once needed
  bool BoundaryFixed = false; ///< whether fixBoundary() fixed these
  bool SlidingFixed = false;  ///< whether fixCorners() fixed any
  mutable std::vector<signed char> Validity;
  std::vector<unsigned char> Skip, Fixed;
  std::vector<unsigned char> Stays; ///< Fixed at first; empty in pieces
  std::string Notice;
};

/// Adds the point array `Displacement`, new minus old position; 0 where that is not finite.
TAUTLINECORE_EXPORT void addDisplacement(
  vtkDataSet* output, const double* before, const std::vector<double>& after);
}
#endif
