// SPDX-License-Identifier: BSD-3-Clause
#include "ImageFileAdapter.h"

#include "TextCursor.h"

#include "vtkBMPReader.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkImageFlip.h"
#include "vtkJPEGReader.h"
#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkPNGReader.h"
#include "vtkPNMReader.h"
#include "vtkTIFFReader.h"
#include "vtk_zlib.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <string_view>

#include <sys/stat.h>

namespace tautline
{
namespace
{
constexpr std::string_view PngStart("\x89PNG\r\n\x1a\n", 8);

[[noreturn]] void failImage(const std::string& name, const std::string& problem)
{
  throw FileError(name + ": the image cannot be read: " + problem);
}

/// VTK's reader for the format with these first bytes; null if there is none.
vtkSmartPointer<vtkImageReader2> makeReader(std::string_view start)
{
  const auto begins = [start](std::string_view with)
  { return start.substr(0, with.size()) == with; };
  if (begins(PngStart))
  {
    return vtkSmartPointer<vtkPNGReader>::New();
  }
  if (begins("\xff\xd8\xff"))
  {
    return vtkSmartPointer<vtkJPEGReader>::New();
  }
  if (begins(std::string_view("II\x2a\0", 4)) || begins(std::string_view("MM\0\x2a", 4)))
  {
    return vtkSmartPointer<vtkTIFFReader>::New();
  }
  if (begins("BM"))
  {
    return vtkSmartPointer<vtkBMPReader>::New();
  }
  if ((begins("P5") || begins("P6")) && start.size() > 2 &&
    (std::isspace(static_cast<unsigned char>(start[2])) || start[2] == '#'))
  {
    return vtkSmartPointer<vtkPNMReader>::New();
  }
  return nullptr;
}

/// The bytes of a file; reading beyond the end is an error.
class ImageBytes
{
public:
  explicit ImageBytes(const FileContent& file)
    : Name(file.name())
    , Content(file.begin(), static_cast<std::size_t>(file.end() - file.begin()))
  {
  }
  [[noreturn]] void fail(const std::string& problem) const { failImage(this->Name, problem); }

