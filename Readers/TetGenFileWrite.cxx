// SPDX-License-Identifier: BSD-3-Clause
#include "TetGenFile.h"

#include "FileNames.h"
#include "FileSet.h"
#include "TextCursor.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

namespace tautline
{
namespace
{
/// Node i of a record is node Order[i] of VTK's cell; the inverse of the reader's table.
constexpr std::array<int, 10> Tetrahedron10Order = { 0, 1, 2, 3, 9, 7, 4, 5, 8, 6 };
constexpr std::array<int, 6> Triangle6Order = { 0, 1, 2, 4, 5, 3 };

/// The cells of a mesh, by their file.
struct Plan
{
  bool planar = false;
  std::vector<Index> elements, faces, edges, vertices;
};

/// Markers of points or cells: BoundaryMarker, or otherwise Reference.
const MeshArray* markerArray(const std::vector<MeshArray>& arrays)
{
  const MeshArray* marker = findArray(arrays, "BoundaryMarker");
  marker = marker ? marker : findArray(arrays, "Reference");
  return marker && marker->components == 1 && marker->code() != 'f' ? marker : nullptr;
}

/// The arrays that become attribute columns.
std::vector<const MeshArray*> attributeColumns(
  const std::vector<MeshArray>& arrays, const MeshArray* marker, const char* first)
{
  std::vector<const MeshArray*> columns;
  for (const MeshArray& array : arrays)
  {
    if (&array != marker)
    {
      columns.insert(array.name == first ? columns.begin() : columns.end(), &array);
    }
  }
  return columns;
}

Index width(const std::vector<const MeshArray*>& columns)
{
  Index sum = 0;
  for (const MeshArray* array : columns)
  {
    sum += array->components;
  }
  return sum;
}

void writeColumns(TextOutput& out, const std::vector<const MeshArray*>& columns)
{
  std::vector<ColumnName> names;
  for (const MeshArray* array : columns)
  {
    names.push_back({ array->name, array->components, array->code() });
  }
  if (!names.empty())
  {
    out << writeColumnNames("Tautline attributes:", names);
  }
}

void writeTuple(TextOutput& out, const std::vector<const MeshArray*>& columns, Index tuple)
{
  for (const MeshArray* array : columns)
  {
    for (int c = 0; c < array->components; ++c)
    {
      out << ' ';
      out.value(*array, static_cast<std::size_t>(tuple * array->components + c));
    }
  }
}

[[noreturn]] void refuse(
  const MeshFile& mesh, const std::string& name, const std::vector<Index>& cells)
{
  std::map<unsigned char, Index> counts;
  for (const Index cell : cells)
  {
    ++counts[mesh.cellTypes[static_cast<std::size_t>(cell)]];
  }
  std::string list;
  for (const auto& [type, count] : counts)
  {
    list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + cellPlural(type);
  }
  throw FileError(name + ": these files cannot hold " + list +
    " of such a mesh; extract the cells of one kind (Extract Cells By Type), run Tetrahedralize "
    "first, or write Gmsh's .msh");
}

/// Sorts the cells by file; throws Error for cells that are not supported.
Plan planFiles(const MeshFile& mesh, const std::string& name)
{
  Plan plan;
  plan.planar = mesh.planar();
  const unsigned char element = plan.planar ? FileTriangle : FileTetrahedron;
  const unsigned char quadratic = plan.planar ? FileTriangle6 : FileTetrahedron10;
  std::array<Index, 256> counts{};
  std::vector<Index> wrong;
  for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
  {
    const unsigned char type = mesh.cellTypes[static_cast<std::size_t>(cell)];
    ++counts[type];
    const bool face = !plan.planar && (type == FileTriangle || type == FileTriangle6);
    const bool edge = type == FileLine || type == FileLine3;
    std::vector<Index>& list = type == element || type == quadratic ? plan.elements
      : face                                                        ? plan.faces
      : edge                                                        ? plan.edges
      : type == FileVertex                                          ? plan.vertices
                                                                    : wrong;
    list.push_back(cell);
  }
  const bool mixed = (counts[element] && counts[quadratic]) ||
    (counts[FileLine] && counts[FileLine3]) || (counts[FileTriangle] && counts[FileTriangle6]);
  if (!plan.vertices.empty() && mesh.dimension() > 0)
  {
    wrong.insert(wrong.end(), plan.vertices.begin(), plan.vertices.end());
  }
  if (!wrong.empty())
  {
    refuse(mesh, name, wrong);
  }
  if (mixed)
  {
    throw FileError(name + ": linear and quadratic cells cannot be in one file; write Gmsh's .msh");
  }
  return plan;
}

/// The list of vertices, with its header.
void writeNodes(TextOutput& out, const MeshFile& mesh, bool planar)
{
  const MeshArray* marker = markerArray(mesh.pointArrays);
  const auto columns = attributeColumns(mesh.pointArrays, marker, "");
  const int dimension = planar ? 2 : 3;
  writeColumns(out, columns);
  out << mesh.numberOfPoints() << ' ' << dimension << ' ' << width(columns) << ' '
      << (marker ? 1 : 0);
  out.endLine();
  for (Index i = 0; i < mesh.numberOfPoints(); ++i)
  {
    out << i;
    for (int c = 0; c < dimension; ++c)
    {
      out << ' ' << mesh.points[static_cast<std::size_t>(3 * i + c)];
    }
    writeTuple(out, columns, i);
    if (marker)
    {
      out << ' ';
      out.value(*marker, static_cast<std::size_t>(i));
    }
    out.endLine();
  }
}

void writeCorners(TextOutput& out, const MeshFile& mesh, Index cell)
{
  const Index begin = mesh.offsets[static_cast<std::size_t>(cell)];
  const Index size = mesh.offsets[static_cast<std::size_t>(cell + 1)] - begin;
  const unsigned char type = mesh.cellTypes[static_cast<std::size_t>(cell)];
  for (Index c = 0; c < size; ++c)
  {
    const Index from = type == FileTetrahedron10 ? Tetrahedron10Order[static_cast<std::size_t>(c)]
      : type == FileTriangle6                    ? Triangle6Order[static_cast<std::size_t>(c)]
                                                 : c;
    out << ' ' << mesh.connectivity[static_cast<std::size_t>(begin + from)];
  }
}

TextOutput writeElements(const MeshFile& mesh, const Plan& plan, const std::string& name)
{
  TextOutput out(name);
  const MeshArray* own = findArray(mesh.cellArrays, "BoundaryMarker");
  // a marker of the faces is not an attribute of the elements
  const MeshArray* marker = own && !(plan.faces.empty() && plan.edges.empty()) ? own : nullptr;
  const auto columns = attributeColumns(mesh.cellArrays, marker, "Reference");
  const bool plain = columns.size() == 1 && columns[0]->name == "Reference" &&
    columns[0]->components == 1 && columns[0]->code() != 'u';
  if (!plain)
  {
    writeColumns(out, columns);
  }
  const auto first = static_cast<std::size_t>(plan.elements[0]);
  out << static_cast<Index>(plan.elements.size()) << ' '
      << mesh.offsets[first + 1] - mesh.offsets[first] << ' ' << width(columns);
  out.endLine();
  for (std::size_t i = 0; i < plan.elements.size(); ++i)
  {
    out << static_cast<Index>(i);
    writeCorners(out, mesh, plan.elements[i]);
    writeTuple(out, columns, plan.elements[i]);
    out.endLine();
  }
  return out;
}

TextOutput writeBoundary(
  const MeshFile& mesh, const std::vector<Index>& cells, const std::string& name)
{
  TextOutput out(name);
  const MeshArray* marker = markerArray(mesh.cellArrays);
  out << static_cast<Index>(cells.size()) << ' ' << (marker ? 1 : 0);
  out.endLine();
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    out << static_cast<Index>(i);
    writeCorners(out, mesh, cells[i]);
    if (marker)
    {
      out << ' ';
      out.value(*marker, static_cast<std::size_t>(cells[i]));
    }
    out.endLine();
  }
  return out;
}

/// Writes the rows of a field array after their count; `skip` leading components are not written.
void writeList(TextOutput& out, const MeshArray* array, int dimension)
{
  const Index rows = array ? static_cast<Index>(array->size()) / array->components : 0;
  out << rows;
  out.endLine();
  for (Index i = 0; i < rows; ++i)
  {
    out << i;
    for (int c = 0; c < array->components; ++c)
    {
      if (c < dimension || c > 2)
      {
        out << ' ' << array->at(static_cast<std::size_t>(i * array->components + c));
      }
    }
    out.endLine();
  }
}

/// The holes of the facets, by facet.
std::multimap<Index, Index> facetHoles(const MeshArray* holes)
{
  std::multimap<Index, Index> rows;
  for (std::size_t i = 0; holes && i < holes->size() / 4; ++i)
  {
    rows.emplace(static_cast<Index>(holes->at(4 * i)), static_cast<Index>(i));
  }
  return rows;
}

void writeFacets(TextOutput& out, const MeshFile& mesh, bool smesh)
{
  const MeshArray* marker = markerArray(mesh.cellArrays);
  const MeshArray* facet = smesh ? nullptr : findArray(mesh.cellArrays, "Facet");
  const MeshArray* holes = smesh ? nullptr : findArray(mesh.fieldArrays, "FacetHoles");
  const auto rows = facetHoles(holes);
  std::vector<std::vector<Index>> facets;
  for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
  {
    const auto at = static_cast<std::size_t>(cell);
    if (!facet || cell == 0 || facet->at(at) != facet->at(at - 1))
    {
      facets.emplace_back();
    }
    facets.back().push_back(cell);
  }
  out << static_cast<Index>(facets.size()) << ' ' << (marker ? 1 : 0);
  out.endLine();
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    const auto [first, last] = rows.equal_range(static_cast<Index>(f));
    if (!smesh)
    {
      out << static_cast<Index>(facets[f].size()) << ' '
          << static_cast<Index>(std::distance(first, last));
      out << (marker ? " " : "");
    }
    for (const Index cell : facets[f])
    {
      if (!smesh && cell == facets[f][0])
      {
        if (marker)
        {
          out.value(*marker, static_cast<std::size_t>(cell));
        }
        out.endLine();
      }
      const auto at = static_cast<std::size_t>(cell);
      out << mesh.offsets[at + 1] - mesh.offsets[at];
      writeCorners(out, mesh, cell);
      if (smesh && marker)
      {
        out << ' ';
        out.value(*marker, at);
      }
      out.endLine();
    }
    for (auto row = first; row != last; ++row)
    {
      out << 0;
      for (std::size_t c = 1; c < 4; ++c)
      {
        out << ' ' << holes->at(static_cast<std::size_t>(4 * row->second) + c);
      }
      out.endLine();
    }
  }
}

