// SPDX-License-Identifier: BSD-3-Clause
#include "MeditContents.h"

#include "FileNames.h"
#include "FileSet.h"
#include "TextCursor.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace tautline
{
namespace
{
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

void readVertices(TextCursor& cursor, MeditContents& contents)
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
  resizeLarge(contents.coordinates, static_cast<std::size_t>(3 * contents.points));
  contents.pointReferences.resize(static_cast<std::size_t>(contents.points));
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

void readCells(TextCursor& cursor, const MeditSection& section, MeditContents& contents)
{
  if (contents.points < 0)
  {
    cursor.fail(std::string(section.name) + " come before Vertices");
  }
  const auto size = static_cast<std::size_t>(cellNodes(section.type));
  const auto count = static_cast<std::size_t>(sectionSize(cursor, section.name, size + 1));
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
    if (section.type == FileWedge)
    {
      turnMeditWedge(nodes, node);
    }
    cursor.skipToToken();
    references[reference++] = cursor.integer("reference");
    cursor.countRecord();
  }
}

/// Corners, RequiredVertices, Ridges, RequiredEdges, RequiredTriangles: lists of numbers.
void readList(TextCursor& cursor, const std::string& section, MeditContents& contents)
{
  std::vector<Index>& ids = contents.lists[section];
  for (Index count = sectionSize(cursor, section, 1); count > 0; --count)
  {
    cursor.skipToToken();
    ids.push_back(cursor.integer(section.c_str(), 1, std::numeric_limits<Index>::max()) - 1);
  }
}

/**
 * Skips everything up to the next keyword. At the end of the file, the skipped text must be a count
 * and as many records of equal length.
 */
void skipSection(TextCursor& cursor, const std::string& section, std::vector<std::string>& warnings)
{
  const char* start = cursor.place();
  Index count = -1, words = 0;
  for (; cursor.skipToToken() && !std::isalpha(static_cast<unsigned char>(*cursor.place()));
       ++words)
  {
    const std::string_view word = cursor.word();
    const char* end = word.data() + word.size();
    if (words == 0 && std::from_chars(word.data(), end, count).ptr != end)
    {
      count = -1; // no count: a real number, a name
    }
  }
  if (count > 0 && isMeditCellSection(section))
  {
    warnings.push_back(std::to_string(count) + " cells of the section " + section +
      ", which are curved, polygons or polyhedra, are left out");
  }
  const Index values = words - 1;
  const bool complete =
    words > 0 && (count > 0 ? values >= count && values % count == 0 : values == 0 || count < 0);
  if (cursor.atEnd() && !complete)
  {
    cursor.failAt(start, "the file ends within the section " + section);
  }
}

/// At the end of a file without the keyword End, which must have cells.
void warnOfMissingEnd(
  const char* what, const TextCursor& cursor, bool complete, std::vector<std::string>& warnings)
{
  if (!complete)
  {
    cursor.fail("the file ends without the keyword End: it is truncated");
  }
  const bool cut = !std::isspace(static_cast<unsigned char>(cursor.place()[-1]));
  warnings.push_back(meditWithoutEnd(what) + (cut ? ", and its last number may be cut off" : ""));
}

void readSections(TextCursor& cursor, MeditContents& contents)
{
  while (cursor.skipToToken())
  {
    const char* place = cursor.place();
    const std::string word(cursor.word());
    const auto* section = std::find_if(std::begin(MeditSections), std::end(MeditSections),
      [&](const MeditSection& s)
      { return word == s.name || (word == "Hexaedra" && s.type == FileHexahedron); });
    const bool list = std::any_of(std::begin(MeditLists), std::end(MeditLists),
      [&](const MeditList& each) { return word == each.name; });
    if (word == "End")
    {
      return;
    }
    if (word == "Dimension")
    {
      contents.dimension = static_cast<int>(cursor.nextInteger("dimension", 2, 3));
    }
    else if (word == "Vertices")
    {
      readVertices(cursor, contents);
    }
    else if (section != std::end(MeditSections))
    {
      readCells(cursor, *section, contents);
    }
    else if (list)
    {
      readList(cursor, word, contents);
    }
    else if (!word.empty() && std::isalpha(static_cast<unsigned char>(word[0])))
    {
      skipSection(cursor, word, contents.warnings);
    }
    else
    {
      cursor.failAt(place,
        "expected the name of a section, found '" + word.substr(0, 20) +
          "' (is the count of the previous section right?)");
    }
  }
  warnOfMissingEnd("the file", cursor, contents.hasCells(), contents.warnings);
}

/// A 0/1 array from a list of ids.
MeshArray flags(const FileContent& file, const char* name, const std::vector<Index>& ids,
  std::size_t begin, std::size_t count, MeshArray array)
{
  if (array.size() == 0)
  {
    array = MeshArray::make(name, 1, 'u', count);
  }
  auto& values = std::get<MeshArray::Bytes>(array.values);
  for (const Index id : ids)
  {
    if (begin + static_cast<std::size_t>(id) >= values.size())
    {
      throw FileError(
        file.name() + ": " + name + ": number " + std::to_string(id + 1) + " is out of range");
    }
    values[begin + static_cast<std::size_t>(id)] = 1;
  }
  return array;
}

MeshFile assemble(const FileContent& file, MeditContents contents)
{
  MeshFile mesh;
  mesh.warnings = std::move(contents.warnings);
  mesh.points = std::move(contents.coordinates);
  const auto points = contents.pointReferences.size();
  mesh.pointArrays.push_back({ "Reference", 1, std::move(contents.pointReferences) });
  MeshArray fixed, corner, ridge, required;
  if (contents.lists.count("Corners"))
  {
    corner = flags(file, "Corner", contents.lists["Corners"], 0, points, {});
    fixed = flags(file, "Fixed", contents.lists["Corners"], 0, points, {});
  }
  if (contents.lists.count("RequiredVertices"))
  {
    fixed = flags(file, "Fixed", contents.lists["RequiredVertices"], 0, points, fixed);
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
    ridge = flags(file, "Ridge", contents.lists["Ridges"], begins[FileLine], cells, {});
  }
  if (contents.lists.count("RequiredEdges"))
  {
    required =
      flags(file, "Required", contents.lists["RequiredEdges"], begins[FileLine], cells, {});
  }
  if (contents.lists.count("RequiredTriangles"))
  {
    required = flags(
      file, "Required", contents.lists["RequiredTriangles"], begins[FileTriangle], cells, required);
  }
  for (MeshArray* array : { &fixed, &corner, &ridge, &required })
  {
    if (array->size() > 0)
    {
      const bool onPoints = array == &fixed || array == &corner;
      (onPoints ? mesh.pointArrays : mesh.cellArrays).push_back(std::move(*array));
    }
  }
  return mesh;
}

void readHeader(TextCursor& cursor)
{
  const std::string first = cursor.nextWord("MeshVersionFormatted");
  if (first == "MFEM")
  {
    cursor.fail("this is an MFEM mesh, which has the same extension: use vtkMfemReader");
  }
  if (first != "MeshVersionFormatted")
  {
    cursor.fail("expected MeshVersionFormatted: this is not an ASCII Medit file");
  }
  cursor.nextInteger("version", 0, 4); // 0: bamg
}

MeditContents readText(const FileContent& file)
{
  TextCursor cursor(file, '#');
  readHeader(cursor);
  MeditContents contents;
  readSections(cursor, contents);
  return contents;
}

/// A field of a .sol section.
struct Field
{
  Index type; ///< 1 scalar, 2 vector, 3 symmetric tensor
  int values(int dimension) const
  {
    return type == 1 ? 1 : type == 2 ? dimension : dimension * (dimension + 1) / 2;
  }
};

/// The arrays of a section's fields: named in a comment written by Tautline, or Solution1, ...
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
    static_cast<std::size_t>(cursor.nextInteger("number of fields", 0, 1000)));
  for (Field& field : fields)
  {
    field.type = cursor.nextInteger("type of a field", 1, 3);
  }
  return fields;
}

