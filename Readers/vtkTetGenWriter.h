// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTetGenWriter
 * @brief Writes the file sets of TetGen and Triangle.
 *
 * With the extension .node, .ele, .face or .edge, the whole set is written: vertices, tetrahedra
 * (planar meshes: triangles), faces and edges, as far as they exist. With .poly and .smesh,
 * polygons or segments are written, with `Holes` and `Regions` from the field data.
 * `BoundaryMarker` is the marker (otherwise `Reference` of a point or face), `Reference` the first
 * attribute of an element; all other numeric point and element arrays are attributes, whose names
 * are kept in a comment. Numbering starts at 0.
 *
 * Limitations: only tetrahedra and triangles; face and edge arrays other than the marker are not
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
