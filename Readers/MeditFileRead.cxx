// SPDX-License-Identifier: BSD-3-Clause
#include "MeditFile.h"

#include "FileNames.h"
#include "FileRanges.h"
#include "FileSet.h"
#include "PartExchange.h"
#include "TextCursor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>

namespace tautline
{
namespace
{
constexpr char Comment = '#';
constexpr Index Largest = std::numeric_limits<Index>::max();

/// The sections of a file as they come.
struct Contents
{
  int dimension = 0;
  Index points = -1;
  std::vector<double> coordinates;
  std::vector<Index> pointReferences;
  std::map<unsigned char, std::vector<Index>> nodes;      ///< by type of cell
  std::map<unsigned char, std::vector<Index>> references; ///< by type of cell
  std::map<std::string, std::vector<Index>> lists;        ///< Corners, Ridges, ... as ids
};

std::string nextWord(TextCursor& cursor, const char* what)
{
  if (!cursor.skipToToken())
  {
    cursor.fail(std::string("the file ends before ") + what);
  }
  return std::string(cursor.word());
}

Index nextInteger(TextCursor& cursor, const char* what, Index low, Index high)
{
  cursor.skipToToken();
  return cursor.integer(what, low, high);
}

Index sectionSize(TextCursor& cursor, const std::string& section, std::size_t numbers)
{
  cursor.skipToToken();
  const char* place = cursor.place();
  const Index count = cursor.integer(("number of " + section).c_str());
  if (count < 0)
  {
    cursor.failAt(place, "number of " + section + " is negative: " + std::to_string(count));
  }
  cursor.expectRoom(count, 2 * numbers, ("number of " + section).c_str());
  return count;
}

/// As many vertices, the only ones of the contents.
void readVertexRecords(TextCursor& cursor, Index count, Contents& contents)
{
  resizeLarge(contents.coordinates, static_cast<std::size_t>(3 * count));
  contents.pointReferences.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < contents.pointReferences.size(); ++i)
  {
    for (int c = 0; c < contents.dimension; ++c)
    {
      cursor.skipToToken();
      contents.coordinates[3 * i + static_cast<std::size_t>(c)] = cursor.coordinate("coordinate");
    }
    cursor.skipToToken();
    contents.pointReferences[i] = cursor.integer("reference of a vertex");
    cursor.countRecord();
  }
}

void readVertices(TextCursor& cursor, Contents& contents)
{
  if (contents.dimension == 0)
  {
    cursor.fail("Vertices come before Dimension");
  }
  if (contents.points >= 0)
  {
    cursor.fail("a second section Vertices");
  }
  contents.points =
    sectionSize(cursor, "Vertices", static_cast<std::size_t>(contents.dimension + 1));
  readVertexRecords(cursor, contents.points, contents);
}

/// As many cells, after those of the same section before.
void readCellRecords(
  TextCursor& cursor, const MeditSection& section, std::size_t count, Contents& contents)
{
  const auto size = static_cast<std::size_t>(cellNodes(section.type));
  std::vector<Index>& nodes = contents.nodes[section.type];
  std::vector<Index>& references = contents.references[section.type];
  std::size_t node = nodes.size(), reference = references.size();
  resizeLarge(nodes, node + count * size);
  resizeLarge(references, reference + count);
  for (std::size_t i = 0; i < count; ++i)
  {
    for (std::size_t c = 0; c < size; ++c)
    {
      cursor.skipToToken();
      nodes[node++] = cursor.integer("vertex", 1, contents.points) - 1;
    }
    if (section.type == FileWedge) // counter-clockwise from inside; VTK's from outside
    {
      std::swap(nodes[node - 5], nodes[node - 4]);
      std::swap(nodes[node - 2], nodes[node - 1]);
    }
    cursor.skipToToken();
    references[reference++] = cursor.integer("reference");
    cursor.countRecord();
  }
}

void readCells(TextCursor& cursor, const MeditSection& section, Contents& contents)
{
  if (contents.points < 0)
  {
    cursor.fail(std::string(section.name) + " come before Vertices");
  }
  const auto size = static_cast<std::size_t>(cellNodes(section.type));
  const Index count = sectionSize(cursor, section.name, size + 1);
  readCellRecords(cursor, section, static_cast<std::size_t>(count), contents);
}

/// A number of a list, from 0.
Index readListRecord(TextCursor& cursor, const std::string& section)
{
  cursor.skipToToken();
  return cursor.integer(section.c_str(), 1, Largest) - 1;
}

/// Corners, RequiredVertices, Ridges, RequiredEdges, RequiredTriangles: lists of numbers.
void readList(TextCursor& cursor, const std::string& section, Contents& contents)
{
  std::vector<Index>& ids = contents.lists[section];
  for (Index count = sectionSize(cursor, section, 1); count > 0; --count)
  {
    ids.push_back(readListRecord(cursor, section));
  }
}

/// The section of cells with that name, or null.
const MeditSection* findCells(const std::string& name)
{
  const auto* found = std::find_if(std::begin(MeditSections), std::end(MeditSections),
    [&](const MeditSection& section) { return name == section.name; });
  return found == std::end(MeditSections) ? nullptr : found;
}

bool isList(const std::string& name)
{
  return name == "Corners" || name == "RequiredVertices" || name == "Ridges" ||
    name == "RequiredEdges" || name == "RequiredTriangles";
}

/// Everything up to the next keyword.
void skipSection(TextCursor& cursor)
{
  while (cursor.skipToToken() && !std::isalpha(static_cast<unsigned char>(*cursor.place())))
  {
    cursor.word();
  }
}

void readSections(TextCursor& cursor, Contents& contents)
{
  while (cursor.skipToToken())
  {
    const char* place = cursor.place();
    const std::string word(cursor.word());
    const MeditSection* section = findCells(word);
    if (word == "End")
    {
      return;
    }
    if (word == "Dimension")
    {
      contents.dimension = static_cast<int>(nextInteger(cursor, "dimension", 2, 3));
    }
    else if (word == "Vertices")
    {
      readVertices(cursor, contents);
    }
    else if (section)
    {
      readCells(cursor, *section, contents);
    }
    else if (isList(word))
    {
      readList(cursor, word, contents);
    }
    else if (!word.empty() && std::isalpha(static_cast<unsigned char>(word[0])))
    {
      skipSection(cursor);
    }
    else
    {
      cursor.failAt(place,
        "expected the name of a section, found '" + word.substr(0, 20) +
          "' (is the count of the section before it right?)");
    }
  }
  cursor.fail("the file ends without the keyword End");
}

/// A 0/1 array from a list of ids, or the one given if it has a name.
MeshArray flags(const TextCursor& cursor, const char* name, const std::vector<Index>& ids,
  std::size_t begin, std::size_t count, MeshArray array)
{
  if (array.name.empty())
  {
    array = MeshArray::make(name, 1, 'u', count);
  }
  auto& values = std::get<MeshArray::Bytes>(array.values);
  for (const Index id : ids)
  {
    if (begin + static_cast<std::size_t>(id) >= values.size())
    {
      cursor.fail(std::string(name) + ": number " + std::to_string(id + 1) + " is out of range");
    }
    values[begin + static_cast<std::size_t>(id)] = 1;
  }
  return array;
}

/// @param empty whether arrays without a value are kept, as a rank's share may have none
MeshFile assemble(const TextCursor& cursor, Contents contents, bool empty)
{
  MeshFile mesh;
  mesh.points = std::move(contents.coordinates);
  const auto points = contents.pointReferences.size();
  mesh.pointArrays.push_back({ "Reference", 1, std::move(contents.pointReferences) });
  MeshArray fixed, corner, ridge, required;
  if (contents.lists.count("Corners"))
  {
    corner = flags(cursor, "Corner", contents.lists["Corners"], 0, points, {});
    fixed = flags(cursor, "Fixed", contents.lists["Corners"], 0, points, {});
  }
  if (contents.lists.count("RequiredVertices"))
  {
    fixed = flags(cursor, "Fixed", contents.lists["RequiredVertices"], 0, points, fixed);
  }
  std::vector<Index> references;
  std::map<unsigned char, std::size_t> begins;
  for (const MeditSection& section : MeditSections)
  {
    begins[section.type] = mesh.cellTypes.size();
    mesh.addCells(section.type, std::move(contents.nodes[section.type]));
    const std::vector<Index>& more = contents.references[section.type];
    references.insert(references.end(), more.begin(), more.end());
  }
  const std::size_t cells = references.size();
  mesh.cellArrays.push_back({ "Reference", 1, std::move(references) });
  if (contents.lists.count("Ridges"))
  {
    ridge = flags(cursor, "Ridge", contents.lists["Ridges"], begins[FileLine], cells, {});
  }
  if (contents.lists.count("RequiredEdges"))
  {
    required =
      flags(cursor, "Required", contents.lists["RequiredEdges"], begins[FileLine], cells, {});
  }
  if (contents.lists.count("RequiredTriangles"))
  {
    required = flags(cursor, "Required", contents.lists["RequiredTriangles"], begins[FileTriangle],
      cells, required);
  }
  for (MeshArray* array : { &fixed, &corner, &ridge, &required })
  {
    if (array->size() > 0 || (empty && !array->name.empty()))
    {
      const bool onPoints = array == &fixed || array == &corner;
      (onPoints ? mesh.pointArrays : mesh.cellArrays).push_back(std::move(*array));
    }
  }
  return mesh;
}

void readHeader(TextCursor& cursor)
{
  const std::string first = nextWord(cursor, "MeshVersionFormatted");
  if (first == "MFEM")
  {
    cursor.fail(
      "this is a mesh of MFEM, which has the same ending as those of Medit: save it as .vtu "
      "(Mesh::PrintVTU), or with mesh-explorer as .vtk");
  }
  if (first != "MeshVersionFormatted")
  {
    cursor.fail("expected MeshVersionFormatted: this is no ASCII file of Medit");
  }
  nextInteger(cursor, "version", 0, 4); // 0: bamg
}

/// One field of a .sol section.
struct Field
{
  Index type; ///< 1 scalar, 2 vector, 3 symmetric tensor
  int values(int dimension) const
  {
    return type == 1 ? 1 : type == 2 ? dimension : dimension * (dimension + 1) / 2;
  }
};

/// The arrays of a section's fields: named in a comment that Tautline wrote, or Solution1, ...
struct SolutionArrays
{
  std::vector<MeshArray> arrays;
  std::vector<std::pair<std::size_t, int>> places; ///< array and component of each field
};

SolutionArrays solutionArrays(
  const FileContent& file, const std::vector<Field>& fields, const char* title, std::size_t tuples)
{
  SolutionArrays result;
  std::size_t field = 0;
  const auto components = [](const Field& f) { return f.type == 1 ? 1 : f.type == 2 ? 3 : 9; };
  for (const ColumnName& column : readColumnNames(file, title))
  {
    for (int c = 0; c < column.components && field < fields.size();)
    {
      result.places.push_back({ result.arrays.size(), c });
      c += components(fields[field++]);
    }
    result.arrays.push_back(MeshArray::make(column.name, column.components, column.code, 0));
  }
  int used = 0;
  for (const Field& f : fields)
  {
    used += components(f);
  }
  for (const MeshArray& array : result.arrays)
  {
    used -= array.components;
  }
  if (used != 0 || result.places.size() != fields.size())
  {
    result = SolutionArrays();
    for (std::size_t i = 0; i < fields.size(); ++i)
    {
      result.places.push_back({ i, 0 });
      result.arrays.push_back(
        MeshArray::make("Solution" + std::to_string(i + 1), components(fields[i]), 'f', 0));
    }
  }
  for (MeshArray& array : result.arrays)
  {
    array.resize(tuples * static_cast<std::size_t>(array.components));
  }
  return result;
}

void readField(
  TextCursor& cursor, const Field& field, int dimension, MeshArray& array, std::size_t to)
{
  double values[6] = {};
  for (int i = 0; i < field.values(dimension); ++i)
  {
    cursor.skipToToken();
    values[i] = cursor.real("value of a solution");
  }
  if (field.type != 3)
  {
    for (int i = 0; i < field.values(dimension); ++i)
    {
      setValue(array, to + static_cast<std::size_t>(i), values[i]);
    }
    return;
  }
  for (int row = 0, i = 0; row < dimension; ++row)
  {
    for (int column = 0; column <= row; ++column, ++i)
    {
      setValue(array, to + static_cast<std::size_t>(3 * row + column), values[i]);
      setValue(array, to + static_cast<std::size_t>(3 * column + row), values[i]);
    }
  }
}

std::vector<Field> readFields(TextCursor& cursor)
{
  std::vector<Field> fields(
    static_cast<std::size_t>(nextInteger(cursor, "number of fields", 0, 1000)));
  for (Field& field : fields)
  {
    field.type = nextInteger(cursor, "type of a field", 1, 3);
  }
  return fields;
}

/// Takes the arrays that another section has begun out of `to`.
void continueArrays(SolutionArrays& result, std::vector<MeshArray>& to)
{
  for (MeshArray& array : result.arrays)
  {
    const auto same = std::find_if(to.begin(), to.end(),
      [&](const MeshArray& other)
      {
        return other.name == array.name && other.size() == array.size() &&
          other.code() == array.code();
      });
    if (same != to.end())
    {
      array = std::move(*same);
      to.erase(same);
    }
  }
}

/// As many values, for the tuples from `begin` on.
void readSolutionRecords(TextCursor& cursor, const std::vector<Field>& fields, int dimension,
  std::size_t begin, Index count, SolutionArrays& to)
{
  for (Index i = 0; i < count; ++i)
  {
    for (std::size_t f = 0; f < fields.size(); ++f)
    {
      MeshArray& array = to.arrays[to.places[f].first];
      const std::size_t tuple = begin + static_cast<std::size_t>(i);
      readField(cursor, fields[f], dimension, array,
        tuple * static_cast<std::size_t>(array.components) +
          static_cast<std::size_t>(to.places[f].second));
    }
  }
}

/// The comment in which Tautline leaves the names of arrays.
const char* arrayTitle(bool points)
{
  return points ? "Tautline point arrays:" : "Tautline cell arrays:";
}

/// A section SolAt...: values for `count` tuples from `begin` on, in arrays of `tuples` tuples.
void readSolutionSection(TextCursor& cursor, const FileContent& file, const std::string& section,
  int dimension, Index count, std::size_t begin, std::size_t tuples, std::vector<MeshArray>& to)
{
  const char* place = cursor.place();
  const Index values = sectionSize(cursor, "values of " + section, 1);
  const std::vector<Field> fields = readFields(cursor);
  if (values != count)
  {
    cursor.failAt(place,
      section + " has " + std::to_string(values) + " values, the mesh has " +
        std::to_string(count) + " of these");
  }
  SolutionArrays result =
    solutionArrays(file, fields, arrayTitle(section == "SolAtVertices"), tuples);
  continueArrays(result, to);
  readSolutionRecords(cursor, fields, dimension, begin, count, result);
  std::move(result.arrays.begin(), result.arrays.end(), std::back_inserter(to));
}

/// The section of cells whose values a section of a .sol has, or null.
const MeditSection* findSolution(const std::string& name)
{
  constexpr std::string_view prefix = "SolAt";
  return name.compare(0, prefix.size(), prefix) == 0 ? findCells(name.substr(prefix.size()))
                                                     : nullptr;
}
}

