// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFluentMeshReader
 * @brief Reads the mesh of a Fluent case or mesh file (.cas, .msh), without results.
 *
 * Files are text or binary, in single or double precision, with cells of any kind: FoamMesh has
 * them as faces with a cell on each side, as OpenFOAM does. The output has all points in the order
 * of the file, then
 * - the cells: cell i is cell i + 1 of Fluent; a tetrahedron, pyramid, wedge or hexahedron where
 *   its faces are those of VTK's cell, else a polyhedron; in two dimensions a triangle,
 *   quadrilateral or polygon;
 * - with PatchFaces, the faces of the boundary, zone by zone.
 *
 * The arrays are those of vtkFoamMeshReader: zones of boundary faces are its patches, with Fluent's
 * types ("velocity-inlet") in `PatchTypes`, but "cyclic" for pairs of periodic zones whose faces
 * the file lists; zones of cells are `CellZone`; zones of internal faces, such as a fan, are
 * `FaceZone <name>`. `Face` numbers the faces as OpenFOAM orders them: internal ones first.
 *
 * Hanging nodes of adapted meshes, intersected mesh interfaces and meshes of surfaces are errors,
 * which name the remedy. The Common Fluids Format (.cas.h5) is another format.
 *
 * @sa vtkMeshFileReader vtkFoamMeshReader tautline::readFluent
 */
#ifndef vtkFluentMeshReader_h
#define vtkFluentMeshReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkFluentMeshReader : public vtkMeshFileReader
{
public:
  static vtkFluentMeshReader* New();
  vtkTypeMacro(vtkFluentMeshReader, vtkMeshFileReader);

  ///@{
  /**
   * Whether the faces of the boundary are cells of the output. The default is on. The same as
   * LowerCells.
   */
  void SetPatchFaces(bool on) { this->SetLowerCells(on); }
  bool GetPatchFaces() const { return this->LowerCells; }
  vtkBooleanMacro(PatchFaces, bool);
  ///@}

  /**
   * Number, name and type of each patch of the mesh that was read last, a line each.
   */
  const char* GetPatchList() const { return this->PatchList.c_str(); }

  int CanReadFile(const char* name) override;

protected:
  vtkFluentMeshReader();
  ~vtkFluentMeshReader() override = default;
  void ReadPart(const tautline::PartRequest& request, vtkDataObject* output) override;

private:
  std::string PatchList;

  vtkFluentMeshReader(const vtkFluentMeshReader&) = delete;
  void operator=(const vtkFluentMeshReader&) = delete;
};

#endif
