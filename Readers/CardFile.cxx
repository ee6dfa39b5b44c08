// SPDX-License-Identifier: BSD-3-Clause
#include "CardFile.h"

#include <algorithm>
#include <array>

namespace tautline
{
namespace
{
/// Prevents endless recursion of files that include each other.
constexpr std::size_t MaxIncluded = 1000;
constexpr std::size_t MaxCellNodes = 27;
}

//------------------------------------------------------------------------------
CardText::CardText(const std::string& name)
{
  const std::size_t slash = name.find_last_of('/');
  this->Folder = slash == name.npos ? std::string() : name.substr(0, slash + 1);
  this->Sources.emplace_back(name, std::string());
  this->Open.push_back(&this->Sources.back());
  this->Last = { &this->Sources.back().cursor, this->Sources.back().content.begin() };
}

//------------------------------------------------------------------------------
bool CardText::next(std::string_view& line)
{
  if (this->Again)
  {
    this->Again = false;
    line = this->Line;
    return true;
  }
  while (!this->Open.empty() && this->Open.back()->cursor.atEnd())
  {
    this->Open.pop_back();
  }
  if (this->Open.empty())
  {
    return false;
  }
  TextCursor& cursor = this->Open.back()->cursor;
  const char* start = cursor.place();
  cursor.skipRestOfLine();
  line = std::string_view(start, static_cast<std::size_t>(cursor.place() - start));
  if (!cursor.atEnd())
  {
    cursor.moveTo(cursor.place() + 1);
  }
  if (!line.empty() && line.back() == '\r')
  {
    line.remove_suffix(1);
  }
  cursor.countRecord();
  this->Line = line;
  this->Last = { &cursor, start };
  return true;
}

//------------------------------------------------------------------------------
void CardText::include(const std::string& name)
{
  const std::string file = name.empty() || name[0] == '/' ? name : this->Folder + name;
  const bool open = std::any_of(this->Open.begin(), this->Open.end(),
    [&](const Source* source) { return source->content.name() == file; });
  if (open || this->Sources.size() >= MaxIncluded)
  {
    this->fail(open ? file + " is included by itself"
                    : "more than " + std::to_string(MaxIncluded) + " files are included");
  }
  try
  {
    this->Sources.emplace_back(file, std::string());
  }
  catch (const FileError& error)
  {
    this->fail(error.what());
  }
  this->Open.push_back(&this->Sources.back());
}

//------------------------------------------------------------------------------
std::string_view trimmed(std::string_view text)
{
  constexpr const char* blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == text.npos ? std::string_view()
                            : text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

//------------------------------------------------------------------------------
std::string upperCase(std::string_view text)
{
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
    [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

//------------------------------------------------------------------------------
std::vector<std::string_view> splitAtCommas(std::string_view line)
{
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= line.size();)
  {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    parts.push_back(trimmed(line.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  return parts;
}

//------------------------------------------------------------------------------
void NumberedCells::add(
  unsigned char type, Index number, const Index* fileNodes, const int* order, CardPlace place)
{
  const int size = cellNodes(type);
  for (int i = 0; i < size; ++i)
  {
    this->nodes.push_back(fileNodes[order ? order[i] : i]);
  }
  this->types.push_back(type);
  this->numbers.push_back(number);
  this->offsets.push_back(static_cast<Index>(this->nodes.size()));
  this->places.push_back(place);
}

//------------------------------------------------------------------------------
void NumberedNodes::add(Index number, const double* point, CardPlace place)
{
  const auto [known, isNew] =
    this->positions.emplace(number, static_cast<Index>(this->numbers.size()));
  if (isNew)
  {
    this->numbers.push_back(number);
    this->coordinates.insert(this->coordinates.end(), point, point + 3);
  }
  else if (!std::equal(point, point + 3, &this->coordinates[3 * known->second]))
  {
    place.fail("node " + std::to_string(number) + " is given twice, with other coordinates");
  }
}

//------------------------------------------------------------------------------
Index NumberedNodes::find(Index number, CardPlace place) const
{
  const auto found = this->positions.find(number);
  if (found == this->positions.end())
  {
    place.fail("an element uses node " + std::to_string(number) + ", which is not in the file");
  }
  return found->second;
}

//------------------------------------------------------------------------------
void appendCells(
  MeshFile& mesh, const NumberedCells& cells, const NumberedNodes& nodes, Index firstPoint)
{
  std::array<Index, MaxCellNodes> ids{};
  for (std::size_t cell = 0; cell < cells.types.size(); ++cell)
  {
    const Index begin = cells.offsets[cell], size = cells.offsets[cell + 1] - begin;
    for (Index i = 0; i < size; ++i)
    {
      const Index number = cells.nodes[static_cast<std::size_t>(begin + i)];
      ids[static_cast<std::size_t>(i)] = firstPoint + nodes.find(number, cells.places[cell]);
    }
    mesh.addCell(cells.types[cell], ids.data(), size);
  }
}
}