//------------------------------------------------------------------------------
void readMeditSolution(const FileContent& file, MeshFile& mesh)
{
  TextCursor cursor(file, Comment);
  readHeader(cursor);
  int dimension = 0;
  std::vector<MeshArray> pointArrays, cellArrays;
  std::string word = nextWord(cursor, "Dimension");
  for (; word != "End"; word = nextWord(cursor, "the keyword End"))
  {
    if (word == "Dimension")
    {
      dimension = static_cast<int>(nextInteger(cursor, "dimension", 2, 3));
      continue;
    }
    if (dimension == 0)
    {
      cursor.fail("expected Dimension, found '" + word.substr(0, 20) + "'");
    }
    const MeditSection* section = findSolution(word);
    if (word == "SolAtVertices")
    {
      readSolutionSection(cursor, file, word, dimension, mesh.numberOfPoints(), 0,
        static_cast<std::size_t>(mesh.numberOfPoints()), pointArrays);
    }
    else if (section)
    {
      const auto [first, last] =
        std::pair(std::find(mesh.cellTypes.begin(), mesh.cellTypes.end(), section->type),
          std::find(mesh.cellTypes.rbegin(), mesh.cellTypes.rend(), section->type).base());
      const Index count = last > first ? last - first : 0;
      readSolutionSection(cursor, file, word, dimension, count,
        static_cast<std::size_t>(first - mesh.cellTypes.begin()), mesh.cellTypes.size(),
        cellArrays);
    }
    else if (std::isalpha(static_cast<unsigned char>(word[0])))
    {
      skipSection(cursor);
    }
    else
    {
      cursor.fail("expected the name of a section, found '" + word.substr(0, 20) + "'");
    }
  }
  std::move(pointArrays.begin(), pointArrays.end(), std::back_inserter(mesh.pointArrays));
  std::move(cellArrays.begin(), cellArrays.end(), std::back_inserter(mesh.cellArrays));
}

