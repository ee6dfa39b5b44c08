// SPDX-License-Identifier: BSD-3-Clause
#include "ImageFile.h"

#include "TextCursor.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string_view>

#include <sys/stat.h>

namespace tautline
{
namespace
{
using ImageBytes = std::string_view;

constexpr ImageBytes PngStart("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t LongestStart = 8;

ImageFormat formatOf(ImageBytes start)
{
  const auto begins = [start](ImageBytes with) { return start.substr(0, with.size()) == with; };
  return begins(PngStart)                                                    ? ImageFormat::Png
    : begins("\xff\xd8\xff")                                                 ? ImageFormat::Jpeg
    : begins(ImageBytes("II\x2a\0", 4)) || begins(ImageBytes("MM\0\x2a", 4)) ? ImageFormat::Tiff
    : begins("BM")                                                           ? ImageFormat::Bmp
    : (begins("P5") || begins("P6")) && start.size() > 2 &&
      (std::isspace(static_cast<unsigned char>(start[2])) || start[2] == '#')
    ? ImageFormat::Pnm
    : ImageFormat::None;
}

/// The bytes of one file; what is read beyond the end is an error.
class Image
{
public:
  explicit Image(const FileContent& file)
    : File(file)
    , Content(file.begin(), static_cast<std::size_t>(file.end() - file.begin()))
  {
  }

  [[noreturn]] void fail(const std::string& problem) const
  {
    throw FileError(this->File.name() + ": the image cannot be read: " + problem);
  }
  [[noreturn]] void failTruncated() const { this->fail("the file is truncated"); }

  std::size_t size() const { return this->Content.size(); }
  ImageBytes part(std::size_t at, std::size_t count) const
  {
    this->expect(at, count);
    return this->Content.substr(at, count);
  }
  /// Throws unless the file has these bytes.
  void expect(std::size_t at, std::size_t count) const
  {
    if (at > this->size() || count > this->size() - at)
    {
      this->failTruncated();
    }
  }
  std::size_t byte(std::size_t at) const { return this->number(at, 1, false); }
  /// An unsigned number of 1, 2 or 4 bytes.
  std::size_t number(std::size_t at, std::size_t count, bool bigEndian) const
  {
    const ImageBytes bytes = this->part(at, count);
    std::size_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      value = value << 8 | static_cast<unsigned char>(bytes[bigEndian ? i : count - 1 - i]);
    }
    return value;
  }
  /// Throws unless there are from 1 to MaxPixels pixels.
  void expectPixels(std::size_t width, std::size_t height) const
  {
    if (width == 0 || height == 0 || width > MaxPixels / height)
    {
      this->fail("its size is " + std::to_string(width) + " x " + std::to_string(height) +
        "; from 1 to " + std::to_string(MaxPixels) + " pixels are allowed");
    }
  }
  std::size_t rfind(ImageBytes text) const { return this->Content.rfind(text); }
  char at(std::size_t place) const { return this->part(place, 1)[0]; }

private:
  const FileContent& File;
  ImageBytes Content;
};

/// The check sum of PNG chunks (ISO 3309).
std::uint32_t checkSum(ImageBytes bytes)
{
  static const auto table = []
  {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t n = 0; n < made.size(); ++n)
    {
      std::uint32_t c = n;
      for (int bit = 0; bit < 8; ++bit)
      {
        c = c & 1 ? 0xedb88320u ^ c >> 1 : c >> 1;
      }
      made[n] = c;
    }
    return made;
  }();
  std::uint32_t sum = 0xffffffffu;
  for (const char byte : bytes)
  {
    sum = table[(sum ^ static_cast<unsigned char>(byte)) & 0xff] ^ sum >> 8;
  }
  return ~sum;
}

ImageHeader checkPng(const Image& image)
{
  // a chunk: 4 bytes length, 4 bytes name, data, 4 bytes check sum of name and data
  ImageHeader header{ ImageFormat::Png };
  bool data = false;
  for (std::size_t at = PngStart.size();;)
  {
    const std::size_t length = image.number(at, 4, true);
    const ImageBytes named = image.part(at + 4, length + 4);
    if (image.number(at + 8 + length, 4, true) != checkSum(named))
    {
      image.fail("the check sum of a chunk is wrong: the file is damaged");
    }
    const ImageBytes name = named.substr(0, 4);
    if ((name == "IHDR") != (header.width == 0) || (name == "IHDR" && length != 13))
    {
      image.fail("its header is damaged");
    }
    if (name == "IHDR")
    {
      header.width = image.number(at + 8, 4, true);
      header.height = image.number(at + 12, 4, true);
      image.expectPixels(header.width, header.height);
    }
    data = data || name == "IDAT";
    if (name == "IEND" && data)
    {
      return header;
    }
    if (name == "IEND")
    {
      image.fail("it has no pixels");
    }
    at += 12 + length;
  }
}

ImageHeader checkJpeg(const Image& image)
{
  // segments of a marker FF xx and a length, up to the compressed pixels, which end with FF D9
  constexpr std::size_t Baseline = 0xc0, Extended = 0xc1, Progressive = 0xc2, LastFrame = 0xcf;
  constexpr std::size_t HuffmanTable = 0xc4, Extension = 0xc8, ArithmeticTable = 0xcc, Scan = 0xda;
  ImageHeader header{ ImageFormat::Jpeg };
  for (std::size_t at = 2;;)
  {
    if (image.byte(at) != 0xff)
    {
      image.fail("its header is damaged");
    }
    const std::size_t marker = image.byte(at + 1);
    if (marker == 0xff)
    {
      ++at; // a fill byte
      continue;
    }
    const std::size_t length = image.number(at + 2, 2, true);
    image.expect(at + 2, length);
    if (marker == Baseline || marker == Extended || marker == Progressive)
    {
      header.height = image.number(at + 5, 2, true);
      header.width = image.number(at + 7, 2, true);
      image.expectPixels(header.width, header.height);
      const std::size_t components = image.byte(at + 9);
      if (image.byte(at + 4) != 8 || (components != 1 && components != 3))
      {
        image.fail("only JPEG of 1 or 3 components of 8 bits can be read");
      }
    }
    else if (marker > Progressive && marker <= LastFrame && marker != HuffmanTable &&
      marker != Extension && marker != ArithmeticTable)
    {
      image.fail("only baseline and progressive JPEG can be read");
    }
    else if (marker == Scan)
    {
      if (header.width == 0)
      {
        image.fail("its header is damaged");
      }
      const std::size_t end = image.rfind("\xff\xd9");
      if (end == ImageBytes::npos || end < at)
      {
        image.failTruncated();
      }
      return header;
    }
    at += 2 + length;
  }
}

/// The first directory of a TIFF file: tags with values.
class TiffDirectory
{
public:
  explicit TiffDirectory(const Image& image)
    : Pixels(image)
    , BigEndian(image.byte(0) == 'M')
    , At(this->number(4, 4))
    , Count(this->number(this->At, 2))
  {
    constexpr std::size_t EntrySize = 12;
    image.expect(this->At + 2, EntrySize * this->Count + 4);
    if (this->number(this->At + 2 + EntrySize * this->Count, 4) != 0)
    {
      image.fail("a TIFF file of more than one page cannot be read");
    }
  }
  /// The values of a tag, a single one in place of a missing tag.
  std::vector<std::size_t> values(std::size_t tag, std::size_t missing) const
  {
    constexpr std::size_t Byte = 1, Short = 3, Long = 4;
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      const std::size_t entry = this->At + 2 + 12 * i;
      if (this->number(entry, 2) != tag)
      {
        continue;
      }
      const std::size_t type = this->number(entry + 2, 2), count = this->number(entry + 4, 4);
      if ((type != Byte && type != Short && type != Long) || count == 0)
      {
        this->Pixels.fail("its header is damaged");
      }
      const std::size_t size = type == Byte ? 1 : type == Short ? 2 : 4;
      const std::size_t place = count * size <= 4 ? entry + 8 : this->number(entry + 8, 4);
      this->Pixels.expect(place, count * size);
      std::vector<std::size_t> found(count);
      for (std::size_t j = 0; j < count; ++j)
      {
        found[j] = this->number(place + j * size, size);
      }
      return found;
    }
    return { missing };
  }
  std::size_t value(std::size_t tag, std::size_t missing) const
  {
    return this->values(tag, missing)[0];
  }

private:
  std::size_t number(std::size_t at, std::size_t count) const
  {
    return this->Pixels.number(at, count, this->BigEndian);
  }

