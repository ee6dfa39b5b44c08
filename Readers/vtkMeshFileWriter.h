// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshFileWriter
 * @brief What Tautline's mesh writers share: a file name, the input, errors.
 *
 * A subclass names a format. A mesh with cells the format has not is refused, by name and number of
 * the cells, and nothing is written. Numbers have as many digits as it takes to read the same
 * number back. Discretization what was written gives the same mesh with the same arrays, apart from
 * arrays that are not numeric and integers other than 64-bit ones, which come back as 64-bit.
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
   * The file to write. No default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * Writes, and returns 1 if all went well, else 0.
   */
  int Write() override;

  /**
   * What went wrong the last time; empty if nothing did.
   */
  const char* GetErrorText() const { return this->ErrorText.c_str(); }

  ///@{
  /**
   * The files written the last time.
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
  /// The same for a data set that is valid.
  virtual std::vector<std::string> WriteDataSet(vtkDataSet* mesh, const std::string& name);
  /// The file to write, for messages too; throws tautline::Error without one.
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
