// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageFile.h
 * @brief Which image format a file has, and whether it is complete, before VTK reads it.
 *
 * VTK's image readers trust the header of a file. The functions of this file compare it with the
 * bytes that are there, so that a damaged or truncated file is an error with a reason instead of
 * an image of arbitrary values. Only the content counts, not the ending of the name.
 *
 * | format | first bytes | read |
 * |---|---|---|
 * | PNG | 89 P N G 0D 0A 1A 0A | all; the check sums of all chunks are compared |
 * | JPEG | FF D8 FF | baseline and progressive, grey or YCbCr |
 * | TIFF | I I 2A 00, M M 00 2A | one page, 8 or 16 bits; not compressed, LZW, PackBits |
 * | BMP | B M | 8 or 24 bits per pixel, not compressed |
 * | PGM, PPM | P5, P6 | binary, values up to 255 |
 */
#ifndef tautline_ImageFile_h
#define tautline_ImageFile_h

#include "MeshFile.h"

#include <cstddef>
#include <string>

namespace tautline
{
enum class ImageFormat
{
  None, ///< none of those in the table above
  Png,
  Jpeg,
  Tiff,
  Bmp,
  Pnm
};

/// The formats in words, for messages.
constexpr const char* ImageFormats = "PNG, JPEG, TIFF, BMP, binary PGM and PPM";

/// Pixels an image may have; a header that announces more is an error.
constexpr std::size_t MaxPixels = 100'000'000;

/// The format by the first bytes; None for what cannot be opened and for what is no regular file.
TAUTLINEREADERS_EXPORT ImageFormat findImageFormat(const std::string& name);

/// What VTK has to be given about an image.
struct ImageHeader
{
  ImageFormat format = ImageFormat::None;
  std::size_t width = 0, height = 0;
  std::size_t dataOffset = 0; ///< BMP only: the first byte of the pixels
};

/**
 * @brief Checks that an image is complete and of a kind that VTK reads correctly.
 *
 * Throws FileError, "file: problem", for a file of another format, for a truncated or damaged one,
 * and for more than MaxPixels pixels. Compressed pixels are not decompressed.
 */
TAUTLINEREADERS_EXPORT ImageHeader checkImage(const std::string& name);
}
#endif