  const Image& Pixels;
  bool BigEndian;
  std::size_t At, Count;
};

ImageHeader checkTiff(const Image& image)
{
  enum : std::size_t
  {
    Width = 256,
    Height = 257,
    BitsPerSample = 258,
    Compression = 259,
    Photometric = 262,
    StripOffsets = 273,
    Orientation = 274,
    SamplesPerPixel = 277,
    RowsPerStrip = 278,
    StripByteCounts = 279,
    Planar = 284,
    TileWidth = 322
  };
  const TiffDirectory directory(image);
  ImageHeader header{ ImageFormat::Tiff, directory.value(Width, 0), directory.value(Height, 0) };
  image.expectPixels(header.width, header.height);
  const std::size_t samples = directory.value(SamplesPerPixel, 1);
  for (const std::size_t bits : directory.values(BitsPerSample, 1))
  {
    if ((bits != 8 && bits != 16) || samples < 1 || samples > 4)
    {
      image.fail(std::to_string(samples) + " samples of " + std::to_string(bits) +
        " bits per pixel; 1 to 4 samples of 8 or 16 bits are allowed");
    }
  }
  constexpr std::size_t Separate = 2;
  if (directory.value(TileWidth, 0) != 0 || directory.value(Planar, 1) == Separate)
  {
    image.fail("a TIFF file of tiles or of separate planes cannot be read");
  }
  // VTK returns arbitrary values for Deflate.
  constexpr std::size_t NotCompressed = 1, Lzw = 5, PackBits = 32773;
  const std::size_t compression = directory.value(Compression, NotCompressed);
  if (compression != NotCompressed && compression != Lzw && compression != PackBits)
  {
    image.fail("its compression is " + std::to_string(compression) +
      "; none (1), LZW (5) and PackBits (32773) are allowed");
  }
  constexpr std::size_t TopLeft = 1;
  if (directory.value(Orientation, TopLeft) != TopLeft)
  {
    image.fail("only TIFF files whose first row is the top one can be read");
  }
  constexpr std::size_t Palette = 3;
  if (directory.value(Photometric, 1) > Palette)
  {
    image.fail("only grey values, RGB and palettes can be read");
  }
  // All strips must be in the file, and together have all rows.
  const auto offsets = directory.values(StripOffsets, 0);
  const auto counts = directory.values(StripByteCounts, 0);
  const std::size_t rows = std::min(directory.value(RowsPerStrip, header.height), header.height);
  if (rows == 0 || offsets.size() != counts.size() ||
    offsets.size() != (header.height + rows - 1) / rows)
  {
    image.fail("its header is damaged");
  }
  std::size_t total = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i)
  {
    image.expect(offsets[i], counts[i]);
    total += counts[i];
  }
  const std::size_t bytes =
    header.width * header.height * samples * (directory.value(BitsPerSample, 1) / 8);
  if (total == 0 || (compression == NotCompressed && total < bytes))
  {
    image.failTruncated();
  }
  return header;
}

