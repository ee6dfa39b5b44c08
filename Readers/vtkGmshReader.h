// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkGmshReader
 * @brief Reads Gmsh's .msh 1, 2, 4.0 and 4.1, text and binary, and FreeFem++'s .msh.
 *
 * Cell arrays: `Reference` (physical tag; FreeFem++: label), `Entity` (elementary tag). $NodeData
 * and $ElementData come as arrays of their names. Elements up to second order; those of third and
 * fourth order become linear ones, without the other nodes, with a warning.
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
