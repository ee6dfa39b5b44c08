// SPDX-License-Identifier: BSD-3-Clause
#include "MfemContents.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// A limit that allows the nodes of a mesh to be counted without overflow.
constexpr Index MostVertices = std::numeric_limits<Index>::max() / 1024;

/// VTK's cells of a shape, of first, second and higher order.
struct CellCodes
{
  unsigned char linear, quadratic, higher;
};
constexpr std::array<CellCodes, MfemShapes> Codes = { { { FileVertex, FileVertex, FileVertex },
  { FileLine, FileLine3, FileLagrangeLine }, { FileTriangle, FileTriangle6, FileLagrangeTriangle },
  { FileQuadrilateral, FileQuadrilateral9, FileLagrangeQuadrilateral },
  { FileTetrahedron, FileTetrahedron10, FileLagrangeTetrahedron },
  { FileHexahedron, FileHexahedron27, FileLagrangeHexahedron },
  { FileWedge, FileWedge18, FileLagrangeWedge }, { FilePyramid, 0, 0 } } };

void expectWord(TextCursor& cursor, const char* expected)
{
  const std::string word = cursor.nextWord(expected);
  if (word != expected)
  {
    cursor.fail(std::string("expected '") + expected + "', found '" + word.substr(0, 40) + "'");
  }
}

void readMfemHeader(TextCursor& cursor)
{
  if (cursor.nextWord("MFEM mesh v1.0") != "MFEM")
  {
    cursor.fail("expected MFEM mesh v1.0");
  }
  std::string kind;
  while (!cursor.lineIsOver())
  {
    kind += (kind.empty() ? "" : " ") + std::string(cursor.word().substr(0, 40));
  }
  if (kind == "mesh v1.0" || kind == "mesh v1.2" || kind == "mesh v1.3")
  {
    return;
  }
  const bool nonconforming = kind.find("NC") != kind.npos || kind == "mesh v1.1";
  cursor.fail("MFEM " + kind.substr(0, 40) +
    (nonconforming ? ": nonconforming meshes are not supported; refine the mesh to a conforming one"
                   : " is not supported; save it as a mesh with H1 nodes using SetCurvature()"));
}

/// Skips sections of names that no array holds, up to the line with a word.
void skipAttributeSets(TextCursor& cursor, const char* next, std::vector<std::string>& warnings)
{
  cursor.skipToToken();
  const char* start = cursor.place();
  if (cursor.word().find("attribute_sets") == std::string_view::npos)
  {
    cursor.moveTo(start);
    return;
  }
  warnings.push_back("The names of sets of attributes are left out.");
  do
  {
    cursor.skipRestOfLine();
    if (!cursor.skipToToken())
    {
      cursor.fail(std::string("the file ends before ") + next);
    }
    start = cursor.place();
  } while (cursor.word() != next);
  cursor.moveTo(start);
}

MfemElements readElements(TextCursor& cursor, const char* section, int dimension)
{
  expectWord(cursor, section);
  cursor.skipToToken();
  constexpr std::size_t shortest = 6; // an attribute, a shape and a vertex with blanks
  const Index count = cursor.count("number of elements", shortest);
  MfemElements elements;
  for (Index element = 0; element < count; ++element)
  {
    if (!cursor.skipToToken())
    {
      cursor.fail(std::string("the file ends before ") + section + " " + std::to_string(element));
    }
    const char* place = cursor.place();
    elements.attributes.push_back(cursor.integer("attribute"));
    const auto geometry = static_cast<int>(cursor.integer("geometry", 0, MfemShapes - 1));
    const MfemShape& shape = mfemShape(geometry);
    if (shape.dimension != dimension)
    {
      cursor.failAt(place,
        std::string("a ") + shape.name + " in the section " + section + " of a " +
          std::to_string(dimension) + "-dimensional part");
    }
    for (std::size_t corner = 0; corner < shape.corners.size(); ++corner)
    {
      elements.vertices.push_back(cursor.integer("vertex", 0, MostVertices));
    }
    cursor.expectLineEnd();
    elements.geometries.push_back(static_cast<unsigned char>(geometry));
    elements.offsets.push_back(static_cast<Index>(elements.vertices.size()));
  }
  return elements;
}

