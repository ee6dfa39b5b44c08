// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectableMesh.h
 * @brief The input of Improve Mesh as the kernel takes it: its tetrahedra or triangles, fixed
 * points and regions.
 */
#ifndef tautline_ReconnectableMesh_h
#define tautline_ReconnectableMesh_h

#include "MeshAdapter.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkPointSet;

namespace tautline
{
/// Throws Error for an array that has not one number per cell; null is taken.
void requireNumbers(vtkDataArray* regions);
/// The region of a cell. Throws Error for a value that is none.
double regionAt(vtkDataArray* regions, Index cell);

/**
 * @class tautline::ReconnectableMesh
 * @brief The tetrahedra of an unstructured grid, or the triangles of a mesh without volume cells,
 * oriented consistently: see MeshAdapter::orient().
 *
 * The data set must outlive it and not change meanwhile.
 */
class ReconnectableMesh
{
public:
  /**
   * @brief Throws Error that names the remedy for other data sets, for cells of volume that are not
   * linear tetrahedra, where there are none for cells of area that are not linear triangles, for
   * ghost cells, and where there are neither.
   * Cells of lower dimension are left out, see leftOut().
   * @param mergePoints whether coincident points on seams become one
   */
  ReconnectableMesh(vtkDataSet* input, bool mergePoints, int threads);

  vtkPointSet* input() const { return this->Input; }
  /// Whether the cells are triangles, not tetrahedra.
  bool isTriangles() const { return this->Corners == 3; }
  /// The number of points of a cell.
  int corners() const { return this->Corners; }
  /// Of triangles: the pairs of points that lines of the input join.
  const std::vector<std::array<Index, 2>>& lines() const { return this->Lines; }
  /// Of tetrahedra: the points of triangles of the input.
  const std::vector<std::array<Index, 3>>& facets() const { return this->Facets; }
  /// The cell of the input that each of lines(), or of facets(), is, or is a part of.
  const std::vector<Index>& markCells() const { return this->MarkCells; }
  /**
   * @brief The class of each of facets(), from 1 on: facets with the same values in the arrays of
   * tags have the same. At most half as many values as facets occur in these, see tagArrays().
   */
  std::vector<std::int32_t> facetClasses() const;
  /// Marks the points where lines() of different classes meet, which are found likewise.
  void fixLineBorders();
  const Mesh& mesh() const { return this->Adapter->mesh(); }
  /// The cell of the input that a cell of mesh() is.
  Index inputCell(Index cell) const { return this->Cells.empty() ? cell : this->Cells[cell]; }
  /// Whether a point of the input became one with another, which represents it.
  bool isMerged(Index point) const
  {
    return !this->Representative.empty() && this->Representative[point] != point;
  }

  /// Marks points with a value other than 0; the array may be null.
  void fixPoints(vtkDataArray* ofPoints);
  /// Marks the points of cells with a value other than 0; the array may be null.
  void fixCells(vtkDataArray* ofCells);
  /// Of cells with the value 0, everything stays; the array may be null.
  void keepOthers(vtkDataArray* ofCells);
  /// One flag per cell of mesh(), nonzero: it stays as it is. Empty: all may change.
  const std::vector<unsigned char>& outside() const { return this->Outside; }

  /// One flag per point.
  const std::vector<unsigned char>& fixed() const { return this->Fixed; }

  /// The regions of the cells; null: one region. Throws Error for values that are no regions.
  void setRegions(vtkDataArray* ofCells);
  /**
   * @brief Regions by the values of the arrays of tags, in which at most a quarter as many values
   * as cells occur, see tagArrays(). @return a sentence that names these arrays, or ""
   */
  std::string setRegionsByTags();
  /// One per cell of mesh(); empty for one region.
  const std::vector<Index>& regions() const { return this->Regions; }

  /**
   * @brief Removes degenerate cells, see removeDegenerateCells() of the kernel: mesh(), lines(),
   * facets() and regions() then describe the cells that remain. To be called when points have
   * been fixed and regions set.
   */
  void removeDegenerate();

  /// Remarks for the user on how the mesh is interpreted, as sentences, or "".
  const std::string& notice() const { return this->Notice; }
  /// A sentence on cells that the output does not have, or "".
  /// @param marks whether it has lines beside triangles, and triangles beside tetrahedra
  const std::string& leftOut(bool marks = false) const
  {
    return marks ? this->LeftOutBesideMarks : this->LeftOut;
  }

private:
  /**
   * @brief The cell arrays that may be tags: of whole numbers with one component, no ids and no
   * ghost flags, of which the values on some cells repeat.
   * @param cells of the input
   * @param repeats the least number of cells per value
   */
  std::vector<vtkDataArray*> tagArrays(const std::vector<Index>& cells, std::size_t repeats) const;
  void findKind();
  void takeLines();
  void takeFacets();

  vtkPointSet* Input;
  int Corners = 4;
  vtkSmartPointer<vtkPointSet> Taken; ///< the input, or a grid of its tetrahedra or triangles
  std::vector<Index> Cells;           ///< empty if all cells are taken
  std::vector<std::array<Index, 2>> Lines;
  std::vector<std::array<Index, 3>> Facets;
  std::vector<Index> MarkCells;
  std::unique_ptr<MeshAdapter> Adapter;
  std::vector<Index> Representative; ///< per point; empty if none was merged
  int Threads;
  std::vector<unsigned char> Fixed, Outside;
  std::vector<Index> Regions;
  std::string Notice, LeftOut, LeftOutBesideMarks;
};
}
#endif