ImageHeader checkBmp(const Image& image)
{
  constexpr std::size_t ShortInfo = 12, LongInfo = 40, FileHeader = 14;
  ImageHeader header{ ImageFormat::Bmp };
  header.dataOffset = image.number(10, 4, false);
  const std::size_t info = image.number(FileHeader, 4, false);
  if (info != ShortInfo && info != LongInfo)
  {
    image.fail("only BMP files of version 3 can be read");
  }
  const std::size_t size = info == LongInfo ? 4 : 2;
  header.width = image.number(FileHeader + 4, size, false);
  header.height = image.number(FileHeader + 4 + size, size, false);
  if (info == LongInfo && header.height >> 31)
  {
    header.height = (std::size_t{ 1 } << 32) - header.height; // negative: from the top down
  }
  image.expectPixels(header.width, header.height);
  const std::size_t bits = image.number(FileHeader + 6 + 2 * size, 2, false);
  const std::size_t compression =
    info == LongInfo ? image.number(FileHeader + 16, 4, false) : std::size_t{ 0 };
  if ((bits != 8 && bits != 24) || compression != 0)
  {
    image.fail("only BMP files of 8 or 24 bits per pixel, not compressed, can be read");
  }
  const std::size_t row = (header.width * (bits / 8) + 3) / 4 * 4;
  if (header.dataOffset < FileHeader + info)
  {
    image.fail("its header is damaged");
  }
  image.expect(header.dataOffset, row * header.height);
  return header;
}

