// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTetGenReader
 * @brief Reads the file sets of TetGen and Triangle: .node .ele .face .edge .poly .smesh.
 *
 * Opening any file of a set finds its companions by their common stem: part.1.ele brings
 * part.1.node, and with LowerCells part.1.face and part.1.edge. 2D and 3D, vertices numbered from 0
 * or 1, attributes, markers, comments, second-order elements. .poly and .smesh give the input of a
 * mesher: polygons (2D: segments), with `Holes` and `Regions` in the field data.
 *
 * Point arrays: `BoundaryMarker`, attributes. Cell arrays: `Reference` (the first attribute of the
 * elements), further attributes, `BoundaryMarker` of faces and edges.
 *
 * Limits: .neigh, .vol, .mtr, .var, .b.node are not read; neighbours behind a face are skipped.
 *
 * @sa vtkMeshFileReader vtkTetGenWriter tautline::readTetGen
 */
#ifndef vtkTetGenReader_h
#define vtkTetGenReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkTetGenReader : public vtkMeshFileReader
{
public:
  static vtkTetGenReader* New();
  vtkTypeMacro(vtkTetGenReader, vtkMeshFileReader);

  int CanReadFile(const char* name) override;

protected:
  vtkTetGenReader() = default;
  ~vtkTetGenReader() override = default;
  tautline::MeshFile ReadMesh() override;

private:
  vtkTetGenReader(const vtkTetGenReader&) = delete;
  void operator=(const vtkTetGenReader&) = delete;
};

#endif
