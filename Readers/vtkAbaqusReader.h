// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkAbaqusReader
 * @brief Reads the mesh of input files of Abaqus and CalculiX (.inp).
 *
 * Parts and instances become one mesh, with the translations and rotations of the assembly. Node
 * and element sets become arrays of 0 and 1 with their names. Files that generate nodes or elements
 * (*NGEN, *ELGEN, ...) and unknown element types are an error that gives the line.
 *
 * @sa vtkMeshFileReader tautline::readAbaqus
 */
#ifndef vtkAbaqusReader_h
#define vtkAbaqusReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkAbaqusReader : public vtkMeshFileReader
{
public:
  static vtkAbaqusReader* New();
  vtkTypeMacro(vtkAbaqusReader, vtkMeshFileReader);

  int CanReadFile(const char* name) override;

protected:
  vtkAbaqusReader() = default;
  ~vtkAbaqusReader() override = default;
  tautline::MeshFile ReadMesh() override;

private:
  vtkAbaqusReader(const vtkAbaqusReader&) = delete;
  void operator=(const vtkAbaqusReader&) = delete;
};

#endif
