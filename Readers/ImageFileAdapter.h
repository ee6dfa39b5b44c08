// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageFileAdapter.h
 * @brief Reads an image file as vtkImageData, using VTK's reader for its format.
 *
 * The first bytes determine the format, not the file name extension. All messages of VTK's reader
 * are errors. Problems that it does not detect are checked before: truncated or damaged PNG files,
 * on which it crashes, kinds of TIFF files for which it returns arbitrary values, RLE and the start
 * of the pixels in BMP files, and numbers in PNM files, which it would search for beyond the end.
 *
 * | format | first bytes | read |
 * |---|---|---|
 * | PNG | 89 P N G 0D 0A 1A 0A | all; the checksums of all chunks are compared |
 * | JPEG | FF D8 FF | gray or YCbCr |
 * | TIFF | I I 2A 00, M M 00 2A | one page, 8 or 16 bits; not compressed, LZW, PackBits |
 * | BMP | B M | 8 or 24 bits per pixel, not compressed |
 * | PGM, PPM | P5, P6 | binary, values up to 255 |
 */
#ifndef tautline_ImageFileAdapter_h
#define tautline_ImageFileAdapter_h

#include "TautlineReadersModule.h" // for export macro

#include "vtkSmartPointer.h"

#include <string>

class vtkImageData;
class vtkImageReader2;

namespace tautline
{
/// The names of the formats, for messages.
constexpr const char* ImageFormats = "PNG, JPEG, TIFF, BMP, binary PGM and PPM";

/// Maximum number of pixels of an image; a header that announces more is an error.
constexpr vtkIdType MaxPixels = 100'000'000;

/// Whether a file begins like one of the formats; false if it cannot be opened or is not a regular
/// file.
bool isImageFile(const std::string& name);

/**
 * @brief VTK's reader for an image, with a known extent before any pixels are read.
 *
 * Throws FileError, "file: problem", for a file of another format or kind, for a damaged header,
 * and for more than MaxPixels pixels.
 */
vtkSmartPointer<vtkImageReader2> openImage(const std::string& name);

/// The image, its first row at the top. Throws FileError also for damaged pixels.
vtkSmartPointer<vtkImageData> readImage(const std::string& name);
}
#endif
