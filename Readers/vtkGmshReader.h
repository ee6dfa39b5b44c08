// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkGmshReader
 * @brief Reads Gmsh's .msh 1, 2, 4.0 and 4.1, text and binary, and FreeFem++'s .msh.
 *
 * Cell arrays: `Reference` (physical tag; FreeFem++: label), `Entity` (elementary tag). $NodeData
 * and $ElementData come as arrays of their names. Complete elements of orders 1 to 4, of order 3
 * and 4 as Lagrange cells, and the incomplete ones of second order; others are refused by name.
 *
 * Limits: periodic, ghost and partition data are skipped; of a field with several time steps the
 * last is kept.
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
