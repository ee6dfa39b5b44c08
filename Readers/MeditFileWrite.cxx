// SPDX-License-Identifier: BSD-3-Clause
#include "MeditFile.h"

#include "FileNames.h"
#include "FileSet.h"
#include "TextCursor.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>

namespace tautline
{
namespace
{
constexpr const char* Own[] = { "Reference", "BoundaryMarker", "Fixed", "Corner", "Ridge",
  "Required" };

bool whole(const MeshArray* array)
{
  return array && array->components == 1 && array->code() != 'f';
}

/// Whether the .mesh itself holds the array.
bool inMesh(const MeshArray& array)
{
  return whole(&array) &&
    std::any_of(
      std::begin(Own), std::end(Own), [&](const char* name) { return array.name == name; });
}

/// The cells of each section, in order.
using Sections = std::array<std::vector<Index>, std::size(MeditSections)>;

Sections sortCells(const MeshFile& mesh, const std::string& name)
{
  Sections sections;
  Index wrong = 0, first = 0;
  for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
  {
    const unsigned char type = mesh.cellTypes[static_cast<std::size_t>(cell)];
    const auto* found = std::find_if(std::begin(MeditSections), std::end(MeditSections),
      [type](const MeditSection& s) { return s.type == type; });
    if (found == std::end(MeditSections))
    {
      first = wrong++ ? first : cell;
      continue;
    }
    sections[static_cast<std::size_t>(found - MeditSections)].push_back(cell);
  }
  if (wrong > 0)
  {
    throw FileError(name + ": Medit files cannot hold " + std::to_string(wrong) +
      " cells, such as " + cellPlural(mesh.cellTypes[static_cast<std::size_t>(first)]) + " (cell " +
      std::to_string(first) + "); write Gmsh's .msh, or run Triangulate or Tetrahedralize first");
  }
  return sections;
}

const MeshArray* pointReference(const MeshFile& mesh)
{
  const MeshArray* reference = findArray(mesh.pointArrays, "Reference");
  reference = whole(reference) ? reference : findArray(mesh.pointArrays, "BoundaryMarker");
  return whole(reference) ? reference : nullptr;
}

/// The sections of a .mesh or .meshb.
class MeditOutput
{
public:
  /// version: of a binary file; 0: text.
  MeditOutput(TextOutput& out, std::int32_t version, int dimension)
    : Out(out)
    , Version(version)
  {
    if (!version)
    {
      out << "MeshVersionFormatted 2\nDimension " << dimension << '\n';
      return;
    }
    this->word(1);
    this->word(version);
    this->header(MeditDimension, sizeof(std::int32_t));
    this->word(dimension);
  }
  /// Begins a section of records with this many real and whole numbers each.
  void section(const char* name, int code, Index count, std::size_t reals, std::size_t integers)
  {
    if (!this->Version)
    {
      this->Out << '\n' << name << '\n' << count;
      this->Out.endLine();
      return;
    }
    const std::size_t record = reals * sizeof(double) + integers * this->integerSize();
    this->header(code, this->integerSize() + static_cast<std::size_t>(count) * record);
    this->wide(count, this->integerSize());
  }
  /// Numbers within a record.
  void real(double value)
  {
    this->Version ? this->Out.binary(value) : void(this->Out << value << ' ');
  }
  void integer(Index value)
  {
    this->Version ? this->wide(value, this->integerSize()) : void(this->Out << value << ' ');
  }
  /// The last number of a record: value i of an array, 0 if there is no array.
  void last(const MeshArray* array, std::size_t i)
  {
    const auto* values = array ? std::get_if<MeshArray::Integers>(&array->values) : nullptr;
    this->last(values ? (*values)[i] : array ? static_cast<Index>(array->at(i)) : 0);
  }
  void last(Index value)
  {
    if (this->Version)
    {
      this->wide(value, this->integerSize());
      this->Out.endRecord();
      return;
    }
    this->Out << value;
    this->Out.endLine();
  }
  void end()
  {
    if (!this->Version)
    {
      this->Out << "\nEnd\n";
      return;
    }
    this->word(MeditEnd);
    this->wide(0, this->positionSize());
  }

private:
  std::size_t integerSize() const
  {
    return this->Version >= 4 ? sizeof(std::int64_t) : sizeof(std::int32_t);
  }
  std::size_t positionSize() const
  {
    return this->Version >= 3 ? sizeof(std::int64_t) : sizeof(std::int32_t);
  }
  void word(std::int32_t value) { this->Out.binary(value); }
  void wide(Index value, std::size_t bytes)
  {
    bytes == sizeof(std::int64_t) ? this->Out.binary(static_cast<std::int64_t>(value))
                                  : this->Out.binary(static_cast<std::int32_t>(value));
  }
  /// The code of a section and the position of the next one.
  void header(int code, std::size_t bytes)
  {
    constexpr std::size_t start = 2 * sizeof(std::int32_t);
    this->Place =
      (this->Place ? this->Place : start) + sizeof(std::int32_t) + this->positionSize() + bytes;
    this->word(code);
    this->wide(static_cast<Index>(this->Place), this->positionSize());
  }

