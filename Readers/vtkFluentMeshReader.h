// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFluentMeshReader
 * @brief Reads the mesh of a Fluent case or mesh file (.cas, .msh), without results.
 *
 * Files are text or binary, in single or double precision, with cells of any kind, stored in a
 * FoamMesh as faces with a cell on each side, as in OpenFOAM. The output has all points in the
 * order of the file, then
 * - the cells: cell i is cell i + 1 of Fluent; a tetrahedron, pyramid, wedge or hexahedron if its
 *   faces match VTK's cell, otherwise a polyhedron; in two dimensions a triangle, quadrilateral or
 *   polygon;
 * - with PatchFaces, the faces of the boundary, zone by zone.
 *
 * The arrays are as in vtkFoamMeshReader: zones of boundary faces become patches, with Fluent's
 * types ("velocity-inlet") in `PatchTypes`, except "cyclic" for pairs of periodic zones whose faces
 * the file lists; zones of cells become `CellZone`; zones of internal faces, such as a fan, become
 * `FaceZone <name>`. `Face` numbers the faces in OpenFOAM's order, internal faces first.
 *
 * Hanging nodes of adapted meshes, intersected mesh interfaces and surface meshes are errors that
 * name the remedy. The Common Fluids Format (.cas.h5) is not supported.
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
   * Whether the faces of the boundary are cells of the output. The default is on. Same as
   * LowerCells.
   */
  void SetPatchFaces(bool on) { this->SetLowerCells(on); }
  bool GetPatchFaces() const { return this->LowerCells; }
  vtkBooleanMacro(PatchFaces, bool);
  ///@}

  /**
   * Number, name and type of each patch of the last mesh read, one line each.
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
