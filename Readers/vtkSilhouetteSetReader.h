// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSilhouetteSetReader
 * @brief Reads a set of labelled images: a list of them in a .csv file, or all images of a folder.
 *
 * FileName is one of
 * - a .csv file with a line of column names, of which `file` (relative to the list, or to a folder
 *   `images` beside it) is needed, and `class` or else `class_id`, `label` is the label;
 * - a folder: all images in it, in the order of their names; the label is the name up to the first
 *   digit or blank;
 * - an image in such a folder: the same as the folder.
 *
 * Images are those of vtkImageFileReader: PNG, JPEG, TIFF, BMP, binary PGM and PPM, by their
 * content; other files of a folder are skipped. An image that is truncated or damaged, and a file
 * of a list that is no image, is an error that names the file.
 *
 * The output is a vtkMultiBlockDataSet of vtkImageData. The name of a block is that of the file
 * without its ending; field arrays of the image: `Label` and `File`, strings.
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
   * The list or the folder.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether the images are placed side by side, by their origins: in rows from the top left, in the
   * order of the list. Otherwise they lie on top of each other, with their origins in 0. The
   * default is on.
   */
  vtkSetMacro(SideBySide, bool);
  vtkGetMacro(SideBySide, bool);
  vtkBooleanMacro(SideBySide, bool);
  ///@}

  /**
   * Whether the name is that of a folder, or of a list with a column `file`.
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
