// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMfemWriter
 * @brief Writes MFEM's .mesh, straight or with nodes of the order of the cells.
 *
 * Linear meshes are written with vertices, curved meshes with H1 or L2 nodes. With a template (the
 * original file of the mesh), the output is this file with new nodes: space, ordering and all other
 * text are kept.
 *
 * Limitations: lines, polygons, curved pyramids and cells whose orders differ by axis are not
 * supported; arrays other than `Reference`, the attribute, are not written.
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
   * Whether neighbors share their nodes (space H1); otherwise each element has its own (L2), as in
   * periodic meshes. The default is on. Not used with a template.
   */
  vtkSetMacro(Continuous, bool);
  vtkGetMacro(Continuous, bool);
  vtkBooleanMacro(Continuous, bool);
  ///@}

  ///@{
  /**
   * The original curved file of the mesh, in which only the nodes are replaced. The default is
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
