// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkImageFileReader
 * @brief Reads one image: PNG, JPEG, TIFF, BMP, binary PGM or PPM.
 *
 * The format is found by the content of the file, and VTK's reader of the format reads it. A file
 * that is truncated, damaged or of another kind is an error that names the file
 * (ImageFileAdapter.h lists the kinds); so is every message of VTK's reader. An image has at most
 * 100 million pixels.
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
   * The file.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * Whether a file begins as one of the formats does.
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

  /// Calls work(file name); its errors become messages. Returns whether there were none.
  int Guarded(const std::function<void(const std::string&)>& work);

  char* FileName = nullptr;
};

#endif
