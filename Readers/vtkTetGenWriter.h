// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTetGenWriter
 * @brief Writes the file sets of TetGen and Triangle.
 *
 * A name that ends with .node, .ele, .face or .edge writes the set: vertices, tetrahedra (planar
 * meshes: triangles), faces, edges, as far as there are any. .poly and .smesh write polygons or
 * segments with `Holes` and `Regions` of the field data. `BoundaryMarker` is the marker (else
 * `Reference` of a point or face), `Reference` the first attribute of an element; all other numeric
 * point and element arrays are attributes, whose names are kept in a comment. Numbering starts at
 * 0.
 *
 * Limits: tetrahedra and triangles only; face and edge arrays other than the marker are not
 * written.
 *
 * @sa vtkMeshFileWriter vtkTetGenReader tautline::writeTetGen
 */
#ifndef vtkTetGenWriter_h
#define vtkTetGenWriter_h

#include "vtkMeshFileWriter.h"

class TAUTLINEREADERS_EXPORT vtkTetGenWriter : public vtkMeshFileWriter
{
public:
  static vtkTetGenWriter* New();
  vtkTypeMacro(vtkTetGenWriter, vtkMeshFileWriter);

protected:
  vtkTetGenWriter() = default;
  ~vtkTetGenWriter() override = default;
  std::vector<std::string> WriteMesh(
    const tautline::MeshFile& mesh, const std::string& name) override;

private:
  vtkTetGenWriter(const vtkTetGenWriter&) = delete;
  void operator=(const vtkTetGenWriter&) = delete;
};

#endif
