// SPDX-License-Identifier: BSD-3-Clause
#include "TetGenFile.h"

#include "FileNames.h"
#include "FileSet.h"
#include "TextCursor.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tautline
{
namespace
{
constexpr Index LargestMarker = std::numeric_limits<int>::max();
constexpr Index SmallestMarker = std::numeric_limits<int>::min();

/// The header of the vertices.
struct NodeHeader
{
  Index count = 0;
  int dimension = 3;
  Index attributes = 0;
  bool markers = false;
};

/// Vertices and their numbering in other files.
struct NodeList
{
  NodeHeader header;
  Index base = 0; ///< number of the first vertex, 0 or 1
  Index last() const { return this->base + this->header.count - 1; }
};

NodeHeader readNodeHeader(TextCursor& cursor)
{
  NodeHeader header;
  if (!cursor.skipToToken())
  {
    cursor.fail("no header (number of vertices, dimension, attributes, markers)");
  }
  header.count = cursor.integer("number of vertices", 0, std::numeric_limits<Index>::max());
  header.dimension = static_cast<int>(cursor.integer("dimension", 2, 3));
  header.attributes = cursor.lineIsOver() ? 0 : cursor.integer("number of attributes", 0, 10000);
  header.markers = !cursor.lineIsOver() && cursor.integer("marker flag", 0, 1) == 1;
  cursor.expectLineEnd();
  return header;
}

/// Arrays for attribute columns: named in a comment written by Tautline, or Attribute1, ...
std::vector<MeshArray> attributeArrays(
  const FileContent& file, Index columns, Index tuples, bool elements)
{
  std::vector<ColumnName> names = readColumnNames(file, "Tautline attributes:");
  Index named = 0;
  for (const ColumnName& column : names)
  {
    named += column.components;
  }
  if (named != columns)
  {
    names.clear();
    for (Index i = 1; i <= columns; ++i)
    {
      names.push_back(
        { elements && i == 1 ? "Reference" : "Attribute" + std::to_string(i), 1, 'f' });
    }
  }
  std::vector<MeshArray> arrays;
  for (const ColumnName& column : names)
  {
    arrays.push_back(MeshArray::make(column.name, column.components, column.code,
      static_cast<std::size_t>(tuples * column.components)));
  }
  return arrays;
}

void readAttributes(TextCursor& cursor, std::vector<MeshArray>& arrays, Index tuple)
{
  for (MeshArray& array : arrays)
  {
    for (int c = 0; c < array.components; ++c)
    {
      setValue(
        array, static_cast<std::size_t>(tuple * array.components + c), cursor.real("attribute"));
    }
  }
}

/// A reference is an integer array if all of its values are integers.
void makeIntegral(MeshArray& array)
{
  constexpr double Exact = 9007199254740992.0; // 2^53
  const auto* doubles = std::get_if<MeshArray::Doubles>(&array.values);
  if (doubles && array.name == "Reference" &&
    std::all_of(doubles->begin(), doubles->end(),
      [](double v) { return std::abs(v) < Exact && v == std::floor(v); }))
  {
    array.values = MeshArray::Integers(doubles->begin(), doubles->end());
  }
}

/// Reads the number that starts a line; numbers are consecutive from `base`.
void readNumber(TextCursor& cursor, const char* what, Index expected)
{
  if (!cursor.skipToToken())
  {
    cursor.fail(std::string("the file ends before ") + what + " " + std::to_string(expected));
  }
  const char* start = cursor.place();
  const Index number = cursor.integer(what);
  if (number != expected)
  {
    cursor.failAt(start,
      std::string("expected ") + what + " " + std::to_string(expected) + ", found number " +
        std::to_string(number));
  }
}

/// The number of the first record, 0 or 1; leaves the cursor before it.
Index peekBase(TextCursor& cursor, const char* what)
{
  const char* start = cursor.place();
  if (!cursor.skipToToken())
  {
    cursor.fail(std::string("the file ends before the first ") + what);
  }
  const Index base = cursor.integer(what, 0, 1);
  cursor.moveTo(start);
  return base;
}

NodeList readNodes(TextCursor& cursor, const FileContent& file, MeshFile& mesh)
{
  NodeList nodes;
  nodes.header = readNodeHeader(cursor);
  const NodeHeader& header = nodes.header;
  if (header.count == 0)
  {
    return nodes;
  }
  const Index columns = 1 + header.dimension + header.attributes + header.markers;
  cursor.expectRoom(header.count, static_cast<std::size_t>(2 * columns), "number of vertices");
  nodes.base = peekBase(cursor, "vertex number");
  resizeLarge(mesh.points, static_cast<std::size_t>(3 * header.count));
  mesh.pointArrays = attributeArrays(file, header.attributes, header.count, false);
  MeshArray markers = MeshArray::make(
    "BoundaryMarker", 1, 'i', header.markers ? static_cast<std::size_t>(header.count) : 0);
  auto& marker = std::get<MeshArray::Integers>(markers.values);
  for (Index i = 0; i < header.count; ++i)
  {
    readNumber(cursor, "vertex", nodes.base + i);
    for (int c = 0; c < header.dimension; ++c)
    {
      mesh.points[static_cast<std::size_t>(3 * i + c)] = cursor.coordinate("coordinate");
    }
    readAttributes(cursor, mesh.pointArrays, i);
    if (header.markers)
    {
      marker[static_cast<std::size_t>(i)] =
        cursor.integer("boundary marker", SmallestMarker, LargestMarker);
    }
    cursor.expectLineEnd();
  }
  if (header.markers)
  {
    mesh.pointArrays.push_back(std::move(markers));
  }
  return nodes;
}

NodeList readNodeFile(
  const std::string& name, const std::string& why, MeshFile& mesh, SetCheck& set)
{
  const FileContent file(name, why);
  set.add(file);
  TextCursor cursor(file, '#');
  const NodeList nodes = readNodes(cursor, file, mesh);
  cursor.expectFileEnd("vertex");
  return nodes;
}

/// The positions of a file's local nodes in VTK's order: TetGen lists the midside nodes of a
/// quadratic tetrahedron and triangle in a different order.
std::vector<int> vtkPlaces(unsigned char type)
{
  switch (type)
  {
    case FileTetrahedron10:
      return { 0, 1, 2, 3, 9, 7, 4, 5, 8, 6 };
    case FileTriangle6:
      return { 0, 1, 2, 4, 5, 3 };
    default:
      return {};
  }
}

unsigned char elementType(const TextCursor& cursor, const char* place, Index nodes, int dimension)
{
  const std::array<std::array<unsigned char, 2>, 2> types = { { { FileTriangle, FileTriangle6 },
    { FileTetrahedron, FileTetrahedron10 } } };
  for (const unsigned char type : types[dimension - 2])
  {
    if (nodes == cellNodes(type))
    {
      return type;
    }
  }
  cursor.failAt(place,
    "elements with " + std::to_string(nodes) + " nodes in " + std::to_string(dimension) +
      "D; 3 or 6 (triangles in 2D), 4 or 10 (tetrahedra in 3D) are supported");
}

/// The node numbers of a record, as point ids in VTK's order.
void readCorners(
  TextCursor& cursor, const NodeList& nodes, const std::vector<int>& places, Index size, Index* to)
{
  for (Index c = 0; c < size; ++c)
  {
    const Index id = cursor.integer("vertex", nodes.base, nodes.last()) - nodes.base;
    to[places.empty() ? c : places[static_cast<std::size_t>(c)]] = id;
  }
}

void readElements(const FileContent& file, const NodeList& nodes, MeshFile& mesh)
{
  TextCursor cursor(file, '#');
  if (!cursor.skipToToken())
  {
    cursor.fail("no header (number of elements, nodes of each, attributes)");
  }
  const Index count = cursor.integer("number of elements", 0, std::numeric_limits<Index>::max());
  const char* place = cursor.place();
  const Index size =
    cursor.lineIsOver() ? nodes.header.dimension + 1 : cursor.integer("nodes per element");
  const Index attributes =
    cursor.lineIsOver() ? 0 : cursor.integer("number of attributes", 0, 10000);
  cursor.expectLineEnd();
  const unsigned char type = elementType(cursor, place, size, nodes.header.dimension);
  cursor.expectRoom(
    count, static_cast<std::size_t>(2 * (1 + size + attributes)), "number of elements");
  std::vector<MeshArray> arrays = attributeArrays(file, attributes, count, true);
  std::vector<Index> connectivity;
  resizeLarge(connectivity, static_cast<std::size_t>(count * size));
  const std::vector<int> places = vtkPlaces(type);
  const Index base = count > 0 ? peekBase(cursor, "element number") : 0;
  for (Index i = 0; i < count; ++i)
  {
    readNumber(cursor, "element", base + i);
    readCorners(cursor, nodes, places, size, connectivity.data() + i * size);
    readAttributes(cursor, arrays, i);
    cursor.expectLineEnd();
  }
  cursor.expectFileEnd("element");
  mesh.addCells(type, std::move(connectivity));
  std::for_each(arrays.begin(), arrays.end(), makeIntegral);
  mesh.cellArrays = std::move(arrays);
}

/// Appends the markers of the cells just added; earlier cells without a marker get 0, and arrays of
/// earlier cells get 0 for the new cells.
void addMarkers(MeshFile& mesh, std::vector<Index> markers, bool present)
{
  const std::size_t cells = mesh.cellTypes.size();
  const std::size_t added = markers.size();
  const auto found = std::find_if(mesh.cellArrays.begin(), mesh.cellArrays.end(),
    [](const MeshArray& array) { return array.name == "BoundaryMarker" && array.code() == 'i'; });
  const std::size_t at = static_cast<std::size_t>(found - mesh.cellArrays.begin());
  if (found == mesh.cellArrays.end() && present)
  {
    mesh.cellArrays.push_back(MeshArray::make("BoundaryMarker", 1, 'i', 0));
  }
  for (MeshArray& array : mesh.cellArrays)
  {
    array.resize(cells * static_cast<std::size_t>(array.components));
  }
  if (present)
  {
    auto& values = std::get<MeshArray::Integers>(mesh.cellArrays[at].values);
    std::copy(markers.begin(), markers.end(), values.end() - static_cast<std::ptrdiff_t>(added));
  }
}

/// Faces (3 or 6 nodes) or edges (2 or 3) with an optional marker; numbers of neighbors are
/// skipped.
void readBoundary(const FileContent& file, const NodeList& nodes, bool faces, MeshFile& mesh)
{
  TextCursor cursor(file, '#');
  if (!cursor.skipToToken())
  {
    cursor.fail(faces ? "no header (number of faces, marker flag)"
                      : "no header (number of edges, marker flag)");
  }
  const Index count =
    cursor.integer("number of faces or edges", 0, std::numeric_limits<Index>::max());
  const bool markers = !cursor.lineIsOver() && cursor.integer("marker flag", 0, 1) == 1;
  cursor.expectLineEnd();
  const bool quadraticMesh = !mesh.cellTypes.empty() && cellNodes(mesh.cellTypes[0]) > 4;
  unsigned char type = faces ? FileTriangle : FileLine;
  cursor.skipToToken();
  const int columns = cursor.tokensInLine();
  if (faces ? (columns - markers == 7 || columns - markers == 9)
            : quadraticMesh && columns - markers >= 4)
  {
    type = faces ? FileTriangle6 : FileLine3;
  }
  const Index size = cellNodes(type);
  cursor.expectRoom(
    count, static_cast<std::size_t>(2 * (1 + size + markers)), "number of faces or edges");
  std::vector<Index> connectivity(static_cast<std::size_t>(count * size)),
    values(markers ? count : 0);
  const std::vector<int> places = vtkPlaces(type);
  const Index base = count > 0 ? peekBase(cursor, "number") : 0;
  for (Index i = 0; i < count; ++i)
  {
    readNumber(cursor, faces ? "face" : "edge", base + i);
    readCorners(cursor, nodes, places, size, connectivity.data() + i * size);
    if (markers)
    {
      values[static_cast<std::size_t>(i)] =
        cursor.integer("boundary marker", SmallestMarker, LargestMarker);
    }
    cursor.skipRestOfLine();
  }
  cursor.expectFileEnd(faces ? "face" : "edge");
  mesh.addCells(type, std::move(connectivity));
  addMarkers(mesh, std::move(values), markers);
}
}

//------------------------------------------------------------------------------
MeshFile readTetGenComplex(const FileContent& file, const std::string& stem, bool smesh);

//------------------------------------------------------------------------------
MeshFile readTetGen(const std::string& name, bool lowerCells)
{
  const auto [stem, extension] = splitExtension(name);
  if (extension == "poly" || extension == "smesh")
  {
    return readTetGenComplex(FileContent(name), stem, extension == "smesh");
  }
  if (extension != "node" && extension != "ele" && extension != "face" && extension != "edge")
  {
    throw FileError(
      name + ": the file name extension must be .node, .ele, .face, .edge, .poly or .smesh");
  }
  MeshFile mesh;
  SetCheck set;
  const NodeList nodes = readNodeFile(
    stem + ".node", extension == "node" ? std::string() : "the vertices of " + name, mesh, set);
  const bool elements = extension == "ele" || fileExists(stem + ".ele");
  if (elements)
  {
    readElements(set.add(FileContent(stem + ".ele")), nodes, mesh);
  }
  const bool withLower = lowerCells || !elements;
  const bool faces = withLower && (extension == "face" || fileExists(stem + ".face"));
  if (faces)
  {
    readBoundary(set.add(FileContent(stem + ".face")), nodes, true, mesh);
  }
  if (withLower && (extension == "edge" || fileExists(stem + ".edge")))
  {
    readBoundary(set.add(FileContent(stem + ".edge")), nodes, false, mesh);
  }
  else if (!elements && !faces)
  {
    std::vector<Index> all(static_cast<std::size_t>(nodes.header.count));
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      all[i] = static_cast<Index>(i);
    }
    mesh.addCells(FileVertex, all);
  }
  if (!lowerCells)
  {
    mesh.keepHighestDimension();
  }
  return mesh;
}