namespace
{
/// Whether an array marks ridges or required cells and there are none.
bool isUnused(const MeshArray& array)
{
  const auto* flags = std::get_if<MeshArray::Bytes>(&array.values);
  return (array.name == "Ridge" || array.name == "Required") && flags &&
    std::find(flags->begin(), flags->end(), 1) == flags->end();
}
}

//------------------------------------------------------------------------------
MeshFile readMedit(const std::string& name, bool lowerCells)
{
  const auto [stem, extension] = splitExtension(name);
  const bool solution = extension == "sol";
  const std::string meshName = solution ? stem + ".mesh" : name;
  const FileContent file(meshName, solution ? "the mesh of " + name : std::string());
  SetCheck set;
  set.add(file);
  TextCursor cursor(file, Comment);
  readHeader(cursor);
  Contents contents;
  readSections(cursor, contents);
  MeshFile mesh = assemble(cursor, std::move(contents), false);
  const std::string solutionName = stem + ".sol";
  if (solution || fileExists(solutionName))
  {
    readMeditSolution(set.add(FileContent(solutionName)), mesh);
  }
  if (!lowerCells)
  {
    mesh.keepHighestDimension();
  }
  mesh.cellArrays.erase(std::remove_if(mesh.cellArrays.begin(), mesh.cellArrays.end(), isUnused),
    mesh.cellArrays.end());
  return mesh;
}

