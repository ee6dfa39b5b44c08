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

/// Thrown if neighboring cells list their points in opposite orders, or if only parts of the mesh
/// are reversed: a mesh in pieces can then be gathered.
class OppositeOrders : public Error
{
public:
  using Error::Error;
};

/// The same as a reason for gatheredSentence().
constexpr const char* oppositeOrders =
  "neighboring cells list their points in opposite orders, or only parts of it are reversed";

/// "The mesh was put together on the first process: <reason>.", or "" without a reason; a period at
/// the end of the reason is not doubled.
TAUTLINECORE_EXPORT std::string gatheredSentence(const std::string& why);

/**
 * @class tautline::MovableMesh
 * @brief A data set whose points can move: a mesh of this process alone, or a mesh divided among
 * processes.
 *
 * For one process, the orientation is made consistent, see MeshAdapter::orient(), and the moving
 * points are the points of mesh().
 *
 * In pieces, the moving points are the local points of distributed(). Cells marked as ghosts are
 * copies. Points with the same coordinates (with mergePoints off: the same global id) are treated
 * as one, and so are copies of a point with the same global id whose coordinates differ by
 * rounding, which get one position, see joinCopies(). All methods except const accessors are then
 * collective. The reproducible order of one process is the order of one piece.
 */
class TAUTLINECORE_EXPORT MovableMesh
{
public:
  /**
   * @brief A mesh of this process alone. Throws Error, with the remedy, for implicit points (image
   * data), cells of higher order, a mesh without elements, and parts without a consistent
   * orientation.
   * @param mergePoints whether coincident points on seams are one: they move together
   * @param framed whether mesh() has its own frame if cells have an extreme size or are far from
   * the origin; all points and lengths passed here are then in this frame
   */
  MovableMesh(vtkDataSet* input, int threads, bool mergePoints, bool framed = false);
  /**
   * @brief The piece of this process. Throws Error if a piece is malformed or has implicit points
   * or cells of higher order, and OppositeOrders, on all processes, if neighboring cells list their
   * points in opposite orders. Collective.
   * @param group outlives the mesh
   */
  MovableMesh(RankGroup& group, vtkDataSet* input, int threads, bool mergePoints,
    Redistribution redistribution = Redistribution::None);

  /// Like the constructor for pieces; an error on one process is thrown on all. Null, on all
  /// processes, if neighboring cells list their points in opposite orders.
  static std::unique_ptr<MovableMesh> makePiece(RankGroup& group, vtkDataSet* input, int threads,
    bool mergePoints, Redistribution redistribution = Redistribution::None);

  /// Makes validity(), validityAt() and move() test curved cells throughout, if this is the mesh of
  /// their corners. Not for pieces.
  /// @param curved must outlive the mesh
  void certifyBy(const CurvedMesh& curved);

  bool inPieces() const { return this->Spread != nullptr; }

