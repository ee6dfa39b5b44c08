// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankMesh.h
 * @brief A data set in pieces on several processes as one mesh whose points can move.
 */
#ifndef tautline_RankMesh_h
#define tautline_RankMesh_h

#include "TautlineCoreModule.h" // for export macro

#include "MeshAdapter.h"
#include "Redistribution.h"

#include <memory>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;
class vtkPointSet;
class vtkSelection;

namespace tautline
{
/// The data set of a mesh on several processes, or in the reproducible order. Throws Error for
/// composite data, with the remedy.
TAUTLINECORE_EXPORT vtkDataSet* requirePiece(vtkDataObject* input);

class RankMesh;

/// Neighbouring cells list their points in opposite orders, or parts of the mesh are reversed and
/// others are not: the mesh can be gathered.
class OppositeOrders : public Error
{
public:
  using Error::Error;
};

/// That as the reason of gatheredSentence().
constexpr const char* oppositeOrders =
  "neighbouring cells list their points in opposite orders, or parts of it are reversed and others "
  "are not";

/**
 * @brief The input as a mesh that each process works on a piece of. Null, on all processes, where
 * that is not possible and the mesh has to be gathered: composite data, all cells on the first
 * process unless redistributed, surfaces in space, planes that are inclined, cells of extreme size,
 * and what RankMesh refuses; and processes that do not communicate by MPI. Collective.
 * @param group gets the processes, which outlive the mesh
 * @param redistribution of the mesh among the processes, also where all cells are on the first
 * @param why if not null, gets the reason in words, "it has blocks", the same on all processes;
 * with the message of the error where RankMesh refuses the mesh; "" where all is in one place
 */
TAUTLINECORE_EXPORT std::unique_ptr<RankMesh> takePieces(std::unique_ptr<RankGroup>& group,
  vtkDataObject* input, int threads, bool mergePoints, Redistribution redistribution,
  std::string* why = nullptr);

/// Whether processes other than the first have cells of a mesh. Collective.
TAUTLINECORE_EXPORT bool isScattered(vtkDataObject* input);

/// "The mesh was put together on the first process: why.", or "" without a reason; a full stop at
/// the end of the reason is not doubled.
TAUTLINECORE_EXPORT std::string gatheredSentence(const std::string& why);

/**
 * @class tautline::RankMesh
 * @brief The counterpart of MovableMesh for a data set that each process has a piece of. All
 * methods are collective but for const accessors.
 *
 * Cells marked as ghosts are copies. Points with the same coordinates are one, or, with
 * mergePoints off, those with the same global id. Copies of a point with the same global id whose
 * places differ by rounding are one, too, and get one place, see joinCopies(). Cells of lower
 * dimension than the others, and those of unsupported types, hold their points, but on the boundary
 * of a volume.
 */
class TAUTLINECORE_EXPORT RankMesh
{
public:
  /// As the constructor; what one process throws is thrown on all. Null, on all processes, if
  /// neighbouring cells list their points in opposite orders.
  static std::unique_ptr<RankMesh> make(RankGroup& group, vtkDataSet* input, int threads,
    bool mergePoints, Redistribution redistribution = Redistribution::None);

  /**
   * @brief Throws Error if a piece is malformed, has no explicit points or quadratic cells, and
   * OppositeOrders, on all processes, if neighbouring cells list their points so.
   */
  RankMesh(RankGroup& group, vtkDataSet* input, int threads, bool mergePoints,
    Redistribution redistribution = Redistribution::None);

  /// Frees the memory of mesh(), after which piece(), movedPiece(), skipped(), volume(),
  /// mirrored() and notice() remain. Not collective.
  void releaseMesh() { this->TheMesh.reset(); }

  DistributedMesh& mesh() { return *this->TheMesh; }
  const DistributedMesh& mesh() const { return *this->TheMesh; }
  /// Whether the mesh is reversed throughout, see Mesh::setMirrored().
  bool mirrored() const { return this->Mirrored; }
  /// The elements of the whole mesh that are negative (mirrored: positive).
  Index inverted() const { return this->InvertedElements; }
  bool volume() const { return this->Dimension == 3; }
  /// Whether it is a volume mesh, or lies in a plane at right angles to an axis.
  bool inSpaceOrPlane() const;
  /// The piece as it is given, with all cells.
  const MeshView& piece() const { return this->Adapter->inputView(); }
  /// The points of the piece with copies at one place, where the mesh has them.
  const double* joinedPoints() const;
  /// One flag per cell of the piece: ghosts, and cells of lower dimension; they do not count.
  const std::vector<unsigned char>& skipped() const { return this->Skip; }
  /// Remarks for the user on this piece, or "".
  std::string notice() const;

  /// Marks points of the piece with a value other than 0, or of cells with one; null: none. Not
  /// collective.
  void fix(vtkDataArray* array, bool ofCells);
  /// Marks what a selection holds of the piece; null: nothing. Not collective, as fix().
  void fixSelected(vtkDataObject* input, vtkSelection* selection);
  /// As MovableMesh::whyNoneIsFree(), of a mesh whose points are all fixed. @param slides whether
  /// points of the boundary may slide
  std::string whyNoneIsFree(
    bool boundaryFixed, bool slides, const std::string& boundaryRemedy) const;

  /// Per local point: marked on any process, or held.
  std::vector<unsigned char> fixed(bool boundary);
  /// Flags per point of the piece as those of the local points: set on any process.
  std::vector<unsigned char> anyOf(const std::vector<unsigned char>& ofPiece) const;
  /// Values per point of the piece as those of the local points: of points that are one the least.
  std::vector<double> leastOf(const std::vector<double>& ofPiece, double none) const;
  /**
   * @brief Values per cell of the piece, `components` each, as those of the local cells; those of
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
  /// The mesh of the piece with these points.
  Mesh movedPiece(const std::vector<double>& points) const;
  std::vector<signed char> validityAt(const std::vector<double>& points) const;
  /// The numbers of the points of a cell of the piece, in increasing order.
  std::vector<Index> numbersOf(Index cell) const;
  /**
   * @brief Gives the output new points, in the precision of the input unless a valid cell would not
   * be valid in it, and the point array `Displacement`.
   * @return a sentence if single precision did not do, else ""
   */
  std::string move(vtkPointSet* output, const std::vector<double>& local) const;
  /// The same in single precision, that of the input, or in double precision.
  void move(vtkPointSet* output, const std::vector<double>& local, bool single) const;
  /// Whether all pieces with points have them in single precision.
  bool isSingle() const;
  /// Local points as they are written in single precision.
  std::vector<double> rounded(const std::vector<double>& local) const;

private:
  void divide(const MeshPiece& piece);
  void checkOrder();

  RankGroup& Group;
  vtkPointSet* Input = nullptr;
  int Threads;
  int Dimension = 0;
  bool MergePoints;
  Redistribution Divided;
  std::string WhyTree; ///< the error of PT-Scotch, behind a blank
  bool Mirrored = false;
  std::string Reversal; ///< the sentence on a mesh that is reversed, or ""
  Index InvertedElements = 0;
  std::unique_ptr<MeshAdapter> Adapter;
  JoinedCopies Copies; ///< of the points of the pieces
  std::unique_ptr<DistributedMesh> TheMesh;
  std::vector<unsigned char> Skip, Held, Marked; // per cell, point and point of the piece
};
}
#endif