/// Reads a section SolAt...: values for `count` tuples starting at `begin`, in arrays of `tuples`
/// tuples.
void readSolutionSection(TextCursor& cursor, const FileContent& file, const std::string& section,
  int dimension, Index count, std::size_t begin, std::size_t tuples, std::vector<MeshArray>& to)
{
  const char* place = cursor.place();
  const Index values = sectionSize(cursor, "values of " + section, 1);
  const std::vector<Field> fields = readFields(cursor);
  if (values != count)
  {
    cursor.failAt(place,
      section + " has " + std::to_string(values) + " values; the mesh has " +
        std::to_string(count) + " of these");
  }
  const bool points = section == "SolAtVertices";
  SolutionArrays result = solutionArrays(
    file, fields, points ? "Tautline point arrays:" : "Tautline cell arrays:", tuples);
  for (MeshArray& array : result.arrays)
  {
    const auto same = std::find_if(to.begin(), to.end(),
      [&](const MeshArray& other)
      {
        return other.name == array.name && other.components == array.components &&
          other.code() == array.code();
      });
    if (same != to.end())
    {
      array = std::move(*same); // begun by another section
      to.erase(same);
    }
  }
  for (Index i = 0; i < count; ++i)
  {
    for (std::size_t f = 0; f < fields.size(); ++f)
    {
      MeshArray& array = result.arrays[result.places[f].first];
      const std::size_t tuple = begin + static_cast<std::size_t>(i);
      readField(cursor, fields[f], dimension, array,
        tuple * static_cast<std::size_t>(array.components) +
          static_cast<std::size_t>(result.places[f].second));
    }
  }
  std::move(result.arrays.begin(), result.arrays.end(), std::back_inserter(to));
}
}