/// Vertices of no element are not counted in MFEM's numbering and are left out.
void removeUnusedVertices(MfemMesh& mesh, const TextCursor& cursor)
{
  std::vector<Index> number(static_cast<std::size_t>(mesh.vertices), -1);
  for (MfemElements* part : { &mesh.elements, &mesh.boundary })
  {
    for (const Index vertex : part->vertices)
    {
      if (vertex >= mesh.vertices)
      {
        cursor.fail("an element has vertex " + std::to_string(vertex) + "; there are " +
          std::to_string(mesh.vertices));
      }
      number[static_cast<std::size_t>(vertex)] = 0;
    }
  }
  Index used = 0;
  const auto width = static_cast<std::size_t>(mesh.spaceDimension);
  for (std::size_t vertex = 0; vertex < number.size(); ++vertex)
  {
    if (number[vertex] == 0)
    {
      for (std::size_t c = 0; c < width && !mesh.coordinates.empty(); ++c)
      {
        mesh.coordinates[static_cast<std::size_t>(used) * width + c] =
          mesh.coordinates[vertex * width + c];
      }
      number[vertex] = used++;
    }
  }
  mesh.vertices = used;
  mesh.coordinates.resize(mesh.coordinates.empty() ? 0 : static_cast<std::size_t>(used) * width);
  for (MfemElements* part : { &mesh.elements, &mesh.boundary })
  {
    for (Index& vertex : part->vertices)
    {
      vertex = number[static_cast<std::size_t>(vertex)];
    }
  }
}

/// Reads the vertices, or their number and "nodes"; true if nodes follow.
bool readVertices(TextCursor& cursor, MfemMesh& mesh)
{
  expectWord(cursor, "vertices");
  cursor.skipToToken();
  mesh.vertices = cursor.integer("number of vertices", 0, MostVertices);
  if (!cursor.skipToToken())
  {
    cursor.fail("the file ends before the coordinates");
  }
  const char* place = cursor.place();
  if (cursor.word() == "nodes")
  {
    const std::size_t used = mesh.elements.vertices.size() + mesh.boundary.vertices.size();
    if (static_cast<std::size_t>(mesh.vertices) > used)
    {
      cursor.failAt(place,
        "there are " + std::to_string(mesh.vertices) + " vertices, but elements have " +
          std::to_string(used) + " at most");
    }
    return true;
  }
  cursor.moveTo(place);
  mesh.spaceDimension = static_cast<int>(cursor.integer("dimension of vertices", 1, 3));
  cursor.expectRoom(mesh.vertices, static_cast<std::size_t>(2 * mesh.spaceDimension), "vertices");
  mesh.coordinates.resize(static_cast<std::size_t>(mesh.vertices * mesh.spaceDimension));
  for (double& value : mesh.coordinates)
  {
    cursor.skipToToken();
    value = cursor.coordinate("coordinate");
    cursor.countRecord();
  }
  return false;
}

/// The values of the nodes, and their positions in the text.
void readValues(TextCursor& cursor, Index nodes, const char* start, MfemContents& contents)
{
  constexpr std::size_t shortest = 2; // a digit and a blank
  const int components = contents.mesh.spaceDimension;
  cursor.expectRoom(nodes, shortest * static_cast<std::size_t>(components), "number of nodes");
  std::vector<double>& values = contents.mesh.coordinates;
  values.resize(static_cast<std::size_t>(nodes * components));
  contents.texts.resize(start ? values.size() : 0);
  const auto count = static_cast<std::size_t>(nodes);
  const auto width = static_cast<std::size_t>(components);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    if (!cursor.skipToToken())
    {
      cursor.fail("the file ends after " + std::to_string(i) + " of " +
        std::to_string(values.size()) + " coordinates of nodes");
    }
    const std::size_t place = contents.byNodes ? (i % count) * width + i / count : i;
    const char* text = cursor.place();
    values[place] = cursor.coordinate("coordinate of a node");
    if (start)
    {
      contents.texts[place] = { static_cast<std::size_t>(text - start),
        static_cast<std::size_t>(cursor.place() - start) };
    }
    cursor.countRecord();
  }
}

/// The requirements of the node numbering: distinct vertices, no pyramids.
void checkCurved(const MfemMesh& mesh, const MfemSpace& space, const TextCursor& cursor)
{
  for (const MfemElements* part : { &mesh.elements, &mesh.boundary })
  {
    for (std::size_t element = 0; element < part->size(); ++element)
    {
      const Index* begin = part->verticesOf(element);
      const Index* end = part->vertices.data() + part->offsets[element + 1];
      const unsigned char geometry = part->geometries[element];
      if (space.isCubic && (geometry == MfemCube || geometry == MfemPrism))
      {
        cursor.fail(
          "the collection Cubic is not supported for cubes and prisms; call SetCurvature(3)");
      }
      if (geometry == MfemPyramid)
      {
        cursor.fail("curved pyramids are not supported; VTK has no such cells of MFEM's space");
      }
      for (const Index* vertex = begin; vertex < end; ++vertex)
      {
        if (std::find(vertex + 1, end, *vertex) != end)
        {
          cursor.fail("element " + std::to_string(element) + " has vertex " +
            std::to_string(*vertex) + " twice: a curved element needs distinct vertices");
        }
      }
    }
  }
}

