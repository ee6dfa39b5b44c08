// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::LayerMesh
 * @brief One layer of hexahedra and wedges between two planes, as in 2D cases of OpenFOAM, treated
 * as the planar mesh of one side; the points of the other side move with it.
 *
 * The planes are perpendicular to an axis, each cell has one face in each plane, and each point of
 * the lower plane has one counterpart above. If this holds for several axes, for example for a row
 * of cells, "empty" patches decide (see FaceMeshAdapter); without them the mesh is not a layer.
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
   * @brief Transfers the result of a filter on planar() to an output, a copy of the input: the
   * points, with points of the other side displaced equally, and the new arrays. Points at the same
   * position on both sides stay so, bit for bit.
   * @param planar the filter's input
   * @param made the filter's output: a modified shallow copy of `planar`
   */
  void expand(vtkPointSet* planar, vtkPointSet* made, vtkPointSet* output) const;

  /// The axis across the layer, 0 to 2.
  int axis() const { return this->Axis; }

private:
  LayerMesh() = default;
  bool lies(vtkDataSet* input, int axis);
  void addLines(const std::vector<vtkIdType>& numbers);

  vtkDataSet* Input = nullptr;
  int Axis = 0;
  std::vector<vtkIdType> Points; ///< per point of the planar mesh: its number in the input
  std::vector<vtkIdType> Mates;  ///< per planar point: its mate on the other side
  std::vector<vtkIdType> Cells;  ///< the input's number of each cell
  std::vector<unsigned char> Types;
  std::vector<vtkIdType> Offsets = { 0 }, Nodes; ///< of the planar cells
};
}
#endif