void writeSegments(TextOutput& out, const MeshFile& mesh)
{
  const MeshArray* marker = markerArray(mesh.cellArrays);
  out << mesh.numberOfCells() << ' ' << (marker ? 1 : 0);
  out.endLine();
  for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
  {
    out << cell;
    writeCorners(out, mesh, cell);
    if (marker)
    {
      out << ' ';
      out.value(*marker, static_cast<std::size_t>(cell));
    }
    out.endLine();
  }
}

void writeComplex(const MeshFile& mesh, const std::string& name, bool smesh)
{
  std::vector<Index> wrong;
  const bool planar = mesh.planar() && mesh.dimension() <= 1;
  for (Index cell = 0; cell < mesh.numberOfCells(); ++cell)
  {
    const unsigned char type = mesh.cellTypes[static_cast<std::size_t>(cell)];
    const bool linear = type == FileVertex || type == FileLine || type == FileTriangle ||
      type == FileQuadrilateral || type == FilePolygon;
    if (!linear || (planar && type != FileLine))
    {
      wrong.push_back(cell);
    }
  }
  if (!wrong.empty())
  {
    refuse(mesh, name, wrong);
  }
  TextOutput out(name);
  writeNodes(out, mesh, planar);
  if (planar)
  {
    writeSegments(out, mesh);
  }
  else
  {
    writeFacets(out, mesh, smesh);
  }
  writeList(out, findArray(mesh.fieldArrays, "Holes"), planar ? 2 : 3);
  writeList(out, findArray(mesh.fieldArrays, "Regions"), planar ? 2 : 3);
  out.close();
}
}