namespace
{
/// Reads the corners of a polygon, which may continue on the next lines.
void readPolygon(TextCursor& cursor, const NodeList& nodes, Index corners, MeshFile& mesh)
{
  cursor.expectRoom(corners, 2, "number of corners");
  std::vector<Index> ids(static_cast<std::size_t>(corners));
  for (Index& id : ids)
  {
    if (!cursor.skipToToken())
    {
      cursor.fail("the file ends inside a polygon");
    }
    id = cursor.integer("vertex", nodes.base, nodes.last()) - nodes.base;
  }
  const unsigned char types[] = { FileVertex, FileLine, FileTriangle, FileQuadrilateral };
  const unsigned char type =
    corners <= 4 ? types[corners - 1] : static_cast<unsigned char>(FilePolygon);
  mesh.addCell(type, ids.data(), corners);
}

void readPoint(TextCursor& cursor, int dimension, std::vector<double>& to)
{
  for (int c = 0; c < 3; ++c)
  {
    to.push_back(c < dimension ? cursor.coordinate("coordinate") : 0.0);
  }
}

/// Reads the holes or regions after the facets: count, then lines that start with a number.
Index readListHeader(TextCursor& cursor, const char* what)
{
  if (!cursor.skipToToken())
  {
    return 0; // left out
  }
  const Index count = cursor.count(what, 4);
  cursor.skipRestOfLine();
  return count;
}

void nextLine(TextCursor& cursor, const char* what)
{
  if (!cursor.skipToToken())
  {
    cursor.fail(std::string("the file ends before the last ") + what);
  }
}

void readHolesAndRegions(TextCursor& cursor, int dimension, MeshFile& mesh)
{
  MeshArray holes{ "Holes", 3, MeshArray::Doubles() },
    regions{ "Regions", 5, MeshArray::Doubles() };
  auto& hole = std::get<MeshArray::Doubles>(holes.values);
  auto& region = std::get<MeshArray::Doubles>(regions.values);
  for (Index i = readListHeader(cursor, "number of holes"); i > 0; --i)
  {
    nextLine(cursor, "hole");
    cursor.integer("hole number");
    readPoint(cursor, dimension, hole);
    cursor.expectLineEnd();
  }
  for (Index i = readListHeader(cursor, "number of regions"); i > 0; --i)
  {
    nextLine(cursor, "region");
    cursor.integer("region number");
    readPoint(cursor, dimension, region);
    region.push_back(cursor.lineIsOver() ? 0.0 : cursor.real("region attribute"));
    region.push_back(cursor.lineIsOver() ? -1.0 : cursor.real("largest size"));
    cursor.expectLineEnd();
  }
  cursor.expectFileEnd("region");
  for (MeshArray* array : { &holes, &regions })
  {
    if (array->size() > 0)
    {
      mesh.fieldArrays.push_back(std::move(*array));
    }
  }
}

/// Read the facet lists, by kind of file; each returns one marker per cell.
struct FacetReader
{
  TextCursor& cursor;
  const NodeList& nodes;
  MeshFile& mesh;
  std::vector<Index> markers;
  std::vector<Index> facets;      ///< the facet of each polygon
  std::vector<double> facetHoles; ///< facet, x, y, z