  /// The mesh of this process, or its piece with all cells as given.
  const Mesh& mesh() const { return this->Adapter.mesh(); }
  /// The same with the points that the cells have in the data set, for comparisons with it.
  const Mesh& given() const { return this->Adapter.given(); }
  /// One per point, see CoincidentPoints; empty if no points are merged, and for pieces.
  const std::vector<Index>& representative() const
  {
    return this->Adapter.coincident().representative;
  }
  /// The position of mesh() in the coordinates of the input.
  const CoordinateFrame& frame() const { return this->Adapter.frame(); }
  /// Points of mesh() in the coordinates of the input.
  std::vector<double> actual(const std::vector<double>& points) const
  {
    return this->Adapter.leaveFrame(points);
  }
  /// The input with other points in its own coordinates; the points must outlive the mesh.
  Mesh actualMesh(const std::vector<double>& actualPoints) const;
  /**
   * @brief Rounds points to the precision of the input's coordinates. If this would make more
   * elements invalid than in the input, returns the points of the input. Does nothing for pieces.
   * @param note receives a sentence in this case
   */
  std::vector<double> settle(const std::vector<double>& points, std::string& note) const;
  /// Whether the points of the input, on all processes that have some, are in single precision.
  bool isSingle() const;
  /// Points rounded to the precision of the input's coordinates, or in double precision.
  std::vector<double> rounded(const std::vector<double>& points, bool single) const;
  /// A sentence on coordinates that are too coarse, see MeshAdapter::coarseness().
  std::string coarseness() const;
  /// One per cell of the input.
  const std::vector<signed char>& validity() const;
  /// Remarks for the user on the interpretation of the mesh, as sentences, or "".
  std::string notice() const;
  /// Flags of cells to leave out of statistics (ghosts, cells of lower dimension); null if there
  /// are none.
  const unsigned char* skipped() const;
  /// The parts of the whole mesh on the processes; for a mesh of this process alone, the mesh
  /// itself.
  Ranks division() { return this->inPieces() ? Ranks(this->distributed()) : Ranks(); }
  /// The processes that have pieces; null for a mesh of this process alone.
  RankGroup* ranks() const { return this->inPieces() ? &this->Spread->group : nullptr; }
  /// The dimension of the whole mesh: 3, or 2 for planes and surfaces.
  int dimension() const;
  /// The number of points of the whole mesh, and of its elements (the cells of its dimension).
  Index allPoints() const;
  Index allCells() const;

  /// The same with other points.
  std::vector<signed char> validityAt(const std::vector<double>& points) const;
  /**
   * @brief The cells of the input with other points.
   * @param storage receives the points if in pieces; it and `points` must outlive the mesh
   */
  Mesh placed(const std::vector<double>& points, std::vector<double>& storage) const;

  /// Marks points with a nonzero value in a point array, or points of cells with a nonzero value in
  /// a cell array.
  /// @param array null for none
  void fix(vtkDataArray* array, bool ofCells);
  /// Marks the points that markSelected() marked, and the points of the cells it marked; null for
  /// none.
  void fixSelected(vtkDataSet* selected);
  void fixBoundary();
  /**
   * @brief Frees the points of inverted or degenerate elements, whatever fixed them so far, except
   * points that always stay (see fixed()). Not for pieces.
   */
  void freeInvalid();
  /// Marks points of the boundary that cannot slide; see boundaryShape().
  void fixCorners(const BoundaryShape& shape);
  /**
   * @brief The flags set so far, including points that always stay: points of ghost cells (not for
   * pieces), of cells that are not measured (lines, polygons, polyhedra) and of surfaces inside a
   * volume mesh. For pieces, one flag per local point.
   */
  const std::vector<unsigned char>& fixed() const { return this->Fixed; }
  /**
   * @brief Sentences that explain why no point is free, with the remedy; "" if a point is free.
   * @param boundaryRemedy how to free the boundary in this filter: "choose another Boundary"
   */
  std::string whyNoneIsFree(const std::string& boundaryRemedy) const;
  /// The smallest value among merged points, from values per point of the input; for pieces, one
  /// per local point.
  /// @param none the value of points that have none @param ofPiece may be empty if there are no
  /// points
  std::vector<double> leastOf(const std::vector<double>& ofPiece, double none) const;

  /**
   * @brief Gives the output new points, in the precision of the input unless a valid cell would
   * become invalid, and the point array `Displacement`. Merged points get the same position.
   * @return a sentence if single precision was not sufficient, otherwise ""
   */
  std::string move(vtkPointSet* output, const std::vector<double>& moved) const;
  /// The same in the precision of the input, or in double precision.
  void move(vtkPointSet* output, const std::vector<double>& moved, bool single) const;

  /// @name For a mesh in pieces.
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
  /// The number of elements of the whole mesh that are negative (if mirrored, positive).
  Index inverted() const { return this->Spread->inverted; }
  /// Whether it is a volume mesh, or lies in a plane perpendicular to an axis.
  bool inSpaceOrPlane() const;
  /// The piece as given, with all cells.
  const MeshView& piece() const { return this->Adapter.inputView(); }
  /// The points of the piece, with copies at their common position in the mesh.
  const double* joinedPoints() const;

