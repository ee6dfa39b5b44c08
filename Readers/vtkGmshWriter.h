// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkGmshWriter
 * @brief Writes Gmsh's .msh 4.1, text or binary, and .pos.
 *
 * A file name with the extension `.pos` gives a view for every array instead of a mesh, as text:
 * see tautline::writeGmshViews. The following applies to .msh.
 *
 * `Reference` (otherwise `BoundaryMarker`) becomes the physical tag, `Entity` the elementary tag;
 * all other numeric arrays become $NodeData and $ElementData, as doubles. Supports linear and
 * quadratic cells, and Lagrange cells of orders 1 to 4 that are the same along all axes, also
 * mixed.
 *
 * Limitations: Gmsh itself shows only data with 1, 3 or 9 components; others are nevertheless
 * written.
 *
 * @sa vtkMeshFileWriter vtkGmshReader tautline::writeGmsh
 */
#ifndef vtkGmshWriter_h
#define vtkGmshWriter_h

#include "vtkMeshFileWriter.h"

class TAUTLINEREADERS_EXPORT vtkGmshWriter : public vtkMeshFileWriter
{
public:
  static vtkGmshWriter* New();
  vtkTypeMacro(vtkGmshWriter, vtkMeshFileWriter);

  ///@{
  /**
   * Whether to write binary files, which are smaller and faster. The default is off.
   */
  vtkSetMacro(Binary, bool);
  vtkGetMacro(Binary, bool);
  vtkBooleanMacro(Binary, bool);
  ///@}

protected:
  vtkGmshWriter() = default;
  ~vtkGmshWriter() override = default;
  std::vector<std::string> WriteMesh(
    const tautline::MeshFile& mesh, const std::string& name) override;

  bool Binary = false;

private:
  vtkGmshWriter(const vtkGmshWriter&) = delete;
  void operator=(const vtkGmshWriter&) = delete;
};

#endif
