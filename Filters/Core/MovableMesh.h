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

#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkPointSet;

namespace tautline
{
struct BoundaryShape;

/**
 * @brief Why no point of a mesh is free, and what to do about it.
 * @param used how many points the elements have @param onBoundary those of a boundary that is fixed
 * @param slides whether points of the boundary slide, and all that may not are fixed
 * @param boundaryRemedy how to free the boundary in the filter: "choose another Boundary"
 */
std::string noneIsFree(
  Index used, Index onBoundary, bool slides, const std::string& boundaryRemedy);

/**
 * @class tautline::MovableMesh
 * @brief A data set whose points can move. Its orientation is made consistent, see
 * MeshAdapter::orient().
 */
class TAUTLINECORE_EXPORT MovableMesh
{
public:
  /**
   * @brief Throws Error that names the remedy for points that are implicit (image data), cells of
   * higher order, no cell at all that is measured, and parts without a consistent orientation.
   * @param mergePoints whether coincident points on seams are one: they move together
   * @param framed whether mesh() is in a frame of its own where cells are of extreme size or far
   * from the origin; all points and lengths given and taken here are then in it
   */
  MovableMesh(vtkDataSet* input, int threads, bool mergePoints, bool framed = false);

  const Mesh& mesh() const { return this->Adapter.mesh(); }
  /// The same with the points that the cells have in the data set, for what is compared with it.
  const Mesh& given() const { return this->Adapter.given(); }
  /// One per point, see CoincidentPoints; empty if no points are one.
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
   * be invalid than in the input, the points of the input are returned.
   * @param note gets a sentence if so
   */
  std::vector<double> settle(const std::vector<double>& points, std::string& note) const;
  /// Whether the points of the input are in single precision.
  bool isSingle() const;
  /// Points, rounded to the digits that coordinates have in the input, or in double precision.
  std::vector<double> rounded(const std::vector<double>& points, bool single) const;
  /// A sentence on coordinates that are too coarse, see MeshAdapter::coarseness().
  std::string coarseness() const { return this->Adapter.coarseness(); }
  /// One per cell of the input.
  const std::vector<signed char>& validity() const { return this->Validity; }
  /// Remarks for the user on how the mesh is interpreted, as sentences, or "".
  const std::string& notice() const { return this->Notice; }
  /// Cells to leave out of statistics; null if there are none.
  const unsigned char* skipped() const;

  /// The same with other points.
  std::vector<signed char> validityAt(const std::vector<double>& points) const;

  /// Marks points with a value other than 0 in a point array, or of cells with one in a cell array.
  void fix(vtkDataArray* array, bool ofCells);
  void fixBoundary();
  /// Marks points of the boundary that cannot slide; see boundaryShape().
  void fixCorners(const BoundaryShape& shape);
  /**
   * @brief The flags set so far, and those that are always set: points of ghost cells, of cells
   * that are not measured (lines, polygons, polyhedra) and of surfaces inside a volume mesh.
   */
  const std::vector<unsigned char>& fixed() const { return this->Fixed; }
  /**
   * @brief Why no point is free, and what to do about it, in sentences; "" if one is.
   * @param boundaryRemedy how to free the boundary in this filter: "choose another Boundary"
   */
  std::string whyNoneIsFree(const std::string& boundaryRemedy) const;

  /**
   * @brief Gives the output new points, in the precision of the input unless a valid cell would not
   * be valid in it, and the point array `Displacement`. Points that are one get the same place.
   * @return a sentence if single precision did not do, else ""
   */
  std::string move(vtkPointSet* output, const std::vector<double>& moved) const;
  /// The same in a given precision.
  void move(vtkPointSet* output, const std::vector<double>& moved, bool single) const;

private:
  void fixWhatStays();
  /// Points in the coordinates of the input, those that are one at the same place.
  std::vector<double> written(const std::vector<double>& points, bool single) const;
  void uniteFixed();

  vtkPointSet* Input;
  MeshAdapter Adapter;
  int Threads;
  bool MergePoints;
  std::vector<char> Skin;     ///< one flag per point: on the boundary
  bool BoundaryFixed = false; ///< whether fixBoundary() fixed these
  bool SlidingFixed = false;  ///< whether fixCorners() fixed any
  std::vector<signed char> Validity;
  std::vector<unsigned char> Skip, Fixed;
  std::string Notice;
};

/// Fixes the points that markSelected() found, and those of the cells it found.
TAUTLINECORE_EXPORT void fixSelected(MovableMesh& mesh, vtkDataSet* selected);

/// Adds the point array `Displacement`, new minus old position; 0 where that is not finite.
TAUTLINECORE_EXPORT void addDisplacement(
  vtkDataSet* output, const double* before, const std::vector<double>& after);
}
#endif
