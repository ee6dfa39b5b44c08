// SPDX-License-Identifier: BSD-3-Clause
#include "MeditContents.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace tautline
{
namespace
{
constexpr std::int32_t One = 1, OneSwapped = 0x01000000;
constexpr std::int32_t OldestVersion = 1, LatestVersion = 4;

/// The numbers of a binary file, whose sizes depend on its version.
class MeditBytes
{
public:
  explicit MeditBytes(const FileContent& file)
    : File(file)
    , Cursor(file)
  {
    this->need(2 * sizeof(std::int32_t), "its version");
    const auto code = this->Cursor.binary<std::int32_t>("byte order");
    if (code != One && code != OneSwapped)
    {
      this->fail("this is not a binary Medit file, which begins with the number 1");
    }
    this->Cursor.setSwap(code == OneSwapped);
    this->Version = this->word("version");
    if (this->Version < OldestVersion || this->Version > LatestVersion)
    {
      this->fail("version " + std::to_string(this->Version) + " of the format cannot be read");
    }
  }

  [[noreturn]] void fail(const std::string& problem) const
  {
    throw FileError(this->File.name() + ": " + problem);
  }
  void need(std::size_t bytes, const char* what) const
  {
    if (this->left() < bytes)
    {
      this->fail(std::string("the file ends before ") + what + ": it is truncated");
    }
  }
  std::size_t at() const
  {
    return static_cast<std::size_t>(this->Cursor.place() - this->File.begin());
  }
  std::size_t left() const { return this->Cursor.bytesLeft(); }
  std::size_t size() const { return this->at() + this->left(); }
  void moveTo(std::size_t byte) { this->Cursor.moveTo(this->File.begin() + byte); }

  std::size_t realSize() const { return this->Version == 1 ? sizeof(float) : sizeof(double); }
  std::size_t integerSize() const
  {
    return this->Version >= 4 ? sizeof(std::int64_t) : sizeof(std::int32_t);
  }
  std::size_t positionSize() const
  {
    return this->Version >= 3 ? sizeof(std::int64_t) : sizeof(std::int32_t);
  }
  std::int32_t word(const char* what) { return this->Cursor.binary<std::int32_t>(what); }
  Index integer(const char* what) { return this->wide(this->integerSize(), what); }
  Index position(const char* what) { return this->wide(this->positionSize(), what); }
  Index integer(const char* what, Index low, Index high)
  {
    const Index value = this->integer(what);
    if (value < low || value > high)
    {
      this->fail(std::string(what) + " is " + std::to_string(value) + ", from " +
        std::to_string(low) + " to " + std::to_string(high) + " is expected");
    }
    return value;
  }
  double coordinate()
  {
    const double value = this->Version == 1
      ? static_cast<double>(this->Cursor.binary<float>("coordinate"))
      : this->Cursor.binary<double>("coordinate");
    if (!std::isfinite(value))
    {
      this->fail("a coordinate is not a finite number");
    }
    return value;
  }
  void countRecord() { this->Cursor.countRecord(); }

private:
  Index wide(std::size_t bytes, const char* what)
  {
    return bytes == sizeof(std::int64_t) ? this->Cursor.binary<std::int64_t>(what)
                                         : this->Cursor.binary<std::int32_t>(what);
  }

  const FileContent& File;
  TextCursor Cursor;
  std::int32_t Version = 0;
};

/// The number of records of a section, which must fill it up to its end.
Index recordsOf(MeditBytes& bytes, const std::string& section, std::size_t record, std::size_t end)
{
  if (end - bytes.at() < bytes.integerSize())
  {
    bytes.fail("the section " + section + " has no count");
  }
  const Index count = bytes.integer("count");
  const std::size_t room = end - bytes.at();
  if (count < 0 || static_cast<std::size_t>(count) > room / record ||
    static_cast<std::size_t>(count) * record != room)
  {
    bytes.fail("the section " + section + " has " + std::to_string(room) +
      " bytes, and its count is " + std::to_string(count) + ", of " + std::to_string(record) +
      " bytes each: the file is truncated or damaged");
  }
  return count;
}

void readVertices(MeditBytes& bytes, std::size_t end, MeditContents& contents)
{
  if (contents.dimension == 0 || contents.points >= 0)
  {
    bytes.fail(
      contents.points >= 0 ? "a second section Vertices" : "Vertices come before Dimension");
  }
  const std::size_t record =
    static_cast<std::size_t>(contents.dimension) * bytes.realSize() + bytes.integerSize();
  contents.points = recordsOf(bytes, "Vertices", record, end);
  resizeLarge(contents.coordinates, static_cast<std::size_t>(3 * contents.points));
  contents.pointReferences.resize(static_cast<std::size_t>(contents.points));
  for (std::size_t i = 0; i < contents.pointReferences.size(); ++i)
  {
    for (int c = 0; c < contents.dimension; ++c)
    {
      contents.coordinates[3 * i + static_cast<std::size_t>(c)] = bytes.coordinate();
    }
    contents.pointReferences[i] = bytes.integer("reference of a vertex");
    bytes.countRecord();
  }
}

void readCells(
  MeditBytes& bytes, const MeditSection& section, std::size_t end, MeditContents& contents)
{
  if (contents.points < 0)
  {
    bytes.fail(std::string(section.name) + " come before Vertices");
  }
  const auto size = static_cast<std::size_t>(cellNodes(section.type));
  const auto count =
    static_cast<std::size_t>(recordsOf(bytes, section.name, (size + 1) * bytes.integerSize(), end));
  std::vector<Index>& nodes = contents.nodes[section.type];
  std::vector<Index>& references = contents.references[section.type];
  std::size_t node = nodes.size(), reference = references.size();
  resizeLarge(nodes, node + count * size);
  resizeLarge(references, reference + count);
  for (std::size_t i = 0; i < count; ++i)
  {
    for (std::size_t c = 0; c < size; ++c)
    {
      nodes[node++] = bytes.integer("vertex", 1, contents.points) - 1;
    }
    if (section.type == FileWedge)
    {
      turnMeditWedge(nodes, node);
    }
    references[reference++] = bytes.integer("reference");
    bytes.countRecord();
  }
}

void readList(MeditBytes& bytes, const char* section, std::size_t end, MeditContents& contents)
{
  std::vector<Index>& ids = contents.lists[section];
  for (Index count = recordsOf(bytes, section, bytes.integerSize(), end); count > 0; --count)
  {
    ids.push_back(bytes.integer(section, 1, std::numeric_limits<Index>::max()) - 1);
  }
}

/// Codes of cells that are not read: curved ones, polygons, polyhedra.
bool isOtherCell(std::int32_t code)
{
  constexpr std::int32_t Codes[] = { 24, 25, 27, 30, 33, 46, 47 };
  constexpr std::int32_t FirstCurved = 86, LastCurved = 103, Groups1 = 94, Groups2 = 95;
  return std::find(std::begin(Codes), std::end(Codes), code) != std::end(Codes) ||
    (code >= FirstCurved && code <= LastCurved && code != Groups1 && code != Groups2);
}

void readSection(MeditBytes& bytes, std::int32_t code, std::size_t end, MeditContents& contents)
{
  const auto* section = std::find_if(std::begin(MeditSections), std::end(MeditSections),
    [code](const MeditSection& each) { return each.code == code; });
  const auto* list = std::find_if(std::begin(MeditLists), std::end(MeditLists),
    [code](const MeditList& each) { return each.code == code; });
  if (code == MeditDimension)
  {
    bytes.need(sizeof(std::int32_t), "the dimension");
    contents.dimension = bytes.word("dimension");
    if (contents.dimension != 2 && contents.dimension != 3)
    {
      bytes.fail("dimension is " + std::to_string(contents.dimension) + ", 2 or 3 is expected");
    }
  }
  else if (code == MeditVertices)
  {
    readVertices(bytes, end, contents);
  }
  else if (section != std::end(MeditSections))
  {
    readCells(bytes, *section, end, contents);
  }
  else if (list != std::end(MeditLists))
  {
    readList(bytes, list->name, end, contents);
  }
  else if (isOtherCell(code) && end - bytes.at() > bytes.integerSize())
  {
    contents.warnings.push_back("the cells of the section with the code " + std::to_string(code) +
      ", which are curved, polygons or polyhedra, are left out");
  }
}
}

//------------------------------------------------------------------------------
bool isMeditBinary(const std::string& name)
{
  const OpenFile file = openFile(name);
  std::int32_t code = 0;
  return file && std::fread(&code, sizeof(code), 1, file.get()) == 1 &&
    (code == One || code == OneSwapped);
}

//------------------------------------------------------------------------------
MeditContents readMeditBinary(const FileContent& file)
{
  MeditBytes bytes(file);
  MeditContents contents;
  for (bool last = false; !last;)
  {
    if (bytes.left() == 0)
    {
      if (!contents.hasCells())
      {
        bytes.fail("the file ends without the keyword End: it is truncated");
      }
      contents.warnings.push_back(meditWithoutEnd("the file"));
      break;
    }
    const std::size_t start = bytes.at();
    bytes.need(sizeof(std::int32_t) + bytes.positionSize(), "the next section");
    const std::int32_t code = bytes.word("section");
    const Index next = bytes.position("position");
    if (code == MeditEnd)
    {
      break;
    }
    last = next == 0;
    const std::size_t end = last ? bytes.size() : static_cast<std::size_t>(next);
    if (next < 0 || end < bytes.at() || end > bytes.size())
    {
      bytes.fail("the section at byte " + std::to_string(start) + " ends at byte " +
        std::to_string(next) + " of " + std::to_string(bytes.size()) +
        ": the file is truncated or damaged");
    }
    readSection(bytes, code, end, contents);
    bytes.moveTo(end);
  }
  if (contents.points < 0)
  {
    bytes.fail("there is no section Vertices");
  }
  return contents;
}
}