namespace
{
/// A section of a file as the ranks find it: its keyword, what comes before its records, and where
/// these are.
struct SharedSection
{
  std::string name;
  Index count = 0; ///< of records
  std::vector<Field> fields;
  int dimension = 0; ///< of the section Dimension
  bool known = true;
  Index begin = 0, end = 0;
};

/// Reads what comes before the records of a section, which is `first` in its file or not.
SharedSection readSectionHead(const FileContent& text, bool first, bool solution)
{
  TextCursor cursor(text, Comment);
  SharedSection section;
  if (first)
  {
    readHeader(cursor);
  }
  else
  {
    section.name = std::string(cursor.word());
    const bool field = section.name == "SolAtVertices" || findSolution(section.name);
    const bool records =
      section.name == "Vertices" || findCells(section.name) || isList(section.name);
    if (section.name == "Dimension")
    {
      section.dimension = static_cast<int>(nextInteger(cursor, "dimension", 2, 3));
    }
    else if (solution ? field : records)
    {
      section.count = nextInteger(cursor, "number of records", 0, Largest);
    }
    else
    {
      section.known = false;
    }
    if (solution && field)
    {
      section.fields = readFields(cursor);
    }
  }
  section.begin = cursor.place() - text.begin();
  if (section.known)
  {
    cursor.expectLineEnd();
  }
  return section;
}

/// The sections of a file up to End; Dimension comes first, and none twice.
std::vector<SharedSection> findSections(
  const FileRanges& ranges, const std::string& name, bool solution)
{
  const std::vector<Index> starts = ranges.lineStarts(
    name, [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; });
  std::vector<SharedSection> sections = ranges.agreed(
    [&]
    {
      std::vector<SharedSection> found;
      for (std::size_t i = 0; i + 1 < starts.size(); ++i)
      {
        found.push_back(
          readSectionHead(firstLines(name, starts[i], starts[i + 1]), i == 0, solution));
        found.back().begin += starts[i];
        found.back().end = starts[i + 1];
        const FileContent next = firstLines(name, starts[i + 1], fileSize(name));
        if (TextCursor(next, Comment).word() == "End")
        {
          return found;
        }
      }
      throw FileError(name + ": no keyword End");
    });
  int dimensions = 0;
  bool inOrder = true;
  for (const SharedSection& section : sections)
  {
    dimensions += section.dimension > 0;
    inOrder = inOrder && (dimensions == 1 || section.name.empty());
    const auto same = [&](const SharedSection& other)
    { return section.known && other.name == section.name; };
    inOrder = inOrder && std::count_if(sections.begin(), sections.end(), same) <= 1;
  }
  ranges.require(inOrder && dimensions == 1);
  return sections;
}

/// Sections that are skipped end at the next keyword, in whatever line.
void skipShared(const FileRanges& ranges, const std::string& name, const SharedSection& section)
{
  const LineShare lines = ranges.lines(name, section.begin, section.end, Comment);
  ranges.together(
    [&]
    {
      TextCursor cursor(lines.text, Comment);
      skipSection(cursor);
      if (!cursor.atEnd())
      {
        cursor.fail("a keyword inside of a line");
      }
    });
}

/// Calls read(cursor, count) for a rank's records of a section.
template <class Read>
void shareRecords(
  const FileRanges& ranges, const std::string& name, const SharedSection& section, const Read& read)
{
  const LineShare lines = ranges.lines(name, section.begin, section.end, Comment, section.count);
  ranges.together(
    [&]
    {
      TextCursor cursor(lines.text, Comment);
      read(cursor, lines.count);
      cursor.expectFileEnd("record");
    });
}

/// A list may have several numbers in a line.
void shareList(const FileRanges& ranges, const std::string& name, const SharedSection& section,
  std::vector<Index>& ids)
{
  const LineShare lines = ranges.lines(name, section.begin, section.end, Comment);
  ranges.together(
    [&]
    {
      TextCursor cursor(lines.text, Comment);
      while (cursor.skipToToken())
      {
        ids.push_back(readListRecord(cursor, section.name));
        cursor.countRecord();
      }
    });
  ranges.require(ranges.group().sum(static_cast<Index>(ids.size())) == section.count);
}

/// Sends numbers of points or cells to the ranks that have these.
/// @param rankAndPlace the rank of a number, and which of its points or cells it is
template <class RankAndPlace>
std::vector<Index> sendNumbers(
  RankGroup& group, const std::vector<Index>& numbers, const RankAndPlace& rankAndPlace)
{
  std::vector<std::vector<Index>> sent(static_cast<std::size_t>(group.size()));
  for (const Index number : numbers)
  {
    const auto [rank, place] = rankAndPlace(number);
    sent[static_cast<std::size_t>(rank)].push_back(place);
  }
  std::vector<Index> own;
  for (const std::vector<Index>& some : group.exchangeItems(sent))
  {
    own.insert(own.end(), some.begin(), some.end());
  }
  return own;
}

/// Which ranks have the cells: numbers begin at 0 for each section.
using SectionBegins = std::map<unsigned char, std::vector<Index>>;

/// The numbers of the lists become those that a rank's cells and points have in its share.
void shareLists(const FileRanges& ranges, const std::vector<Index>& pointBegins,
  const SectionBegins& cellBegins, Contents& contents)
{
  RankGroup& group = ranges.group();
  for (auto& [name, numbers] : contents.lists)
  {
    const bool points = name == "Corners" || name == "RequiredVertices";
    const std::vector<Index>& begins =
      points ? pointBegins : cellBegins.at(name == "RequiredTriangles" ? FileTriangle : FileLine);
    ranges.require(std::all_of(
      numbers.begin(), numbers.end(), [&](Index number) { return number < begins.back(); }));
    numbers = sendNumbers(group, numbers,
      [&](Index number)
      {
        const int rank = rankOf(begins, number);
        return std::pair(rank, number - begins[static_cast<std::size_t>(rank)]);
      });
  }
}

/// The fields of a .sol file, for the own points and cells.
void shareSolution(const FileRanges& ranges, const std::string& name,
  const std::vector<Index>& pointBegins, const SectionBegins& cellBegins, MeshFile& mesh)
{
  const FileContent head = ranges.head(name);
  int dimension = 0;
  std::vector<MeshArray> pointArrays, cellArrays;
  RankGroup& group = ranges.group();
  for (const SharedSection& section : findSections(ranges, name, true))
  {
    dimension = std::max(dimension, section.dimension);
    if (!section.known)
    {
      skipShared(ranges, name, section);
      continue;
    }
    const bool points = section.name == "SolAtVertices";
    const MeditSection* cells = findSolution(section.name);
    if (!points && !cells)
    {
      shareRecords(ranges, name, section, [](TextCursor&, Index) {});
      continue;
    }
    const std::vector<Index>& begins = points ? pointBegins : cellBegins.at(cells->type);
    ranges.require(section.count == begins.back());
    SolutionArrays read, result;
    const auto arrays = [&](std::size_t tuples)
    { return solutionArrays(head, section.fields, arrayTitle(points), tuples); };
    shareRecords(ranges, name, section,
      [&](TextCursor& cursor, Index count)
      {
        read = arrays(static_cast<std::size_t>(count));
        readSolutionRecords(cursor, section.fields, dimension, 0, count, read);
        result = arrays(points ? mesh.points.size() / 3 : mesh.cellTypes.size());
      });
    // from the ranks that have read them to those with the points or cells
    const Index count = read.arrays.empty()
      ? 0
      : static_cast<Index>(read.arrays[0].size()) / read.arrays[0].components;
    const RankRows rows = realignedRows(group, rankBegins(group, count), begins);
    std::vector<MeshArray>& to = points ? pointArrays : cellArrays;
    continueArrays(result, to);
    const std::size_t first = points
      ? 0
      : static_cast<std::size_t>(
          std::find(mesh.cellTypes.begin(), mesh.cellTypes.end(), cells->type) -
          mesh.cellTypes.begin());
    for (std::size_t i = 0; i < read.arrays.size(); ++i)
    {
      const MeshArray values = sendTuples(group, read.arrays[i], rows);
      std::visit(
        [&](const auto& from)
        {
          using Values = std::decay_t<decltype(from)>;
          auto& all = std::get<Values>(result.arrays[i].values);
          std::copy(from.begin(), from.end(),
            all.begin() + static_cast<std::ptrdiff_t>(first) * values.components);
        },
        values.values);
    }
    std::move(result.arrays.begin(), result.arrays.end(), std::back_inserter(to));
  }
  std::move(pointArrays.begin(), pointArrays.end(), std::back_inserter(mesh.pointArrays));
  std::move(cellArrays.begin(), cellArrays.end(), std::back_inserter(mesh.cellArrays));
}
}

