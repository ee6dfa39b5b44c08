// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMfemWriter
 * @brief Writes MFEM's .mesh, straight or with nodes of the order of the cells.
 *
 * Linear meshes have vertices, curved ones nodes of H1 or L2. With a template, a file that the mesh
 * was read from, the output is that file with other nodes: space, ordering and all other text stay.
 *
 * Limits: no lines, polygons, curved pyramids, and no cells whose orders differ by axis; arrays
 * other than `Reference`, the attribute, are not written.
 *
 * @sa vtkMeshFileWriter vtkMfemReader tautline::writeMfem
 */
#ifndef vtkMfemWriter_h
#define vtkMfemWriter_h

#include "vtkMeshFileWriter.h"

class TAUTLINEREADERS_EXPORT vtkMfemWriter : public vtkMeshFileWriter
{
public:
  static vtkMfemWriter* New();
  vtkTypeMacro(vtkMfemWriter, vtkMeshFileWriter);

  ///@{
  /**
   * Whether neighbors share their nodes (space H1), else each element has its own (L2), as in
   * periodic meshes. The default is on. Not used with a template.
   */
  vtkSetMacro(Continuous, bool);
  vtkGetMacro(Continuous, bool);
  vtkBooleanMacro(Continuous, bool);
  ///@}

  ///@{
  /**
   * A curved file that the mesh was read from, of which only the nodes are replaced. The default is
   * none.
   */
  vtkSetFilePathMacro(TemplateFileName);
  vtkGetFilePathMacro(TemplateFileName);
  ///@}

protected:
  vtkMfemWriter() = default;
  ~vtkMfemWriter() override;
  std::vector<std::string> WriteMesh(
    const tautline::MeshFile& mesh, const std::string& name) override;

  bool Continuous = true;
  char* TemplateFileName = nullptr;

private:
  vtkMfemWriter(const vtkMfemWriter&) = delete;
  void operator=(const vtkMfemWriter&) = delete;
};

#endif