void readSpace(TextCursor& cursor, MfemMesh& mesh, MfemSpace& space, bool& byNodes)
{
  expectWord(cursor, "FiniteElementSpace");
  expectWord(cursor, "FiniteElementCollection:");
  const std::string name = cursor.nextWord("the collection");
  try
  {
    space = MfemSpace::parse(name, mesh.dimension);
  }
  catch (const Error& error)
  {
    cursor.fail(error.what());
  }
  expectWord(cursor, "VDim:");
  mesh.spaceDimension = static_cast<int>(cursor.nextInteger("VDim", 1, 3));
  expectWord(cursor, "Ordering:");
  byNodes = cursor.nextInteger("Ordering", 0, 1) == 0;
}

/// Reads the end of the file, or of the part of a parallel mesh.
void readEnd(TextCursor& cursor, std::vector<std::string>& warnings)
{
  if (!cursor.skipToToken())
  {
    return;
  }
  const char* place = cursor.place();
  const std::string_view word = cursor.word();
  if (word == "mfem_serial_mesh_end")
  {
    warnings.push_back("This is the part of one process: the data on entities shared with other "
                       "parts are left out.");
  }
  else if (word != "mfem_mesh_end")
  {
    cursor.failAt(place,
      "the file continues after the last coordinate: '" + std::string(word.substr(0, 20)) + "'");
  }
}
}

//------------------------------------------------------------------------------
unsigned char mfemCellType(int geometry, int order)
{
  const CellCodes& codes = Codes[static_cast<std::size_t>(geometry)];
  return order == 1 ? codes.linear : order == 2 ? codes.quadratic : codes.higher;
}

//------------------------------------------------------------------------------
int mfemGeometry(unsigned char type)
{
  const auto* found = std::find_if(Codes.begin(), Codes.end(),
    [type](const CellCodes& codes) { return codes.linear == linearType(type); });
  return found == Codes.end() ? -1 : static_cast<int>(found - Codes.begin());
}

//------------------------------------------------------------------------------
Index countMfemValues(const MfemMesh& mesh, const MfemSpace& space, const MfemNumbering& numbering)
{
  if (space.continuous)
  {
    return numbering.numberOfNodes();
  }
  std::array<Index, MfemShapes> sizes{};
  for (int geometry = 0; geometry < MfemShapes; ++geometry)
  {
    sizes[static_cast<std::size_t>(geometry)] =
      static_cast<Index>(mfemShape(geometry).lattice(space.order).size());
  }
  Index count = 0;
  for (const unsigned char geometry : mesh.elements.geometries)
  {
    count += sizes[geometry];
  }
  return count;
}

//------------------------------------------------------------------------------
void readMfemContents(TextCursor& cursor, const char* start, MfemContents& contents)
{
  MfemMesh& mesh = contents.mesh;
  readMfemHeader(cursor);
  expectWord(cursor, "dimension");
  mesh.dimension = static_cast<int>(cursor.nextInteger("dimension", 1, 3));
  if (mesh.dimension == 1)
  {
    cursor.fail("meshes of lines are not supported");
  }
  mesh.elements = readElements(cursor, "elements", mesh.dimension);
  skipAttributeSets(cursor, "boundary", contents.warnings);
  mesh.boundary = readElements(cursor, "boundary", mesh.dimension - 1);
  skipAttributeSets(cursor, "vertices", contents.warnings);
  contents.curved = readVertices(cursor, mesh);
  if (contents.curved)
  {
    readSpace(cursor, mesh, contents.space, contents.byNodes);
    checkCurved(mesh, contents.space, cursor);
  }
  if (mesh.spaceDimension < mesh.dimension)
  {
    cursor.fail("points have " + std::to_string(mesh.spaceDimension) + " coordinates, elements " +
      std::to_string(mesh.dimension) + " dimensions");
  }
  removeUnusedVertices(mesh, cursor);
  contents.numbering.emplace(mesh.vertices, mesh.elements, contents.space.order);
  if (contents.curved)
  {
    readValues(cursor, countMfemValues(mesh, contents.space, *contents.numbering), start, contents);
  }
  readEnd(cursor, contents.warnings);
}
}