  Index marker(bool present)
  {
    return present && !cursor.lineIsOver()
      ? cursor.integer("boundary marker", SmallestMarker, LargestMarker)
      : 0;
  }
  void segments(Index count, bool marked)
  {
    for (Index i = 0; i < count; ++i)
    {
      nextLine(cursor, "segment");
      cursor.integer("segment number");
      readPolygon(cursor, nodes, 2, mesh);
      markers.push_back(marker(marked));
      cursor.expectLineEnd();
    }
  }
  void simpleFacets(Index count, bool marked)
  {
    for (Index i = 0; i < count; ++i)
    {
      nextLine(cursor, "facet");
      readPolygon(cursor, nodes, cursor.integer("number of corners", 1, LargestMarker), mesh);
      markers.push_back(marker(marked));
      cursor.expectLineEnd();
    }
  }
  void generalFacets(Index count, bool marked)
  {
    for (Index i = 0; i < count; ++i)
    {
      nextLine(cursor, "facet");
      const Index polygons = cursor.integer("number of polygons", 0, LargestMarker);
      const Index holes =
        cursor.lineIsOver() ? 0 : cursor.integer("number of holes", 0, LargestMarker);
      const Index value = marker(marked);
      cursor.expectLineEnd();
      for (Index j = 0; j < polygons; ++j)
      {
        nextLine(cursor, "polygon");
        readPolygon(cursor, nodes, cursor.integer("number of corners", 1, LargestMarker), mesh);
        cursor.expectLineEnd();
        markers.push_back(value);
        facets.push_back(i);
      }
      for (Index j = 0; j < holes; ++j)
      {
        nextLine(cursor, "hole of a facet");
        cursor.integer("hole number");
        facetHoles.push_back(static_cast<double>(i));
        readPoint(cursor, 3, facetHoles);
        cursor.expectLineEnd();
      }
    }
  }
};
}

