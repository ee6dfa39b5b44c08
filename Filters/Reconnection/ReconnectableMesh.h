// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectableMesh.h
 * @brief Converts the input of Improve Mesh for the kernel: its tetrahedra or triangles, fixed
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
/// Throws Error for an array that does not have one number per cell; null is accepted.
void requireNumbers(vtkDataArray* regions);
/// The region of a cell. Throws Error for a value that is not a region number.
double regionAt(vtkDataArray* regions, Index cell);

/**
 * @class tautline::ReconnectableMesh
 * @brief The tetrahedra of an unstructured grid, or the triangles of a mesh without volume cells,
 * oriented consistently: see MeshAdapter::orient().
 *
 * The data set must outlive this object and must not change during its lifetime.
 */
class ReconnectableMesh
{
public:
  /**
   * @brief Throws Error, with the remedy, for other data sets, for volume cells that are not linear
   * tetrahedra or, without volume cells, for 2D cells that are not linear triangles, for ghost
   * cells, and for data sets without any of these cells. Cells of lower dimension are left out, see
   * leftOut().
   * @param mergePoints whether to merge coincident points on seams
   */
  ReconnectableMesh(vtkDataSet* input, bool mergePoints, int threads);

  vtkPointSet* input() const { return this->Input; }
  /// Whether the cells are triangles, not tetrahedra.
  bool isTriangles() const { return this->Corners == 3; }
  /// The number of points of a cell.
  int corners() const { return this->Corners; }
  /// For triangles: the pairs of points joined by lines of the input.
  const std::vector<std::array<Index, 2>>& lines() const { return this->Lines; }
  /// For tetrahedra: the points of triangles of the input.
  const std::vector<std::array<Index, 3>>& facets() const { return this->Facets; }
  /// The cell of the input to which each of lines(), or of facets(), belongs.
  const std::vector<Index>& markCells() const { return this->MarkCells; }
  /**
   * @brief The class of each of facets(), from 1: facets with the same values in the tag arrays
   * share a class. These arrays have at most half as many values as there are facets, see
   * tagArrays().
   */
  std::vector<std::int32_t> facetClasses() const;
  /// Marks the points where lines() of different classes meet; the classes are found in the same
  /// way.
  void fixLineBorders();
  const Mesh& mesh() const { return this->Adapter->mesh(); }
  /// The cell of the input for a cell of mesh().
  Index inputCell(Index cell) const { return this->Cells.empty() ? cell : this->Cells[cell]; }
  /// Whether a point of the input was merged into another one, its representative.
  bool isMerged(Index point) const
  {
    return !this->Representative.empty() && this->Representative[point] != point;
  }

  /// Marks points with a nonzero value; the array may be null.
  void fixPoints(vtkDataArray* ofPoints);
  /// Marks the points of cells with a nonzero value; the array may be null.
  void fixCells(vtkDataArray* ofCells);
  /// Keeps cells with the value 0 unchanged; the array may be null.
  void keepOthers(vtkDataArray* ofCells);
  /// One flag per cell of mesh(), nonzero if it must not change; empty if all may change.
  const std::vector<unsigned char>& outside() const { return this->Outside; }

  /// One flag per point.
  const std::vector<unsigned char>& fixed() const { return this->Fixed; }

  /// Sets the regions of the cells; null for one region. Throws Error for values that are not
  /// region numbers.
  void setRegions(vtkDataArray* ofCells);
  /**
   * @brief Sets regions by the values of the tag arrays, which have at most a quarter as many
   * values as there are cells, see tagArrays(). @return a sentence that names these arrays, or ""
   */
  std::string setRegionsByTags();
  /// One per cell of mesh(); empty for one region.
  const std::vector<Index>& regions() const { return this->Regions; }

  /**
   * @brief Removes degenerate cells, see removeDegenerateCells() in the kernel: mesh(), lines(),
   * facets() and regions() then describe the remaining cells. Call it after fixing points and
   * setting regions.
   */
  void removeDegenerate();

  /// Remarks for the user on the interpretation of the mesh, as sentences, or "".
  const std::string& notice() const { return this->Notice; }
  /// A sentence on cells missing in the output, or "".
  /// @param marks whether it has lines beside triangles, and triangles beside tetrahedra
  const std::string& leftOut(bool marks = false) const
  {
    return marks ? this->LeftOutBesideMarks : this->LeftOut;
  }

private:
  /**
   * @brief The cell arrays that may be tags: integer arrays with one component, except ids and
   * ghost flags, whose values on the given cells repeat.
   * @param cells of the input
   * @param repeats the smallest number of cells per value
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