/// A number of a PNM header, after blanks and comments; `at` moves behind it.
std::size_t pnmNumber(const Image& image, std::size_t& at)
{
  const auto blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  while (blank(image.at(at)) || image.at(at) == '#')
  {
    if (image.at(at) == '#')
    {
      while (image.at(at) != '\n')
      {
        ++at;
      }
    }
    ++at;
  }
  std::size_t value = 0;
  const std::size_t start = at;
  for (; image.at(at) >= '0' && image.at(at) <= '9' && value <= MaxPixels; ++at)
  {
    value = 10 * value + static_cast<std::size_t>(image.at(at) - '0');
  }
  if (at == start || !blank(image.at(at)))
  {
    image.fail("its header is damaged");
  }
  return value;
}

ImageHeader checkPnm(const Image& image)
{
  ImageHeader header{ ImageFormat::Pnm };
  const std::size_t samples = image.at(1) == '5' ? 1 : 3;
  std::size_t at = 2;
  header.width = pnmNumber(image, at);
  header.height = pnmNumber(image, at);
  const std::size_t largest = pnmNumber(image, at);
  image.expectPixels(header.width, header.height);
  if (largest < 1 || largest > 255)
  {
    image.fail("its largest value is " + std::to_string(largest) + "; 1 to 255 are allowed");
  }
  // One blank follows; VTK takes CR LF for one.
  const bool both = image.at(at) == '\r' && at + 1 < image.size() && image.at(at + 1) == '\n';
  image.expect(at + (both ? 2 : 1), header.width * header.height * samples);
  return header;
}
}

//------------------------------------------------------------------------------
ImageFormat findImageFormat(const std::string& name)
{
  struct stat status;
  const OpenFile file = openFile(name);
  if (!file || fstat(fileno(file.get()), &status) != 0 || !S_ISREG(status.st_mode))
  {
    return ImageFormat::None;
  }
  char start[LongestStart];
  const std::size_t size = std::fread(start, 1, sizeof(start), file.get());
  return formatOf(ImageBytes(start, size));
}

//------------------------------------------------------------------------------
ImageHeader checkImage(const std::string& name)
{
  const FileContent file(name);
  const Image image(file);
  switch (formatOf(image.part(0, std::min(image.size(), LongestStart))))
  {
    case ImageFormat::Png:
      return checkPng(image);
    case ImageFormat::Jpeg:
      return checkJpeg(image);
    case ImageFormat::Tiff:
      return checkTiff(image);
    case ImageFormat::Bmp:
      return checkBmp(image);
    case ImageFormat::Pnm:
      return checkPnm(image);
    default:
      image.fail(std::string("it is none of ") + ImageFormats);
  }
}
}
