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
 * On several MPI ranks each rank gets its own compact part of the mesh (recursive bisection, see
 * MeshPart.h), with global ids of points and cells and as many layers of ghost cells as are asked
 * for. Where the ranks of VTK's global controller each ask for the piece of their own number, they
 * read by ranges: each parses its share of the file, and then they exchange points and cells
 * (PartExchange.h). A rank then needs memory in proportion to its part.
 *
 * In all other cases a rank reads the whole file, in memory for the whole mesh, and keeps its part:
 * the same one, exactly. These are pieces without MPI or of another number than there are ranks,
 * sets of files of less than 1 MiB, formats and variants that do not state so in their class, files
 * with an error, and text with another layout than a record per line.
 *
 * A request for piece r of n on rank r of n ranks is therefore collective: all ranks must execute
 * the reader, with files of the same extension, or they wait for each other. (Other differences
 * between them, and a rank without a file name, are noticed: each then reads what it is told to.)
 * Formats and extensions that are never read by ranges do not communicate, nor do other pieces.
 *
 * @sa vtkTetGenReader vtkMeditReader vtkGmshReader vtkOffReader vtkMeshFileWriter
 */
#ifndef vtkMeshFileReader_h
#define vtkMeshFileReader_h

#include "TautlineReadersModule.h" // for export macro
#include "vtkAlgorithm.h"

#include <string> // for the error text

class vtkPointSet;

namespace tautline
{
class FileRanges;
class RankGroup;
struct MeshFile;
struct MeshShare;
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
   * Whether the file that was read last was read by ranges; the same on all ranks.
   */
  vtkGetMacro(ReadByRanges, bool);

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

  /// Reads this->FileName; throws tautline::Error.
  virtual tautline::MeshFile ReadMesh() = 0;
  /// Reads this rank's share of it; throws UnusualFile, on all ranks, where it must be read whole.
  /// That is what it does unless a subclass overrides it.
  virtual tautline::MeshShare ReadShare(const tautline::FileRanges& ranges);
  /// Whether ReadShare() can read files with that extension (in lower case; empty: without a name),
  /// if they are laid out for it. Else ranks do not communicate. False unless a subclass overrides
  /// it.
  virtual bool HasRanges(const std::string& extension) const;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  virtual int RequestData(vtkInformationVector* outputs);

  char* FileName = nullptr;
  bool LowerCells = false;

private:
  tautline::MeshFile ReadPart(const tautline::PartRequest& request);
  tautline::MeshFile ReadPartOfWhole(const tautline::PartRequest& request);
  bool Agrees(tautline::RankGroup& group, const tautline::PartRequest& request) const;
  bool MayHaveRanges() const;

  std::string ErrorText;
  bool ReadByRanges = false;

  vtkMeshFileReader(const vtkMeshFileReader&) = delete;
  void operator=(const vtkMeshFileReader&) = delete;
};

#endif
