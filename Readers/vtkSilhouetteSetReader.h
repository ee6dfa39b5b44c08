// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSilhouetteSetReader
 * @brief Reads a set of labeled images: listed in a .csv file, or all images in a folder.
 *
 * FileName is one of
 * - a .csv file with a line of column names: `file` (relative to the list, or to a folder `images`
 *   beside it) is required, and `class`, or otherwise `class_id` or `label`, is the label;
 * - a folder: all images in it, in the order of their names; the label is the name up to the first
 *   digit or blank;
 * - an image in such a folder: the same as the folder.
 *
 * The image formats are as in vtkImageFileReader: PNG, JPEG, TIFF, BMP, binary PGM and PPM,
 * determined by content; other files in a folder are skipped. A truncated or damaged image, and a
 * listed file that is not an image, is an error that names the file.
 *
 * The output is a vtkMultiBlockDataSet of vtkImageData. The name of a block is the name of the file
 * without its extension; each image has the field arrays `Label` and `File` (strings).
 *
 * @sa vtkImageFileReader vtkShapeRetrieval
 */
#ifndef vtkSilhouetteSetReader_h
#define vtkSilhouetteSetReader_h

#include "TautlineReadersModule.h" // for export macro
#include "vtkMultiBlockDataSetAlgorithm.h"

class TAUTLINEREADERS_EXPORT vtkSilhouetteSetReader : public vtkMultiBlockDataSetAlgorithm
{
public:
  static vtkSilhouetteSetReader* New();
  vtkTypeMacro(vtkSilhouetteSetReader, vtkMultiBlockDataSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The list, the folder, or an image in it. There is no default.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether to place the images side by side, by their origins, in rows from the top left, in the
   * order of the list. Otherwise they overlap, with their origins at 0. The default is on.
   */
  vtkSetMacro(SideBySide, bool);
  vtkGetMacro(SideBySide, bool);
  vtkBooleanMacro(SideBySide, bool);
  ///@}

  /**
   * Whether the name belongs to a folder, or to a list with a column `file`.
   */
  int CanReadFile(const char* name);

protected:
  vtkSilhouetteSetReader();
  ~vtkSilhouetteSetReader() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSilhouetteSetReader(const vtkSilhouetteSetReader&) = delete;
  void operator=(const vtkSilhouetteSetReader&) = delete;

  char* FileName = nullptr;
  bool SideBySide = true;
};

#endif
