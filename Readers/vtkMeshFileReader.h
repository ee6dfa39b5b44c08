// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshFileReader
 * @brief Base class of Tautline's mesh readers; handles the file name, lower-dimensional cells and
 * errors.
 *
 * A subclass implements a format. The whole file is read and checked; its first error is reported
 * as "file:line: problem" and leaves an empty output. Coordinates are double precision. Array names
 * are the same for all formats (see MeshFile.h): `Fixed`, `BoundaryMarker`, `Reference`.
 *
 * If one of several pieces is requested, the reader reads the whole file into memory and keeps one
 * compact part of the mesh (recursive bisection, see MeshPart.h), with global point and cell ids
 * and the requested number of ghost layers.
 *
 * A request is collective if the number of pieces equals the number of MPI ranks of VTK's global
 * controller: all ranks must execute the reader. If one of them fails (missing file, insufficient
 * memory), all report an error, so that no downstream filter works on an incomplete mesh.
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
   * The file to read. There is no default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether to keep cells of lower dimension than the mesh (boundary triangles beside tetrahedra,
   * edges beside triangles), with their markers. If off, the output is a mesh that every filter can
   * process directly. The default is off.
   */
  vtkSetMacro(LowerCells, bool);
  vtkGetMacro(LowerCells, bool);
  vtkBooleanMacro(LowerCells, bool);
  ///@}

  /**
   * The error message for the last file read; empty if there was no error.
   */
  const char* GetErrorText() const { return this->ErrorText.c_str(); }

  /**
   * Whether the extension and the first bytes match this format.
   */
  virtual int CanReadFile(const char* name) = 0;

  /**
   * The mesh: a vtkUnstructuredGrid, or for vtkOffReader a vtkPolyData.
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