  TextOutput& Out;
  std::int32_t Version;
  std::size_t Place = 0; ///< of the next section
};

void writeVertices(MeditOutput& out, const MeshFile& mesh, int dimension)
{
  const MeshArray* reference = pointReference(mesh);
  out.section(
    "Vertices", MeditVertices, mesh.numberOfPoints(), static_cast<std::size_t>(dimension), 1);
  for (std::size_t i = 0; i < static_cast<std::size_t>(mesh.numberOfPoints()); ++i)
  {
    for (int c = 0; c < dimension; ++c)
    {
      out.real(mesh.points[3 * i + static_cast<std::size_t>(c)]);
    }
    out.last(reference, i);
  }
}

/// Lower-dimensional cells have the marker of the boundary, if there is one.
const MeshArray* referenceOf(const MeshFile& mesh, unsigned char type, int dimension)
{
  const MeshArray* marker = findArray(mesh.cellArrays, "BoundaryMarker");
  const MeshArray* reference = findArray(mesh.cellArrays, "Reference");
  const bool lower = cellDimension(type) < dimension;
  const MeshArray* first = lower && whole(marker) ? marker : reference;
  const MeshArray* second = whole(first) ? first : marker;
  return whole(second) ? second : nullptr;
}

void writeSection(MeditOutput& out, const MeshFile& mesh, const MeditSection& section,
  const std::vector<Index>& cells)
{
  if (cells.empty())
  {
    return;
  }
  const MeshArray* reference = referenceOf(mesh, section.type, mesh.dimension());
  out.section(section.name, section.code, static_cast<Index>(cells.size()), 0,
    static_cast<std::size_t>(cellNodes(section.type)) + 1);
  for (const Index cell : cells)
  {
    const auto at = static_cast<std::size_t>(cell);
    constexpr Index WedgeOrder[] = { 0, 2, 1, 3, 5, 4 }; // see the reader
    const Index size = mesh.offsets[at + 1] - mesh.offsets[at];
    for (Index i = 0; i < size; ++i)
    {
      const Index node = mesh.offsets[at] + (section.type == FileWedge ? WedgeOrder[i] : i);
      out.integer(mesh.connectivity[static_cast<std::size_t>(node)] + 1);
    }
    out.last(reference, at);
  }
}

/// The numbers, from 1, of the nonzero entries.
void writeList(
  MeditOutput& out, const char* section, const MeshArray* flags, const std::vector<Index>& of)
{
  if (!flags || flags->components != 1)
  {
    return;
  }
  std::vector<Index> numbers;
  for (std::size_t i = 0; i < of.size(); ++i)
  {
    if (flags->at(static_cast<std::size_t>(of[i])) != 0.0)
    {
      numbers.push_back(static_cast<Index>(i) + 1);
    }
  }
  const auto* list = std::find_if(std::begin(MeditLists), std::end(MeditLists),
    [section](const MeditList& each) { return std::string(each.name) == section; });
  out.section(section, list->code, static_cast<Index>(numbers.size()), 0, 1);
  for (const Index number : numbers)
  {
    out.last(number);
  }
}

/// The oldest version of the binary format that can hold the mesh.
std::int32_t versionFor(const MeshFile& mesh)
{
  constexpr Index Most = std::numeric_limits<std::int32_t>::max();
  constexpr Index PointBytes = 48, CellBytes = 16, NodeBytes = 4, Headers = 1000; // with the lists
  bool wide = mesh.numberOfPoints() > Most || mesh.numberOfCells() > Most;
  for (const auto* arrays : { &mesh.pointArrays, &mesh.cellArrays })
  {
    for (const MeshArray& array : *arrays)
    {
      if (const auto* values = std::get_if<MeshArray::Integers>(&array.values))
      {
        wide = wide ||
          std::any_of(values->begin(), values->end(),
            [](Index value) { return value > Most || value < -Most - 1; });
      }
    }
  }
  const Index size = PointBytes * mesh.numberOfPoints() + CellBytes * mesh.numberOfCells() +
    NodeBytes * static_cast<Index>(mesh.connectivity.size()) + Headers;
  return wide ? 4 : size > Most ? 3 : 2;
}

bool symmetric(const MeshArray& array, int dimension)
{
  for (std::size_t i = 0; i < array.size(); i += 9)
  {
    const bool good = array.at(i + 1) == array.at(i + 3) && array.at(i + 2) == array.at(i + 6) &&
      array.at(i + 5) == array.at(i + 7) &&
      (dimension == 3 ||
        (array.at(i + 2) == 0.0 && array.at(i + 5) == 0.0 && array.at(i + 8) == 0.0));
    if (!good) // also for NaN
    {
      return false;
    }
  }
  return array.components == 9;
}

bool flat(const MeshArray& array)
{
  for (std::size_t i = 2; i < array.size(); i += 3)
  {
    if (array.at(i) != 0.0)
    {
      return false;
    }
  }
  return true;
}

/// 3 tensor, 2 vector, 1 component by component.
int fieldType(const MeshArray& array, int dimension)
{
  if (array.components == 9 && symmetric(array, dimension))
  {
    return 3;
  }
  return array.components == 3 && (dimension == 3 || flat(array)) ? 2 : 1;
}

struct Column
{
  const MeshArray* array;
  int type;
};

std::vector<Column> columnsOf(const std::vector<MeshArray>& arrays, int dimension)
{
  std::vector<Column> columns;
  for (const MeshArray& array : arrays)
  {
    if (!inMesh(array))
    {
      columns.push_back({ &array, fieldType(array, dimension) });
    }
  }
  return columns;
}

void writeNames(TextOutput& out, const char* title, const std::vector<Column>& columns)
{
  std::vector<ColumnName> names;
  for (const Column& column : columns)
  {
    names.push_back({ column.array->name, column.array->components, column.array->code() });
  }
  if (!names.empty())
  {
    out << writeColumnNames(title, names);
  }
}

void writeValues(TextOutput& out, const Column& column, std::size_t tuple, int dimension)
{
  const auto first = tuple * static_cast<std::size_t>(column.array->components);
  for (int c = 0; c < column.array->components; ++c)
  {
    const int row = c / 3, place = c % 3;
    const bool skipped =
      column.type == 3 ? (place > row || row >= dimension) : column.type == 2 && c >= dimension;
    if (!skipped)
    {
      out.value(*column.array, first + static_cast<std::size_t>(c));
      out << ' ';
    }
  }
}

void writeSolutionSection(TextOutput& out, const std::string& section,
  const std::vector<Column>& columns, const std::vector<Index>& tuples, int dimension)
{
  if (columns.empty() || tuples.empty())
  {
    return;
  }
  Index fields = 0;
  std::string types;
  for (const Column& column : columns)
  {
    const int count = column.type == 1 ? column.array->components : 1;
    fields += count;
    for (int i = 0; i < count; ++i)
    {
      types += " " + std::to_string(column.type);
    }
  }
  out << "\nSolAt" << section << '\n'
      << static_cast<Index>(tuples.size()) << '\n'
      << fields << types;
  out.endLine();
  for (const Index tuple : tuples)
  {
    for (const Column& column : columns)
    {
      writeValues(out, column, static_cast<std::size_t>(tuple), dimension);
    }
    out.endLine();
  }
}

std::vector<Index> numbersTo(Index count)
{
  std::vector<Index> all(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    all[i] = static_cast<Index>(i);
  }
  return all;
}

/// The file with the arrays, if there are any; see writeMedit.
std::optional<TextOutput> solutionFile(const MeshFile& mesh, const std::string& name)
{
  const int dimension = mesh.planar() ? 2 : 3;
  const auto points = columnsOf(mesh.pointArrays, dimension);
  const auto cells = columnsOf(mesh.cellArrays, dimension);
  if (points.empty() && cells.empty())
  {
    return {};
  }
  TextOutput out(name);
  out << "MeshVersionFormatted 2\n";
  writeNames(out, "Tautline point arrays:", points);
  writeNames(out, "Tautline cell arrays:", cells);
  out << "Dimension " << dimension << '\n';
  writeSolutionSection(out, "Vertices", points, numbersTo(mesh.numberOfPoints()), dimension);
  const Sections sections = sortCells(mesh, name);
  for (std::size_t i = 0; i < sections.size(); ++i)
  {
    writeSolutionSection(out, MeditSections[i].name, cells, sections[i], dimension);
  }
  out << "\nEnd\n";
  return out;
}
}

//------------------------------------------------------------------------------
std::vector<std::string> writeMedit(const MeshFile& mesh, const std::string& name)
{
  const auto [stem, extension] = splitExtension(name);
  const bool binary = extension == "meshb";
  if (extension != "mesh" && !binary)
  {
    throw FileError(name + ": the file name extension must be .mesh or .meshb");
  }
  const Sections sections = sortCells(mesh, name);
  const int dimension = mesh.planar() ? 2 : 3;
  TextOutput text(name);
  MeditOutput out(text, binary ? versionFor(mesh) : 0, dimension);
  writeVertices(out, mesh, dimension);
  const std::vector<Index> points = numbersTo(mesh.numberOfPoints());
  writeList(out, "Corners", findArray(mesh.pointArrays, "Corner"), points);
  writeList(out, "RequiredVertices", findArray(mesh.pointArrays, "Fixed"), points);
  for (std::size_t i = 0; i < sections.size(); ++i)
  {
    writeSection(out, mesh, MeditSections[i], sections[i]);
    const unsigned char type = MeditSections[i].type;
    if (type == FileLine && !sections[i].empty())
    {
      writeList(out, "Ridges", findArray(mesh.cellArrays, "Ridge"), sections[i]);
      writeList(out, "RequiredEdges", findArray(mesh.cellArrays, "Required"), sections[i]);
    }
    if (type == FileTriangle && !sections[i].empty())
    {
      writeList(out, "RequiredTriangles", findArray(mesh.cellArrays, "Required"), sections[i]);
    }
  }
  out.end();
  std::vector<TextOutput> files;
  files.push_back(std::move(text));
  if (binary)
  {
    return replaceSet(files);
  }
  const std::string solution = stem + ".sol";
  if (std::optional<TextOutput> values = solutionFile(mesh, solution))
  {
    files.push_back(std::move(*values));
    return replaceSet(files);
  }
  replaceSet(files);
  std::remove(solution.c_str());
  return { name };
}

//------------------------------------------------------------------------------
std::string meditArraysLeftOut(const MeshFile& mesh)
{
  std::string names;
  for (const auto* arrays : { &mesh.pointArrays, &mesh.cellArrays })
  {
    for (const MeshArray& array : *arrays)
    {
      names += inMesh(array) ? "" : (names.empty() ? "" : ", ") + array.name;
    }
  }
  return names;
}
}