//------------------------------------------------------------------------------
std::string meditWithoutEnd(const char* what)
{
  return std::string(what) +
    " ends without the keyword End: its sections are complete, but others may be missing";
}

//------------------------------------------------------------------------------
bool MeditContents::hasCells() const
{
  return std::any_of(this->references.begin(), this->references.end(),
    [](const auto& each) { return !each.second.empty(); });
}

//------------------------------------------------------------------------------
void turnMeditWedge(std::vector<Index>& nodes, std::size_t end)
{
  std::swap(nodes[end - 5], nodes[end - 4]);
  std::swap(nodes[end - 2], nodes[end - 1]);
}

//------------------------------------------------------------------------------
bool isMeditCellSection(const std::string& section)
{
  if (section == "Polygons" || section == "Polyhedra")
  {
    return true;
  }
  const std::size_t at = section.size() < 2 ? 0 : section.size() - 2; // TrianglesP2, HexahedraQ3
  return at > 0 && (section[at] == 'P' || section[at] == 'Q') && section[at + 1] >= '2' &&
    section[at + 1] <= '4' && section.find("At") == section.npos;
}

//------------------------------------------------------------------------------
void readMeditSolution(const FileContent& file, MeshFile& mesh)
{
  TextCursor cursor(file, '#');
  readHeader(cursor);
  int dimension = 0;
  std::vector<MeshArray> pointArrays, cellArrays;
  for (;;)
  {
    if (!cursor.skipToToken())
    {
      warnOfMissingEnd(
        "its .sol", cursor, !pointArrays.empty() || !cellArrays.empty(), mesh.warnings);
      break;
    }
    const std::string word(cursor.word());
    if (word == "End")
    {
      break;
    }
    if (word == "Dimension")
    {
      dimension = static_cast<int>(cursor.nextInteger("dimension", 2, 3));
      continue;
    }
    if (dimension == 0)
    {
      cursor.fail("expected Dimension, found '" + word.substr(0, 20) + "'");
    }
    const auto* section = std::find_if(std::begin(MeditSections), std::end(MeditSections),
      [&](const MeditSection& s) { return word == std::string("SolAt") + s.name; });
    if (word == "SolAtVertices")
    {
      readSolutionSection(cursor, file, word, dimension, mesh.numberOfPoints(), 0,
        static_cast<std::size_t>(mesh.numberOfPoints()), pointArrays);
    }
    else if (section != std::end(MeditSections))
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
      skipSection(cursor, word, mesh.warnings);
    }
    else
    {
      cursor.fail("expected the name of a section, found '" + word.substr(0, 20) + "'");
    }
  }
  std::move(pointArrays.begin(), pointArrays.end(), std::back_inserter(mesh.pointArrays));
  std::move(cellArrays.begin(), cellArrays.end(), std::back_inserter(mesh.cellArrays));
}

//------------------------------------------------------------------------------
MeshFile readMedit(const std::string& name, bool lowerCells)
{
  const auto [stem, extension] = splitExtension(name);
  const bool solution = extension == "sol";
  const std::string text = stem + ".mesh", binary = stem + ".meshb";
  const bool isBinary = solution ? !fileExists(text) && fileExists(binary) : extension == "meshb";
  const std::string meshName = !solution ? name : isBinary ? binary : text;
  const FileContent file(meshName, solution ? "the mesh of " + name : std::string());
  SetCheck set;
  set.add(file);
  MeshFile mesh = assemble(file, isBinary ? readMeditBinary(file) : readText(file));
  const std::string solutionName = stem + ".sol";
  if (solution || (fileExists(solutionName) && (!isBinary || !fileExists(text))))
  {
    readMeditSolution(set.add(FileContent(solutionName)), mesh);
  }
  if (!lowerCells)
  {
    mesh.keepHighestDimension();
  }
  const auto unused = [](const MeshArray& array)
  {
    const auto* flags = std::get_if<MeshArray::Bytes>(&array.values);
    return (array.name == "Ridge" || array.name == "Required") && flags &&
      std::find(flags->begin(), flags->end(), 1) == flags->end();
  };
  mesh.cellArrays.erase(
    std::remove_if(mesh.cellArrays.begin(), mesh.cellArrays.end(), unused), mesh.cellArrays.end());
  return mesh;
}
}
