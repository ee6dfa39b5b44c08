// SPDX-License-Identifier: BSD-3-Clause
// Image files: every format is read with the pixels that were written; a file that is cut anywhere,
// damaged, of another kind or no file at all is an error that names it, also in a folder.

#include "MeshFileChecks.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkCommand.h"
#include "vtkImageFileReader.h"
#include "vtkSilhouetteSetReader.h"

#include <filesystem>
#include <sys/stat.h>

using namespace tautline;
namespace fs = std::filesystem;

namespace
{
fs::path corpus; ///< images of 4 x 3 pixels, and a BMP file with a palette of 3 x 2
fs::path folder; ///< to write to

/// The messages of a reader; its executive reports that it failed.
/// The error message of reading an image of these bytes.
std::string complaintOf(const std::string& bytes)
{
  const std::string name = (folder / "image").string();
  writeText(name, bytes);
  TAUTLINE_NEW(vtkImageFileReader, reader, SetFileName(name.c_str()));
  const std::string message = errorOf(reader);
  TAUTLINE_CHECK(message.empty() || message.find(name) != message.npos);
  TAUTLINE_CHECK(message.empty() == (reader->GetOutput()->GetNumberOfPoints() > 0));
  return message;
}

void expect(const std::string& bytes, const std::string& part)
{
  const std::string message = complaintOf(bytes);
  if (message.find(part) == message.npos)
  {
    std::cerr << "message: " << message << "\nnot: " << part << "\n";
    TAUTLINE_CHECK(!"message");
  }
}

/// The bytes with others at a place.
std::string with(std::string bytes, std::size_t at, const std::string& others)
{
  return bytes.replace(at, others.size(), others);
}

TAUTLINE_PART(testPixels)
{
  for (const char* name : { "grey.png", "alpha.png", "colour.tif", "colour.bmp", "grey.pgm",
         "colour.ppm", "colour.jpg", "grey.jpg" })
  {
    const Context context(name);
    TAUTLINE_NEW(vtkImageFileReader, reader, SetFileName((corpus / name).string().c_str()));
    TAUTLINE_CHECK(reader->CanReadFile(reader->GetFileName()));
    TAUTLINE_CHECK_EQUAL(errorOf(reader), std::string());
    const int* size = reader->GetOutput()->GetDimensions();
    TAUTLINE_CHECK(size[0] == 4 && size[1] == 3 && size[2] == 1);
    vtkDataArray* values = reader->GetOutput()->GetPointData()->GetScalars();
    const bool lossy = contains(name, ".jpg");
    for (vtkIdType i = 0; values && !lossy && i < 12 * values->GetNumberOfComponents(); ++i)
    {
      const int components = values->GetNumberOfComponents();
      TAUTLINE_CHECK_EQUAL(values->GetComponent(i / components, static_cast<int>(i % components)),
        static_cast<double>(i * 37 % 256));
    }
  }
  // VTK alone takes the last bytes of a BMP file for the pixels.
  const std::string bmp = readText((corpus / "colour.bmp").string());
  TAUTLINE_CHECK_EQUAL(complaintOf(bmp + "xyz"), std::string());
  TAUTLINE_NEW(
    vtkImageFileReader, longer, SetFileName((folder / "image").string().c_str()), Update());
  TAUTLINE_CHECK_EQUAL(longer->GetOutput()->GetPointData()->GetScalars()->GetComponent(0, 1), 37.0);
}

/// Cut anywhere, a file is an error; with a changed byte it is one or an image.
TAUTLINE_PART(testDamage)
{
  for (const auto& entry : fs::directory_iterator(corpus))
  {
    const Context context(entry.path().filename().string());
    const std::string bytes = readText(entry.path().string());
    for (std::size_t size = 0; size < bytes.size(); size += size < 100 ? 1 : 7)
    {
      TAUTLINE_CHECK(!complaintOf(bytes.substr(0, size)).empty());
    }
    for (std::size_t at = 0; at < std::min<std::size_t>(bytes.size(), 150); ++at)
    {
      complaintOf(with(bytes, at, "\xff"));
      complaintOf(with(bytes, at, std::string(1, '\0')));
    }
  }
}

/// A gray TIFF file of 2 x 2 pixels, 1 2 in the first row and 3 4 below, with other values of tags.
std::string tiff(const std::map<int, int>& changed, int nextDirectory = 0)
{
  std::map<int, int> tags = { { 256, 2 }, { 257, 2 }, { 258, 8 }, { 259, 1 }, { 262, 1 },
    { 273, 8 }, { 277, 1 }, { 278, 2 }, { 279, 4 } };
  for (const auto& [tag, value] : changed)
  {
    tags[tag] = value;
  }
  const auto number = [](int value, int bytes)
  {
    std::string text;
    for (int i = 0; i < bytes; ++i)
    {
      text += static_cast<char>(value >> 8 * i & 0xff);
    }
    return text;
  };
  std::string text = "II*" + number(0, 1) + number(12, 4) + "\1\2\3\4";
  text += number(static_cast<int>(tags.size()), 2);
  for (const auto& [tag, value] : tags)
  {
    constexpr int shortType = 3;
    text += number(tag, 2) + number(shortType, 2) + number(1, 4) + number(value, 4);
  }
  return text + number(nextDirectory, 4);
}

TAUTLINE_PART(testTiff)
{
  for (const bool oriented : { false, true })
  {
    TAUTLINE_CHECK_EQUAL(complaintOf(oriented ? tiff({ { 274, 1 } }) : tiff({})), std::string());
    TAUTLINE_NEW(
      vtkImageFileReader, reader, SetFileName((folder / "image").string().c_str()), Update());
    vtkDataArray* values = reader->GetOutput()->GetPointData()->GetScalars();
    for (vtkIdType i = 0; i < 4; ++i) // the first row is the top one
    {
      TAUTLINE_CHECK_EQUAL(values->GetComponent(i, 0), static_cast<double>((i + 2) % 4 + 1));
    }
  }
  expect(tiff({ { 259, 8 } }), wording("its-compression-tiff-tag"));
  expect(tiff({ { 284, 2 }, { 277, 3 } }), wording("its-planar-configuration"));
  expect(tiff({ { 322, 16 }, { 323, 16 } }), wording("its-width-of-a-tile"));
  expect(tiff({ { 262, 2 } }), wording("fewer-than-3-samples"));
  // a second page with the same pixels
  const std::string first = tiff({}), page = first.substr(12);
  const auto begin = static_cast<int>(first.size());
  expect(tiff({}, begin) + page, wording("its-size-is-2-x-2-x-2"));
}

TAUTLINE_PART(testMessages)
{
  const auto text = [](const char* name) { return readText((corpus / name).string()); };
  expect("", wording("it-is-none-of-png-jpeg"));
  expect("no picture", wording("it-is-none-of-png-jpeg-tiff"));
  expect(text("short.tga"), wording("it-is-none-of-png"));
  expect(with(text("grey.png"), 20, "\x01"), wording("the-check-sum-of-a-chunk-is"));
  expect("P5\n4 3\n65535\n" + std::string(24, 'x'), wording("largest-value-is-65535"));
  expect("P5\n0 3\n255\n", wording("width-is-0"));
  expect("P5\n99999 99999\n255\n", wording("its-size-is-99999-x-99999"));
  expect("P5\n4 3\n255\nabc", wording("the-file-is-truncated"));
  expect("P2\n1 1\n255\n7\n", wording("it-is-none-of"));
  expect(with(text("colour.bmp"), 30, "\x01"), wording("not-compressed"));
  expect(with(text("colour.bmp"), 28, "\x04"), wording("only-bmp-depths"));
  // Damage is noticed also where messages are switched off.
  vtkObject::GlobalWarningDisplayOff();
  vtkNew<vtkImageFileReader> quiet;
  quiet->SetFileName((folder / "image").string().c_str()); // the last one
  quiet->Update();
  TAUTLINE_CHECK_EQUAL(quiet->GetOutput()->GetNumberOfPoints(), vtkIdType{ 0 });
  vtkObject::GlobalWarningDisplayOn();
  TAUTLINE_CHECK_EQUAL(complaintOf("P5 # a comment\n2 1 # another\n255\nab"), std::string());
}

TAUTLINE_PART(testFolder)
{
  const fs::path set = folder / "set";
  fs::remove_all(set);
  fs::create_directories(set);
  fs::copy_file(corpus / "grey.png", set / "b1.png");
  fs::copy_file(corpus / "grey.pgm", set / "a1.txt");
  fs::copy_file(corpus / "short.tga", set / "short.tga");
  writeText((set / "notes.png").string(), "no picture");
  TAUTLINE_CHECK(mkfifo((set / "pipe.png").string().c_str(), 0600) == 0);
  TAUTLINE_NEW(vtkSilhouetteSetReader, reader, SetFileName(set.string().c_str()));
  TAUTLINE_CHECK_EQUAL(errorOf(reader), std::string());
  auto* blocks = outputOf<vtkMultiBlockDataSet>(reader);
  TAUTLINE_CHECK_EQUAL(blocks->GetNumberOfBlocks(), 2u); // by content, in the order of the names
  // A list that names what is no image, and a damaged image of a folder.
  for (const char* name : { "short.tga", "notes.png", "pipe.png" })
  {
    writeText((set / "list.csv").string(), "file,class\nb1.png,b\n" + std::string(name) + ",c\n");
    TAUTLINE_NEW(vtkSilhouetteSetReader, listed, SetFileName((set / "list.csv").string().c_str()));
    TAUTLINE_CHECK(contains(errorOf(listed), name));
  }
  const std::string whole = readText((set / "b1.png").string());
  writeText((set / "b1.png").string(), whole.substr(0, whole.size() / 2));
  TAUTLINE_NEW(vtkSilhouetteSetReader, damaged, SetFileName(set.string().c_str()));
  const std::string message = errorOf(damaged);
  TAUTLINE_CHECK(contains(message, wording("b1-png-the-image-cannot-be-read")));
  fs::remove(set / "b1.png");
  fs::remove(set / "a1.txt");
  TAUTLINE_NEW(vtkSilhouetteSetReader, none, SetFileName(set.string().c_str()));
  TAUTLINE_CHECK(contains(errorOf(none), wording("no-images-png")));
  for (const char* name : { "", "nowhere.png", "pipe.png" })
  {
    vtkNew<vtkImageFileReader> single;
    single->SetFileName(*name ? (set / name).string().c_str() : "");
    TAUTLINE_CHECK(!errorOf(single).empty());
    TAUTLINE_CHECK(!single->CanReadFile(single->GetFileName()));
  }
}
}

TAUTLINE_TEST(TestImageFiles)
{
  corpus = fs::path(argv[1]) / "../Testing/Fuzz/Corpus/image";
  folder = fs::path(argv[2]) / "image-files";
  fs::create_directories(folder);
}
