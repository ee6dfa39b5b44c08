// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMfemReader
 * @brief Reads MFEM's .mesh files, straight or with nodes of order 1 to 6.
 *
 * Versions 1.0, 1.2 and 1.3 are supported. Elements with H1 or L2 nodes become VTK's quadratic
 * cells with all nodes (order 2) or Lagrange cells. Cell array: `Reference`, the attribute;
 * LowerCells adds the boundary elements. Nonconforming and NURBS meshes are not supported.
 *
 * @sa vtkMeshFileReader tautline::readMfem
 */
#ifndef vtkMfemReader_h
#define vtkMfemReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkMfemReader : public vtkMeshFileReader
{
public:
  static vtkMfemReader* New();
  vtkTypeMacro(vtkMfemReader, vtkMeshFileReader);

  int CanReadFile(const char* name) override;

protected:
  vtkMfemReader() = default;
  ~vtkMfemReader() override = default;
  tautline::MeshFile ReadMesh() override;

private:
  vtkMfemReader(const vtkMfemReader&) = delete;
  void operator=(const vtkMfemReader&) = delete;
};

#endif
