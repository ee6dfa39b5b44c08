// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshFileReader
 * @brief Base class of Tautline's mesh readers: the file name, lower-dimensional cells, errors.
 *
 * A subclass names a format. The whole file is read at once and checked; its first error is
 * reported as "file:line: problem" and leaves an empty output. Coordinates are double precision.
 * Array names are the same for all formats (see MeshFile.h): `Fixed`, `BoundaryMarker`,
 * `Reference`.
 *
 * If a piece of several is requested, the reader takes the whole file into memory and keeps one
 * compact part of the mesh (recursive bisection, see MeshPart.h), with global ids of points and
 * cells and as many layers of ghost cells as are requested.
 *
 * A request for as many pieces as VTK's global controller has MPI ranks is collective: all ranks
 * must execute the reader. If one of them fails (a missing file, too little memory), all report an
 * error, so that no filter downstream works on an incomplete mesh.
 *
 * @sa vtkTetGenReader vtkMeditReader vtkGmshReader vtkMfemReader vtkOffReader vtkFoamMeshReader
 * vtkMeshFileWriter
 */
#ifndef vtkMeshFileReader_h
#define vtkMeshFileReader_h

#include "TautlineReadersModule.h" // for export macro
#include "vtkAlgorithm.h"

#include <string> // for the error text

class vtkDataObject;
class vtkPointSet;

namespace tautline
{
struct MeshFile;
struct PartRequest;
}

class TAUTLINEREADERS_EXPORT vtkMeshFileReader : public vtkAlgorithm
{
public:
  vtkTypeMacro(vtkMeshFileReader, vtkAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to read. No default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether cells of lower dimension than the mesh are kept: boundary triangles beside tetrahedra,
   * edges beside triangles, with their markers. Off, the output is a mesh every filter can take as
   * it is. The default is off.
   */
  vtkSetMacro(LowerCells, bool);
  vtkGetMacro(LowerCells, bool);
  vtkBooleanMacro(LowerCells, bool);
  ///@}

  /**
   * What was wrong with the file that was read last; empty if nothing was.
   */
  const char* GetErrorText() const { return this->ErrorText.c_str(); }

  /**
   * Whether the extension and the first bytes are those of a file of this format.
   */
  virtual int CanReadFile(const char* name) = 0;

  /**
   * The mesh: a vtkUnstructuredGrid, of vtkOffReader a vtkPolyData.
   */
  vtkPointSet* GetOutput();

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkMeshFileReader();
  ~vtkMeshFileReader() override;

  /// Reads this->FileName; throws tautline::Error. A subclass overrides this or ReadPart().
  virtual tautline::MeshFile ReadMesh();
  /// Fills the output with a part of the mesh of this->FileName; throws tautline::Error.
  virtual void ReadPart(const tautline::PartRequest& request, vtkDataObject* output);

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  virtual int RequestData(vtkInformationVector* outputs);

  char* FileName = nullptr;
  bool LowerCells = false;

private:
  void ReadFile(const tautline::PartRequest& request, vtkDataObject* output);

  std::string ErrorText;

  vtkMeshFileReader(const vtkMeshFileReader&) = delete;
  void operator=(const vtkMeshFileReader&) = delete;
};

#endif