//------------------------------------------------------------------------------
std::vector<std::string> writeTetGen(const MeshFile& mesh, const std::string& name)
{
  const auto [stem, extension] = splitExtension(name);
  if (extension == "poly" || extension == "smesh")
  {
    writeComplex(mesh, name, extension == "smesh");
    return { name };
  }
  if (extension != "node" && extension != "ele" && extension != "face" && extension != "edge")
  {
    throw FileError(
      name + ": the file name extension must be .node, .ele, .face, .edge, .poly or .smesh");
  }
  const Plan plan = planFiles(mesh, name);
  TextOutput nodes(stem + ".node");
  writeNodes(nodes, mesh, plan.planar);
  std::vector<TextOutput> files;
  files.push_back(std::move(nodes));
  if (!plan.elements.empty())
  {
    files.push_back(writeElements(mesh, plan, stem + ".ele"));
  }
  if (!plan.faces.empty())
  {
    files.push_back(writeBoundary(mesh, plan.faces, stem + ".face"));
  }
  if (!plan.edges.empty())
  {
    files.push_back(writeBoundary(mesh, plan.edges, stem + ".edge"));
  }
  const std::vector<std::string> written = replaceSet(files);
  for (const char* companion : { ".ele", ".face", ".edge" })
  {
    const std::string file = stem + companion;
    if (std::find(written.begin(), written.end(), file) == written.end() && fileExists(file))
    {
      std::remove(file.c_str());
    }
  }
  return written;
}
}
