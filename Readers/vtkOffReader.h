// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkOffReader
 * @brief Reads Geomview's OFF, COFF, NOFF and CNOFF files.
 *
 * The output is a vtkPolyData. Point arrays: `Normals` (the active normals), `Color`; cell array:
 * `Color`. To show the colors, choose `Color` and switch off Map Scalars.
 *
 * Limitations: binary, 4OFF, nOFF and textured (STOFF) files are not supported; color map entries
 * are skipped.
 *
 * @sa vtkMeshFileReader vtkOffWriter tautline::readOff
 */
#ifndef vtkOffReader_h
#define vtkOffReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkOffReader : public vtkMeshFileReader
{
public:
  static vtkOffReader* New();
  vtkTypeMacro(vtkOffReader, vtkMeshFileReader);

  int CanReadFile(const char* name) override;

protected:
  vtkOffReader() = default;
  ~vtkOffReader() override = default;
  tautline::MeshFile ReadMesh() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;

private:
  vtkOffReader(const vtkOffReader&) = delete;
  void operator=(const vtkOffReader&) = delete;
};

#endif
