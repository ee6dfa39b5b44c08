// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeditWriter
 * @brief Writes Medit's .mesh (text, version 2), with a .sol for arrays that it cannot hold, or
 * .meshb (binary), without these arrays.
 *
 * The reference of points and cells is `Reference` (otherwise `BoundaryMarker`); for boundary cells
 * `BoundaryMarker` takes precedence. `Fixed`, `Corner`, `Ridge`, `Required` become
 * RequiredVertices, Corners, Ridges, RequiredEdges and RequiredTriangles. Planar meshes are written
 * in 2D.
 *
 * Limitations: only linear cells, without polygons; cells are sorted by type; field data are not
 * written.
 *
 * @sa vtkMeshFileWriter vtkMeditReader tautline::writeMedit
 */
#ifndef vtkMeditWriter_h
#define vtkMeditWriter_h

#include "vtkMeshFileWriter.h"

class TAUTLINEREADERS_EXPORT vtkMeditWriter : public vtkMeshFileWriter
{
public:
  static vtkMeditWriter* New();
  vtkTypeMacro(vtkMeditWriter, vtkMeshFileWriter);

protected:
  vtkMeditWriter() = default;
  ~vtkMeditWriter() override = default;
  std::vector<std::string> WriteMesh(
    const tautline::MeshFile& mesh, const std::string& name) override;

private:
  vtkMeditWriter(const vtkMeditWriter&) = delete;
  void operator=(const vtkMeditWriter&) = delete;
};

#endif
