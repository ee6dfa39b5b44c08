// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNastranReader
 * @brief Reads the mesh in Nastran bulk data: .bdf, .nas, .fem.
 *
 * Small, large and free fields, continuation lines, and grid points in coordinate systems (CORD2R,
 * CORD2C, CORD2S, GRDSET) are supported. Cell array: `Reference`, the property number.
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
