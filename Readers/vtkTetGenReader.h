// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTetGenReader
 * @brief Reads the file sets of TetGen and Triangle: .node .ele .face .edge .poly .smesh.
 *
 * Opening any file of a set finds its companions by their common stem: part.1.ele is read with
 * part.1.node, and with LowerCells also with part.1.face and part.1.edge. Supports 2D and 3D,
 * vertices numbered from 0 or 1, attributes, markers, comments, and second-order elements. .poly
 * and .smesh give the input of a mesher: polygons (2D: segments), with `Holes` and `Regions` in the
 * field data.
 *
 * Point arrays: `BoundaryMarker`, attributes. Cell arrays: `Reference` (the first attribute of the
 * elements), further attributes, `BoundaryMarker` of faces and edges.
 *
 * Limitations: .neigh, .vol, .mtr, .var, .b.node are not supported; neighbors listed after a face
 * are skipped.
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