  /// Converts flags per point of the piece to flags of the local points, set if any process sets
  /// them.
  std::vector<unsigned char> anyOf(const std::vector<unsigned char>& ofPiece) const;
  /**
   * @brief Converts values per cell of the piece, `components` each, to values of the local cells;
   * cells that are skipped() do not count. Cells with the same points get the smallest value.
   * Throws Error on all processes if a process has cells but no values.
   * @param ofPiece may be empty where the piece has no cells
   */
  std::vector<double> ofCells(const std::vector<double>& ofPiece, int components) const;
  /**
   * @brief One number per local point that identifies it independently of the division: the global
   * ids if all pieces have them (the smallest for merged points), otherwise coordinateOrder().
   * Throws Error if one id is at two positions.
   */
  std::vector<Index> pointIds() const;
  /**
   * @brief The same per point of the piece, including points that only elements of other pieces
   * use; -1 if no element uses it.
   * @param ids the result of pointIds()
   */
  std::vector<Index> idsOfPiece(const std::vector<Index>& ids) const;
  /// Flags per point of the piece: marked by fix() or fixSelected() on any process.
  std::vector<unsigned char> markedOfPiece(const std::vector<Index>& idsOfPiece) const;
  /// Coordinates of the piece's points from the local points; points without a cell are unchanged.
  std::vector<double> ofPiece(const std::vector<double>& local) const;
  /// The numbers of the points of a cell of the piece, in increasing order.
  std::vector<Index> numbersOf(Index cell) const;
  ///@}

private:
  /// Data on the whole mesh of which this is a piece.
  struct Pieces
  {
    Pieces(RankGroup& ranks, Redistribution redistribution)
      : group(ranks)
      , divided(redistribution)
    {
    }
    RankGroup& group;
    Redistribution divided;
    std::string whyTree; ///< the error of PT-Scotch, after a blank
    int dimension = 0;
    Index inverted = 0;
    Index dropped = 0;   ///< cells that are copies of others
    JoinedCopies copies; ///< copies among the points of the pieces
    std::unique_ptr<DistributedMesh> mesh;
    std::vector<unsigned char> marked; ///< per point of the piece
    std::vector<unsigned char> copied; ///< per cell of the piece, set for copies; or empty
  };

  void divide(const MeshPiece& piece);
  std::string findSkin();
  void checkOrder();
  void skipCopies();
  void requireOneLayer(const Mesh* mesh, const std::vector<signed char>& validity) const;
  void fixHeld(const std::vector<unsigned char>& held);
  void fixWhatStays();
  void addFixed(const std::vector<unsigned char>& flags);
  /// Points in the coordinates of the input, with merged points at the same position.
  std::vector<double> written(const std::vector<double>& points, bool single) const;
  void uniteFixed();

  const CurvedMesh* Curved = nullptr;
  vtkPointSet* Input; ///< null for an empty piece of another kind
  MeshAdapter Adapter;
  int Threads;
  bool MergePoints;
  std::unique_ptr<Pieces> Spread;
  std::vector<char> Skin;     ///< one flag per point, set on the boundary; for pieces when needed
  bool BoundaryFixed = false; ///< whether fixBoundary() fixed these
  bool SlidingFixed = false;  ///< whether fixCorners() fixed any
  mutable std::vector<signed char> Validity;
  std::vector<unsigned char> Skip, Fixed;
  std::vector<unsigned char> Stays; ///< initially fixed points; empty for pieces
  std::string Notice;
};

/// Adds the point array `Displacement`, new minus old position; 0 where that is not finite.
TAUTLINECORE_EXPORT void addDisplacement(
  vtkDataSet* output, const double* before, const std::vector<double>& after);
}
#endif
