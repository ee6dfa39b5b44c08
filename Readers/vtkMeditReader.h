// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeditReader
 * @brief Reads Medit's .mesh (text), .meshb (binary, versions 1 to 4) and .sol files.
 *
 * A .mesh or .meshb is read with its .sol companion, a .sol with its .mesh. Point arrays:
 * `Reference`, `Fixed` (required vertices and corners), `Corner`, fields of the .sol. Cell arrays:
 * `Reference`, `Ridge`, `Required`. Tensors of a .sol become 3 x 3 matrices, row by row, the format
 * of the metric-tensor targets.
 *
 * Limitations: curved (P2) cells are left out, with a warning; binary .solb files are not
 * supported; normals and tangents are skipped.
 *
 * @sa vtkMeshFileReader vtkMeditWriter tautline::readMedit
 */
#ifndef vtkMeditReader_h
#define vtkMeditReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkMeditReader : public vtkMeshFileReader
{
public:
  static vtkMeditReader* New();
  vtkTypeMacro(vtkMeditReader, vtkMeshFileReader);

  int CanReadFile(const char* name) override;

protected:
  vtkMeditReader() = default;
  ~vtkMeditReader() override = default;
  tautline::MeshFile ReadMesh() override;

private:
  vtkMeditReader(const vtkMeditReader&) = delete;
  void operator=(const vtkMeditReader&) = delete;
};

#endif