//------------------------------------------------------------------------------
MeshFile readTetGenComplex(const FileContent& file, const std::string& stem, bool smesh)
{
  MeshFile mesh;
  TextCursor cursor(file, '#');
  NodeList nodes = readNodes(cursor, file, mesh);
  if (nodes.header.count == 0)
  {
    SetCheck set;
    set.add(file);
    nodes = readNodeFile(stem + ".node", "the vertices of " + file.name(), mesh, set);
  }
  nextLine(cursor, "facet");
  const Index count = cursor.count("number of facets or segments", 4);
  const bool marked = !cursor.lineIsOver() && cursor.integer("marker flag", 0, 1) == 1;
  cursor.expectLineEnd();
  FacetReader reader{ cursor, nodes, mesh, {}, {}, {} };
  if (nodes.header.dimension == 2)
  {
    reader.segments(count, marked);
  }
  else if (smesh)
  {
    reader.simpleFacets(count, marked);
  }
  else
  {
    reader.generalFacets(count, marked);
  }
  if (marked)
  {
    mesh.cellArrays.push_back({ "BoundaryMarker", 1, std::move(reader.markers) });
  }
  if (!reader.facets.empty() &&
    reader.facets.back() + 1 != static_cast<Index>(reader.facets.size()))
  {
    mesh.cellArrays.push_back({ "Facet", 1, std::move(reader.facets) });
  }
  if (!reader.facetHoles.empty())
  {
    mesh.fieldArrays.push_back({ "FacetHoles", 4, std::move(reader.facetHoles) });
  }
  readHolesAndRegions(cursor, nodes.header.dimension, mesh);
  return mesh;
}
}
