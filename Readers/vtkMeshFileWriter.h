// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshFileWriter
 * @brief Base class of Tautline's mesh writers; handles the file name, the input and errors.
 *
 * A subclass implements a format. If a mesh has cells that the format does not support, the error
 * gives their type and number, and nothing is written. Numbers have as many digits as needed to
 * read back the same number. Reading a written file gives the same mesh with the same arrays,
 * except for arrays that are not numeric and for integers of other widths, which are read back as
 * 64-bit integers.
 *
 * @sa vtkTetGenWriter vtkMeditWriter vtkGmshWriter vtkOffWriter vtkFoamPointsWriter
 * vtkMeshFileReader
 */
#ifndef vtkMeshFileWriter_h
#define vtkMeshFileWriter_h

#include "TautlineReadersModule.h" // for export macro
#include "vtkWriter.h"

#include <string> // for the names of files
#include <vector> // for the names of files

class vtkDataSet;

namespace tautline
{
struct MeshFile;
}

class TAUTLINEREADERS_EXPORT vtkMeshFileWriter : public vtkWriter
{
public:
  vtkTypeMacro(vtkMeshFileWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write. There is no default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * Writes the file. Returns 1 on success, otherwise 0.
   */
  int Write() override;

  /**
   * The error message of the last write; empty if there was no error.
   */
  const char* GetErrorText() const { return this->ErrorText.c_str(); }

  ///@{
  /**
   * The files of the last write.
   */
  int GetNumberOfFilesWritten() const { return static_cast<int>(this->FilesWritten.size()); }
  const char* GetFileWritten(int i) const { return this->FilesWritten.at(i).c_str(); }
  ///@}

protected:
  vtkMeshFileWriter() = default;
  ~vtkMeshFileWriter() override;

  /// Writes the mesh and returns the names of the files; throws tautline::Error. A subclass
  /// overrides this or WriteDataSet().
  virtual std::vector<std::string> WriteMesh(
    const tautline::MeshFile& mesh, const std::string& name);
  /// The same for a valid data set.
  virtual std::vector<std::string> WriteDataSet(vtkDataSet* mesh, const std::string& name);
  /// The file to write, also for messages; throws tautline::Error if there is none.
  virtual std::string TargetName();

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;

private:
  std::string ErrorText;
  std::vector<std::string> FilesWritten;

  vtkMeshFileWriter(const vtkMeshFileWriter&) = delete;
  void operator=(const vtkMeshFileWriter&) = delete;
};

#endif
