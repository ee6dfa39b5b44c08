// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNastranReader
 * @brief Reads the mesh of bulk data of Nastran: .bdf, .nas, .fem.
 *
 * Small, large and free fields, continuation lines, and grid points in systems of coordinates
 * (CORD2R, CORD2C, CORD2S, GRDSET) are read. Cell array: `Reference`, the number of the property.
 *
 * @sa vtkMeshFileReader tautline::readNastran
 */
#ifndef vtkNastranReader_h
#define vtkNastranReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkNastranReader : public vtkMeshFileReader
{
public:
  static vtkNastranReader* New();
  vtkTypeMacro(vtkNastranReader, vtkMeshFileReader);

  int CanReadFile(const char* name) override;

protected:
  vtkNastranReader() = default;
  ~vtkNastranReader() override = default;
  tautline::MeshFile ReadMesh() override;

private:
  vtkNastranReader(const vtkNastranReader&) = delete;
  void operator=(const vtkNastranReader&) = delete;
};

#endif
