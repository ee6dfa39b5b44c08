// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkImageFileReader
 * @brief Reads one image: PNG, JPEG, TIFF, BMP, binary PGM or PPM.
 *
 * The format is determined from the content of the file, which is read by VTK's reader for the
 * format. A file that is truncated, damaged or of another kind is an error that names the file
 * (ImageFileAdapter.h lists the kinds), and so is every message of VTK's reader. An image has at
 * most 100 million pixels.
 *
 * The output is vtkImageData in the plane z = 0.
 *
 * @sa vtkSilhouetteSetReader vtkSilhouetteMesher
 */
#ifndef vtkImageFileReader_h
#define vtkImageFileReader_h

#include "TautlineReadersModule.h" // for export macro
#include "vtkImageAlgorithm.h"

#include <functional> // for Guarded()
#include <string>

class TAUTLINEREADERS_EXPORT vtkImageFileReader : public vtkImageAlgorithm
{
public:
  static vtkImageFileReader* New();
  vtkTypeMacro(vtkImageFileReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to read. There is no default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * Whether a file begins like one of the formats.
   */
  static bool CanReadFile(const char* name);

protected:
  vtkImageFileReader();
  ~vtkImageFileReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkImageFileReader(const vtkImageFileReader&) = delete;
  void operator=(const vtkImageFileReader&) = delete;

  /// Calls work(file name) and reports its errors as messages. Returns whether there were none.
  int Guarded(const std::function<void(const std::string&)>& work);

  char* FileName = nullptr;
};

#endif
