// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::LayerMesh
 * @brief One layer of hexahedra and wedges between two planes, as 2D cases of OpenFOAM have it,
 * seen as the planar mesh of one side; the points of the other side move with it.
 *
 * The planes are at right angles to an axis, each cell has one face in each, and each point of the
 * lower one has one counterpart above. Where this holds for several axes, as for a row of cells,
 * "empty" patches decide (see FaceMeshAdapter); without them the mesh is none.
 */
#ifndef tautline_LayerMesh_h
#define tautline_LayerMesh_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Mesh/Mesh.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <vector>

class vtkDataSet;
class vtkPointSet;
class vtkUnstructuredGrid;

namespace tautline
{
class TAUTLINECORE_EXPORT LayerMesh
{
public:
  /// Null for other meshes.
  static std::unique_ptr<LayerMesh> find(vtkDataSet* input);

  /// The planar mesh: the cells of the input in their order, with its arrays, then lines for the
  /// facets across the layer.
  vtkSmartPointer<vtkUnstructuredGrid> planar() const { return this->side(this->Input); }
  /// The same side of another data set with the same points and cells; null for null.
  vtkSmartPointer<vtkUnstructuredGrid> side(vtkDataSet* other) const;

  /**
   * @brief Gives an output, a copy of the input, what a filter made of planar(): its points, those
   * of the other side moved by the same, and the arrays that it made. Points at the same place of
   * their sides stay so, bit by bit.
   * @param planar that the filter had
   * @param made by the filter: a shallow copy of `planar`, changed
   */
  void expand(vtkPointSet* planar, vtkPointSet* made, vtkPointSet* output) const;

  /// 0 to 2: across the layer.
  int axis() const { return this->Axis; }

private:
  LayerMesh() = default;
  bool lies(vtkDataSet* input, int axis);
  void addLines(const std::vector<vtkIdType>& numbers);

  vtkDataSet* Input = nullptr;
  int Axis = 0;
  std::vector<vtkIdType> Points; ///< the input's number of each point of the planar mesh
  std::vector<vtkIdType> Mates;  ///< per point of the planar mesh: that on the other side
  std::vector<vtkIdType> Cells;  ///< the input's number of each cell
  std::vector<unsigned char> Types;
  std::vector<vtkIdType> Offsets = { 0 }, Nodes; ///< of the planar cells
};
}
#endif
