// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkOffWriter
 * @brief Writes OFF files, or with `Color` (bytes, or doubles up to 1) and `Normals` COFF, NOFF and
 * CNOFF files.
 *
 * Supports polygons, lines and vertices of any data set; the cell array `Color` defines the colors
 * of faces.
 *
 * Limitations: OFF files cannot hold other arrays.
 *
 * @sa vtkMeshFileWriter vtkOffReader tautline::writeOff
 */
#ifndef vtkOffWriter_h
#define vtkOffWriter_h

#include "vtkMeshFileWriter.h"

class TAUTLINEREADERS_EXPORT vtkOffWriter : public vtkMeshFileWriter
{
public:
  static vtkOffWriter* New();
  vtkTypeMacro(vtkOffWriter, vtkMeshFileWriter);

protected:
  vtkOffWriter() = default;
  ~vtkOffWriter() override = default;
  std::vector<std::string> WriteMesh(
    const tautline::MeshFile& mesh, const std::string& name) override;

private:
  vtkOffWriter(const vtkOffWriter&) = delete;
  void operator=(const vtkOffWriter&) = delete;
};

#endif
