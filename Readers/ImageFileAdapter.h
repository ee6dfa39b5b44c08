// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageFileAdapter.h
 * @brief An image file as vtkImageData, by VTK's reader of its format.
 *
 * The first bytes decide on the format, not the ending of the name. Whatever VTK's reader reports
 * is an error. What it does not notice is checked before: PNG files that are cut or damaged, on
 * which it crashes, kinds of TIFF files of which it returns arbitrary values, RLE in BMP files and
 * where their pixels begin, and numbers in PNM files, which it would search for beyond the end.
 *
 * | format | first bytes | read |
 * |---|---|---|
 * | PNG | 89 P N G 0D 0A 1A 0A | all; the check sums of all chunks are compared |
 * | JPEG | FF D8 FF | grey or YCbCr |
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
/// The formats in words, for messages.
constexpr const char* ImageFormats = "PNG, JPEG, TIFF, BMP, binary PGM and PPM";

/// Pixels an image may have; a header that announces more is an error.
constexpr vtkIdType MaxPixels = 100'000'000;

/// Whether a file begins as one of the formats does; false for what cannot be opened and for what
/// is no regular file.
bool isImageFile(const std::string& name);

/**
 * @brief VTK's reader of an image, with the extent known and no pixels read.
 *
 * Throws FileError, "file: problem", for a file of another format or kind, for one whose header is
 * damaged, and for more than MaxPixels pixels.
 */
vtkSmartPointer<vtkImageReader2> openImage(const std::string& name);

/// The image, its first row at the top. Throws FileError also for damaged pixels.
vtkSmartPointer<vtkImageData> readImage(const std::string& name);
}
#endif
