// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFoamMeshReader
 * @brief Reads the mesh of an OpenFOAM case: polyhedra, patches and zones, without its fields.
 *
 * FileName is a .foam or .OpenFOAM file in the case directory, its system/controlDict, the
 * directory itself, or a directory polyMesh. Files are text or binary, with labels and scalars of
 * 32 or 64 bits, and may be compressed. Missing, truncated or inconsistent data are an error with
 * file and line (in binary files the byte). Points are from the constant mesh; a warning names a
 * time step that has other points.
 *
 * The output has all points in the order of the file, then
 * - the cells: cell i is cell i of OpenFOAM; a tetrahedron, pyramid, wedge or hexahedron if its
 *   faces match VTK's cell, otherwise a polyhedron with its faces in the order of their numbers,
 *   each as seen from outside;
 * - with PatchFaces, the faces of the boundary in their order: triangles, quadrilaterals, polygons.
 *
 * Cell arrays:
 * - `Patch` (int): number of the patch of a face of the boundary; -1 for cells
 * - `Face` (vtkIdType): number of a face of the boundary in OpenFOAM; -1 for cells
 * - `CellZone` (int), if there are zones: number of the (first) zone of a cell; -1 for none
 *
 * Field arrays:
 * - `PatchNames`, `PatchTypes` (strings): name and type of each patch
 * - `NeighbourPatch` (int): for each patch, the number of its neighbourPatch, or -1
 * - `ProcessorNumbers` (int, 2 components), if there are processor patches: the myProcNo and
 *   neighbProcNo of each processor patch, -1 for others
 * - `CellZoneNames`, `FaceZoneNames` (strings), and for each zone of faces `FaceZone <name>`
 *   (vtkIdType) with the numbers of its faces
 * - `FacesOutOfOrder` (vtkIdType): the number of internal faces that are not in upper triangular
 *   order, as counted by checkMesh
 * - `FoamCase` (strings): the absolute paths of the directories polyMesh that were read, for
 *   vtkFoamPointsWriter
 *
 * Decomposed cases: a single process reads one mesh, in the order before the decomposition if the
 * lists *ProcAddressing exist and fit, otherwise joined along the processor patches. A requested
 * piece r of n has the processors r, r + n, ..., with their processor patches. A case that is not
 * decomposed is divided and gets processor patches. Pieces have global point and cell ids (the
 * cells first, then the faces of the boundary), and no ghost cells.
 *
 * @sa vtkMeshFileReader vtkFoamPointsWriter tautline::readFoamCase
 */
#ifndef vtkFoamMeshReader_h
#define vtkFoamMeshReader_h

#include "vtkMeshFileReader.h"

class TAUTLINEREADERS_EXPORT vtkFoamMeshReader : public vtkMeshFileReader
{
public:
  static vtkFoamMeshReader* New();
  vtkTypeMacro(vtkFoamMeshReader, vtkMeshFileReader);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The meshes of a case.
  enum CaseTypes
  {
    AUTOMATIC,     ///< constant/polyMesh if it exists, otherwise the processors
    RECONSTRUCTED, ///< constant/polyMesh
    DECOMPOSED     ///< processor0, processor1, ...
  };

  ///@{
  /**
   * The mesh of a case to read; an invalid number is an error and is not set. The default is
   * AUTOMATIC.
   */
  void SetCaseType(int type);
  vtkGetMacro(CaseType, int);
  ///@}

  ///@{
  /**
   * The region, whose mesh is in constant/<region>/polyMesh. By default there is none, and the mesh
   * is in constant/polyMesh.
   */
  vtkSetStringMacro(RegionName);
  vtkGetStringMacro(RegionName);
  ///@}

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
  vtkFoamMeshReader();
  ~vtkFoamMeshReader() override;
  void ReadPart(const tautline::PartRequest& request, vtkDataObject* output) override;

  int CaseType = AUTOMATIC;
  char* RegionName = nullptr;

private:
  std::string PatchList;

  vtkFoamMeshReader(const vtkFoamMeshReader&) = delete;
  void operator=(const vtkFoamMeshReader&) = delete;
};

#endif
