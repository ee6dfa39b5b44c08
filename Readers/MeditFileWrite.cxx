// SPDX-License-Identifier: BSD-3-Clause
#include "MeditFile.h"

#include "FileNames.h"
#include "TextCursor.h"
#include "FileSet.h"

#include <algorithm>
#include <array>
#include <cstdio>
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

void writeVertices(TextOutput& out, const MeshFile& mesh, int dimension)
{
  const MeshArray* reference = findArray(mesh.pointArrays, "Reference");
  reference = whole(reference) ? reference : findArray(mesh.pointArrays, "BoundaryMarker");
  reference = whole(reference) ? reference : nullptr;
  out << "\nVertices\n" << mesh.numberOfPoints();
  out.endLine();
  for (std::size_t i = 0; i < static_cast<std::size_t>(mesh.numberOfPoints()); ++i)
  {
    for (int c = 0; c < dimension; ++c)
    {
      out << mesh.points[3 * i + static_cast<std::size_t>(c)] << ' ';
    }
    if (reference)
    {
      out.value(*reference, i);
    }
    else
    {
      out << 0;
    }
    out.endLine();
  }
}

/// Lower cells carry the marker of the boundary where there is one.
const MeshArray* referenceOf(const MeshFile& mesh, unsigned char type, int dimension)
{
  const MeshArray* marker = findArray(mesh.cellArrays, "BoundaryMarker");
  const MeshArray* reference = findArray(mesh.cellArrays, "Reference");
  const bool lower = cellDimension(type) < dimension;
  const MeshArray* first = lower && whole(marker) ? marker : reference;
  const MeshArray* second = whole(first) ? first : marker;
  return whole(second) ? second : nullptr;
}

void writeSection(TextOutput& out, const MeshFile& mesh, const MeditSection& section,
  const std::vector<Index>& cells)
{
  if (cells.empty())
  {
    return;
  }
  const MeshArray* reference = referenceOf(mesh, section.type, mesh.dimension());
  out << '\n' << section.name << '\n' << static_cast<Index>(cells.size());
  out.endLine();
  for (const Index cell : cells)
  {
    const auto at = static_cast<std::size_t>(cell);
    constexpr Index WedgeOrder[] = { 0, 2, 1, 3, 5, 4 }; // see the reader
    const Index size = mesh.offsets[at + 1] - mesh.offsets[at];
    for (Index i = 0; i < size; ++i)
    {
      const Index node = mesh.offsets[at] + (section.type == FileWedge ? WedgeOrder[i] : i);
      out << mesh.connectivity[static_cast<std::size_t>(node)] + 1 << ' ';
    }
    if (reference)
    {
      out.value(*reference, at);
    }
    else
    {
      out << 0;
    }
    out.endLine();
  }
}

/// The numbers, from 1, of the nonzero entries.
void writeList(
  TextOutput& out, const char* section, const MeshArray* flags, const std::vector<Index>& of)
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
  out << '\n' << section << '\n' << static_cast<Index>(numbers.size());
  out.endLine();
  for (const Index number : numbers)
  {
    out << number;
    out.endLine();
  }
}

bool symmetric(const MeshArray& array, int dimension)
{
  for (std::size_t i = 0; i < array.size(); i += 9)
  {
    const bool good = array.at(i + 1) == array.at(i + 3) && array.at(i + 2) == array.at(i + 6) &&
      array.at(i + 5) == array.at(i + 7) &&
      (dimension == 3 ||
        (array.at(i + 2) == 0.0 && array.at(i + 5) == 0.0 && array.at(i + 8) == 0.0));
    if (!good) // NaN too
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

/// The file of the arrays, if there are any; see writeMedit.
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
  if (extension != "mesh")
  {
    throw FileError(name + ": .mesh is expected as the file's ending");
  }
  const Sections sections = sortCells(mesh, name);
  const int dimension = mesh.planar() ? 2 : 3;
  TextOutput out(name);
  out << "MeshVersionFormatted 2\nDimension " << dimension << '\n';
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
  out << "\nEnd\n";
  std::vector<TextOutput> files;
  files.push_back(std::move(out));
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
}
