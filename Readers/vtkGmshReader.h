// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkGmshReader
 * @brief Reads Gmsh's .msh 1, 2, 4.0 and 4.1, text and binary, and FreeFem++'s .msh.
 *
 * Cell arrays: `Reference` (physical tag; FreeFem++: label), `Entity` (elementary tag). $NodeData
 * and $ElementData become arrays with their names. Complete elements of orders 1 to 4 (orders 3 and
 * 4 as Lagrange cells) and incomplete elements of second order are supported; other elements are an
 * error that names them.
 *
 * Limitations: periodic, ghost and partition data are skipped; only the last of several time steps
 * of a field is kept.
 *
 * @sa vtkMeshFileReader vtkGmshWriter tautline::readGmsh
 */
#ifndef vtkGmshReader_h
#define vtkGmshReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkGmshReader : public vtkMeshFileReader
{
public:
  static vtkGmshReader* New();
  vtkTypeMacro(vtkGmshReader, vtkMeshFileReader);

  int CanReadFile(const char* name) override;

protected:
  vtkGmshReader() = default;
  ~vtkGmshReader() override = default;
  tautline::MeshFile ReadMesh() override;

private:
  vtkGmshReader(const vtkGmshReader&) = delete;
  void operator=(const vtkGmshReader&) = delete;
};

#endif