//------------------------------------------------------------------------------
MeshShare shareMedit(const FileRanges& ranges, const std::string& name, bool lowerCells)
{
  const auto [stem, extension] = splitExtension(name);
  const std::string meshName = extension == "sol" ? stem + ".mesh" : name;
  const std::string solutionName = stem + ".sol";
  ranges.expectLarge({ meshName });
  const bool solution = ranges.exists(solutionName);
  ranges.require(solution || extension != "sol");
  SetCheck set;
  const FileContent tail = ranges.tail(meshName);
  ranges.together([&] { set.add(tail); });

  Contents contents;
  RankGroup& group = ranges.group();
  std::vector<Index> pointBegins;
  SectionBegins cellBegins;
  for (const SharedSection& section : findSections(ranges, meshName, false))
  {
    contents.dimension = std::max(contents.dimension, section.dimension);
    const MeditSection* cells = findCells(section.name);
    if (!section.known)
    {
      skipShared(ranges, meshName, section);
      continue;
    }
    if (isList(section.name))
    {
      shareList(ranges, meshName, section, contents.lists[section.name]);
      continue;
    }
    ranges.require(!cells || contents.points >= 0);
    shareRecords(ranges, meshName, section,
      [&](TextCursor& cursor, Index count)
      {
        if (section.name == "Vertices")
        {
          contents.points = section.count;
          readVertexRecords(cursor, count, contents);
        }
        else if (cells)
        {
          readCellRecords(cursor, *cells, static_cast<std::size_t>(count), contents);
        }
      });
  }
  MeshShare share;
  Index cells = 0;
  for (const MeditSection& section : MeditSections)
  {
    const auto own = static_cast<Index>(contents.references[section.type].size());
    share.sectionCells.push_back(own);
    cellBegins[section.type] = rankBegins(group, own);
    cells += cellBegins[section.type].back();
  }
  ranges.require(contents.points > 0 && cells > 0);
  pointBegins = rankBegins(group, static_cast<Index>(contents.pointReferences.size()));
  shareLists(ranges, pointBegins, cellBegins, contents);
  share.mesh = ranges.agreed([&] { return assemble(TextCursor(tail), std::move(contents), true); });
  if (solution)
  {
    const FileContent solutionTail = ranges.tail(solutionName);
    ranges.together([&] { set.add(solutionTail); });
    shareSolution(ranges, solutionName, pointBegins, cellBegins, share.mesh);
  }
  if (!lowerCells)
  {
    keepHighestDimension(group, share);
  }
  std::vector<MeshArray>& arrays = share.mesh.cellArrays;
  for (auto array = arrays.begin(); array != arrays.end();)
  {
    array = group.any(!isUnused(*array)) ? array + 1 : arrays.erase(array);
  }
  return share;
}
}