  std::string_view part(std::size_t at, std::size_t count) const
  {
    if (at > this->Content.size() || count > this->Content.size() - at)
    {
      this->fail("the file is truncated");
    }
    return this->Content.substr(at, count);
  }
  /// An unsigned number of several bytes.
  std::size_t number(std::size_t at, std::size_t count, bool bigEndian) const
  {
    const std::string_view bytes = this->part(at, count);
    std::size_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      value = value << 8 | static_cast<unsigned char>(bytes[bigEndian ? i : count - 1 - i]);
    }
    return value;
  }

private:
  std::string Name;
  std::string_view Content;
};

/// Throws unless all chunks of a PNG file are complete and undamaged: VTK's reader crashes
/// otherwise, because it returns from the function to which libpng jumps after an error.
void checkPng(const ImageBytes& image)
{
  // a chunk: 4 bytes length, 4 bytes name, data, 4 bytes checksum of name and data
  bool data = false;
  for (std::size_t at = PngStart.size();;)
  {
    const std::size_t length = image.number(at, 4, true);
    const std::string_view named = image.part(at + 4, length + 4);
    const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
    if (image.number(at + 8 + length, 4, true) != sum)
    {
      image.fail("the checksum of a chunk is wrong: the file is damaged");
    }
    data = data || named.substr(0, 4) == "IDAT";
    if (named.substr(0, 4) == "IEND")
    {
      if (!data)
      {
        image.fail("it has no pixels");
      }
      return;
    }
    at += 12 + length;
  }
}

/// A tag of a TIFF file that determines the storage of the pixels.
struct TiffTag
{
  std::size_t tag, missing; ///< the value of a missing tag
  const char* name;
  std::vector<std::size_t> allowed;
};

/// Throws unless VTK's reader reads this kind of TIFF file correctly or detects the error.
void checkTiff(const ImageBytes& image)
{
  enum : std::size_t
  {
    Bits = 258,
    Compression = 259,
    Photometric = 262,
    Orientation = 274,
    Samples = 277,
    Planes = 284,
    TileWidth = 322
  };
  static const TiffTag tags[] = { { Bits, 1, "number of bits per sample", { 8, 16 } },
    { Compression, 1, "compression", { 1, 5, 32773 } }, // none, LZW, PackBits
    { Photometric, 1, "photometric interpretation", { 0, 1, 2, 3 } },
    { Orientation, 1, "orientation", { 1 } }, // the first row is the top one
    { Samples, 1, "number of samples per pixel", { 1, 2, 3, 4 } },
    { Planes, 1, "planar configuration", { 1 } }, // all samples of a pixel together
    { TileWidth, 0, "width of a tile", { 0 } } };
  const bool bigEndian = image.part(0, 1) == "M";
  const auto number = [&](std::size_t at, std::size_t count)
  { return image.number(at, count, bigEndian); };
  const auto valueOf = [&](std::size_t tag, std::size_t value)
  {
    constexpr std::size_t entrySize = 12, shortType = 3, longType = 4;
    const std::size_t directory = number(4, 4), entries = number(directory, 2);
    for (std::size_t i = 0; i < entries; ++i)
    {
      const std::size_t entry = directory + 2 + entrySize * i;
      if (number(entry, 2) == tag)
      {
        const std::size_t type = number(entry + 2, 2), count = number(entry + 4, 4);
        const std::size_t size = type == shortType ? 2 : type == longType ? 4 : 1;
        value = number(count * size <= 4 ? entry + 8 : number(entry + 8, 4), size);
      }
    }
    return value;
  };
  for (const TiffTag& tag : tags)
  {
    const std::size_t value = valueOf(tag.tag, tag.missing);
    if (std::find(tag.allowed.begin(), tag.allowed.end(), value) == tag.allowed.end())
    {
      std::string allowed;
      for (const std::size_t other : tag.allowed)
      {
        allowed += (allowed.empty() ? "" : ", ") + std::to_string(other);
      }
      image.fail("its " + std::string(tag.name) + " (TIFF tag " + std::to_string(tag.tag) +
        ") is " + std::to_string(value) + "; allowed: " + allowed);
    }
  }
  constexpr std::size_t rgb = 2;
  if (valueOf(Photometric, 1) == rgb && valueOf(Samples, 1) < 3)
  {
    image.fail("its pixels are RGB, with fewer than 3 samples");
  }
}

/// The start of the pixels of a BMP file: VTK would treat the end of the file as their end.
std::size_t checkBmp(const ImageBytes& image)
{
  constexpr std::size_t longInfo = 40;
  if (image.number(14, 4, false) == longInfo && image.number(30, 4, false) != 0)
  {
    image.fail("only uncompressed BMP files are supported");
  }
  return image.number(10, 4, false);
}

/// Throws unless a PNM file has all its numbers and, for a permitted image size, enough bytes.
void checkPnm(const FileContent& file)
{
  TextCursor cursor(file, '#');
  const Index samples = file.begin()[1] == '5' ? 1 : 3;
  cursor.moveTo(file.begin() + 2);
  Index pixels = 1;
  try
  {
    for (const char* what : { "width", "height" })
    {
      cursor.skipToToken();
      pixels *= cursor.integer(what, 1, MaxPixels);
    }
    cursor.skipToToken();
    cursor.integer("largest value", 1, 255);
  }
  catch (const FileError& error) // "file:line: problem"
  {
    failImage(file.name(), "line " + std::string(error.what()).substr(file.name().size() + 1));
  }
  if (pixels <= MaxPixels && cursor.bytesLeft() < static_cast<std::size_t>(pixels * samples) + 1)
  {
    failImage(file.name(), "the file is truncated");
  }
}

/// The first message of a reader; VTK reports damaged pixels as warnings.
void keepMessage(vtkObject*, unsigned long, void* kept, void* message)
{
  auto& text = *static_cast<std::string*>(kept);
  if (text.empty() && message)
  {
    text = static_cast<const char*>(message);
    text.erase(text.find_last_not_of(" \n\r\t") + 1);
    const std::size_t object =
      text.rfind("): "); // before it: "ERROR: In file, line ...\nvtk...(0x...
    text.erase(0, object == text.npos ? 0 : object + 3);
  }
}

/// While it exists, VTK reports errors; otherwise observers get none if messages are switched off.
class Reporting
{
public:
  Reporting() { vtkObject::GlobalWarningDisplayOn(); }
  ~Reporting() { vtkObject::SetGlobalWarningDisplay(this->Before); }
  Reporting(const Reporting&) = delete;
  Reporting& operator=(const Reporting&) = delete;

private:
  const int Before = vtkObject::GetGlobalWarningDisplay();
};

/// Runs a reader; throws if it reports anything.
void expectSilent(
  vtkImageReader2* reader, const std::string& name, const std::function<void()>& work)
{
  const Reporting reporting;
  std::string message;
  vtkNew<vtkCallbackCommand> keep;
  keep->SetCallback(keepMessage);
  keep->SetClientData(&message);
  reader->AddObserver(vtkCommand::ErrorEvent, keep);
  reader->AddObserver(vtkCommand::WarningEvent, keep);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, keep);
  work();
  reader->RemoveObserver(keep);
  reader->GetExecutive()->RemoveObserver(keep);
  if (message.empty() && reader->GetErrorCode() != vtkErrorCode::NoError)
  {
    message = vtkErrorCode::GetStringFromErrorCode(reader->GetErrorCode());
  }
  if (!message.empty())
  {
    failImage(name, message);
  }
}
}

