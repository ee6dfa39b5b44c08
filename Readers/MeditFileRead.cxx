// SPDX-License-Identifier: BSD-3-Clause
#include "MeditFile.h"

#include "FileNames.h"
#include "FileSet.h"
#include "MeditRecords.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>

namespace tautline
{
using namespace medit;

namespace medit
{
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

void continueArrays(SolutionArrays& result, std::vector<MeshArray>& to)
{
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
      array = std::move(*same);
      to.erase(same);
    }
  }
}

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

namespace medit
{
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
}