//------------------------------------------------------------------------------
bool isImageFile(const std::string& name)
{
  struct stat status;
  const OpenFile file = openFile(name);
  if (!file || fstat(fileno(file.get()), &status) != 0 || !S_ISREG(status.st_mode))
  {
    return false;
  }
  char start[PngStart.size()];
  const std::size_t size = std::fread(start, 1, sizeof(start), file.get());
  return makeReader(std::string_view(start, size)) != nullptr;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageReader2> openImage(const std::string& name)
{
  const FileContent file(name);
  const ImageBytes image(file);
  const vtkSmartPointer<vtkImageReader2> reader =
    makeReader(std::string_view(file.begin(), static_cast<std::size_t>(file.end() - file.begin())));
  if (!reader)
  {
    image.fail(std::string("it is none of ") + ImageFormats);
  }
  if (vtkPNGReader::SafeDownCast(reader))
  {
    checkPng(image);
  }
  else if (vtkPNMReader::SafeDownCast(reader))
  {
    checkPnm(file);
  }
  else if (auto* tiff = vtkTIFFReader::SafeDownCast(reader))
  {
    checkTiff(image);
    tiff->SetOrientationType(1); // rows in the order of the file
  }
  else if (auto* bmp = vtkBMPReader::SafeDownCast(reader))
  {
    bmp->SetHeaderSize(checkBmp(image));
  }
  // (The PNM reader rejects files with a blank or a comment after P5.)
  if (!vtkPNMReader::SafeDownCast(reader) && !reader->CanReadFile(name.c_str()))
  {
    image.fail("its header is damaged");
  }
  reader->SetFileName(name.c_str());
  expectSilent(reader, name, [&] { reader->UpdateInformation(); });
  const int* extent = reader->GetDataExtent();
  const auto side = [&](int axis) -> vtkIdType
  { return vtkIdType(extent[2 * axis + 1]) - extent[2 * axis] + 1; };
  if (side(0) < 1 || side(1) < 1 || side(2) != 1 || side(0) > MaxPixels / side(1))
  {
    image.fail("its size is " + std::to_string(side(0)) + " x " + std::to_string(side(1)) + " x " +
      std::to_string(side(2)) + "; one page of 1 to " + std::to_string(MaxPixels) +
      " pixels is allowed");
  }
  if (vtkJPEGReader::SafeDownCast(reader) && reader->GetNumberOfScalarComponents() > 3)
  {
    image.fail("only JPEG with 1 or 3 components is supported");
  }
  return reader;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> readImage(const std::string& name)
{
  const vtkSmartPointer<vtkImageReader2> reader = openImage(name);
  expectSilent(reader, name, [&] { reader->Update(); });
  if (!vtkTIFFReader::SafeDownCast(reader))
  {
    return reader->GetOutput();
  }
  // VTK puts the first row of a TIFF file at y = 0, and the first row of other formats at the top.
  vtkNew<vtkImageFlip> flip;
  flip->SetInputData(reader->GetOutput());
  flip->SetFilteredAxis(1);
  flip->Update();
  return flip->GetOutput();
}
}
