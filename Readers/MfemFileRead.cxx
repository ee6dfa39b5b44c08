// SPDX-License-Identifier: BSD-3-Clause
#include "MfemNumbering.h"
#include "MfemSpace.h"
#include "TextCursor.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
// Numbers of shapes in the files.
constexpr int Cube = 5, Prism = 6, Pyramid = 7;
constexpr int Shapes = 8;

/// So many that the nodes of a mesh can be counted.
constexpr Index MostVertices = std::numeric_limits<Index>::max() / 1024;

/// What a file has, before nodes are evaluated.
struct MfemMesh
{
  int dimension = 0;
  int spaceDimension = 0;
  MfemElements elements;
  MfemElements boundary;
  Index vertices = 0;
  std::vector<double> coordinates; ///< spaceDimension per vertex, or per node
};

/// VTK's cells of a shape: of first, second and higher order.
struct CellCodes
{
  unsigned char linear, quadratic, higher;
};
constexpr std::array<CellCodes, Shapes> Codes = { { { FileVertex, FileVertex, FileVertex },
  { FileLine, FileLine3, FileLagrangeLine }, { FileTriangle, FileTriangle6, FileLagrangeTriangle },
  { FileQuadrilateral, FileQuadrilateral9, FileLagrangeQuadrilateral },
  { FileTetrahedron, FileTetrahedron10, FileLagrangeTetrahedron },
  { FileHexahedron, FileHexahedron27, FileLagrangeHexahedron },
  { FileWedge, FileWedge18, FileLagrangeWedge }, { FilePyramid, 0, 0 } } };

unsigned char cellCode(int geometry, int order)
{
  const CellCodes& codes = Codes[static_cast<std::size_t>(geometry)];
  return order == 1 ? codes.linear : order == 2 ? codes.quadratic : codes.higher;
}

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
    (nonconforming ? ": nonconforming meshes are not read; refine the mesh to a conforming one"
                   : " is not read; save it as a mesh with nodes of H1 by SetCurvature()"));
}

/// Sections of names that no array has: all to the line with a word.
void skipAttributeSets(TextCursor& cursor, const char* next, MeshFile& mesh)
{
  cursor.skipToToken();
  const char* start = cursor.place();
  if (cursor.word().find("attribute_sets") == std::string_view::npos)
  {
    cursor.moveTo(start);
    return;
  }
  mesh.warnings.push_back("The names of sets of attributes are left out.");
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
    const auto geometry = static_cast<int>(cursor.integer("geometry", 0, Shapes - 1));
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

/// Vertices of no element are not counted by MFEM's numbering, and are left out.
void removeUnusedVertices(MfemMesh& mesh, const TextCursor& cursor)
{
  std::vector<Index> number(static_cast<std::size_t>(mesh.vertices), -1);
  for (MfemElements* part : { &mesh.elements, &mesh.boundary })
  {
    for (const Index vertex : part->vertices)
    {
      if (vertex >= mesh.vertices)
      {
        cursor.fail("an element has vertex " + std::to_string(vertex) + ", there are " +
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

/// The vertices, or their number and "nodes"; true where nodes follow.
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

/// The values of the nodes: `components` per node.
std::vector<double> readValues(TextCursor& cursor, Index nodes, int components, bool byNodes)
{
  constexpr std::size_t shortest = 2; // a digit and a blank
  cursor.expectRoom(nodes, shortest * static_cast<std::size_t>(components), "number of nodes");
  std::vector<double> values(static_cast<std::size_t>(nodes * components));
  const auto count = static_cast<std::size_t>(nodes);
  const auto width = static_cast<std::size_t>(components);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    if (!cursor.skipToToken())
    {
      cursor.fail("the file ends after " + std::to_string(i) + " of " +
        std::to_string(values.size()) + " coordinates of nodes");
    }
    const std::size_t place = byNodes ? (i % count) * width + i / count : i;
    values[place] = cursor.coordinate("coordinate of a node");
    cursor.countRecord();
  }
  return values;
}

/// Adds the points and cells of a mesh; finds nodes, and evaluates them.
class MfemBuilder
{
public:
  MfemBuilder(const MfemMesh& mesh, const MfemSpace& space, MeshFile& output)
    : Mesh(mesh)
    , Space(space)
    , Output(output)
    , Numbering(mesh.vertices, mesh.elements, space.order)
    , Points(static_cast<std::size_t>(this->Numbering.numberOfNodes()), -1)
  {
    std::array<bool, Shapes> used{};
    for (const MfemElements* part : { &mesh.elements, &mesh.boundary })
    {
      for (const unsigned char geometry : part->geometries)
      {
        used[geometry] = true;
      }
    }
    for (int geometry = 0; geometry < Shapes; ++geometry)
    {
      if (used[static_cast<std::size_t>(geometry)])
      {
        this->prepare(geometry);
      }
    }
  }

  /// The values of the space that a file has.
  Index numberOfValues() const
  {
    if (this->Space.continuous)
    {
      return this->Numbering.numberOfNodes();
    }
    Index count = 0;
    for (const unsigned char geometry : this->Mesh.elements.geometries)
    {
      count += static_cast<Index>(this->Orders[geometry].size());
    }
    return count;
  }

  /// Points by the values of the space, and the elements.
  void addElements(const std::vector<double>& values)
  {
    this->Tolerance = this->size(values) * RelativeTolerance;
    if (this->Space.continuous)
    {
      for (Index node = 0; node < this->Numbering.numberOfNodes(); ++node)
      {
        const Vec3 place = this->value(values, node);
        this->Output.points.insert(this->Output.points.end(), place.begin(), place.end());
      }
      this->NextCopy.assign(this->Points.size(), -1);
    }
    std::vector<Index> nodes, cell;
    std::vector<Vec3> own;
    Index first = 0;
    for (std::size_t element = 0; element < this->Mesh.elements.size(); ++element)
    {
      const unsigned char geometry = this->Mesh.elements.geometries[element];
      this->Numbering.nodesOf(element, nullptr, nodes);
      own.clear();
      for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        own.push_back(
          this->value(values, this->Space.continuous ? nodes[i] : first + static_cast<Index>(i)));
      }
      first += static_cast<Index>(nodes.size());
      this->evaluate(geometry, own);
      cell.clear();
      for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        cell.push_back(this->pointOf(nodes[this->Orders[geometry][i]], own[i]));
      }
      this->Output.addCell(
        cellCode(geometry, this->Space.order), cell.data(), static_cast<Index>(cell.size()));
      if (element % ElementsPerPoll == 0)
      {
        throwIfInterrupted();
      }
    }
  }

  void addBoundary(const TextCursor& cursor)
  {
    std::vector<Index> nodes, cell;
    for (std::size_t element = 0; element < this->Mesh.boundary.size(); ++element)
    {
      bool found = this->Numbering.nodesOf(element, &this->Mesh.boundary, nodes);
      const unsigned char geometry = this->Mesh.boundary.geometries[element];
      cell.clear();
      for (std::size_t i = 0; found && i < nodes.size(); ++i)
      {
        cell.push_back(this->Points[static_cast<std::size_t>(nodes[this->Orders[geometry][i]])]);
        found = cell.back() >= 0;
      }
      if (!found)
      {
        cursor.fail("boundary element " + std::to_string(element) + " is no side of an element");
      }
      this->Output.addCell(
        cellCode(geometry, this->Space.order), cell.data(), static_cast<Index>(cell.size()));
    }
  }

  Index differentCopies() const { return this->Copies; }

private:
  static constexpr double RelativeTolerance = 1e-9; ///< of the size of the mesh
  static constexpr std::size_t ElementsPerPoll = 4096;

  /// Finds where the nodes of VTK's cell are in the lattice, and how values are evaluated.
  void prepare(int geometry)
  {
    const auto at = static_cast<std::size_t>(geometry);
    const MfemShape& shape = mfemShape(geometry);
    const int order = this->Space.order;
    const std::vector<LatticePoint> lattice = shape.lattice(order);
    const unsigned char type = cellCode(geometry, order);
    std::vector<Vec3> places;
    // A pyramid is of first order, and has its corners alone.
    for (const LatticePoint& place : shape.dimension == 0 || geometry == Pyramid
        ? shape.corners
        : cellPlaces(type, static_cast<Index>(lattice.size())))
    {
      const auto found = std::find(lattice.begin(), lattice.end(), place);
      this->Orders[at].push_back(static_cast<std::size_t>(found - lattice.begin()));
      places.push_back({ static_cast<double>(place[0]) / order,
        static_cast<double>(place[1]) / order, static_cast<double>(place[2]) / order });
    }
    if (shape.dimension > 1 && (geometry != Pyramid || !this->Space.continuous))
    {
      this->Evaluations[at] = this->Space.evaluation(shape, places);
    }
  }

  Vec3 value(const std::vector<double>& values, Index node) const
  {
    Vec3 point = { 0.0, 0.0, 0.0 };
    const auto width = static_cast<std::size_t>(this->Mesh.spaceDimension);
    for (std::size_t c = 0; c < width; ++c)
    {
      point[c] = values[static_cast<std::size_t>(node) * width + c];
    }
    return point;
  }

  /// The largest extent of coordinates.
  double size(const std::vector<double>& values) const
  {
    double largest = 0.0;
    const auto width = static_cast<std::size_t>(this->Mesh.spaceDimension);
    for (std::size_t c = 0; c < width && !values.empty(); ++c)
    {
      double low = values[c], high = values[c];
      for (std::size_t i = c; i < values.size(); i += width)
      {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      largest = std::max(largest, high - low);
    }
    return largest;
  }

  /// The places of VTK's nodes from the values of an element, in the order of the lattice.
  void evaluate(unsigned char geometry, std::vector<Vec3>& points)
  {
    const std::vector<double>& matrix = this->Evaluations[geometry];
    const std::vector<std::size_t>& order = this->Orders[geometry];
    this->Scratch.assign(points.size(), { 0.0, 0.0, 0.0 });
    for (std::size_t row = 0; row < points.size(); ++row)
    {
      if (matrix.empty())
      {
        this->Scratch[row] = points[order[row]];
        continue;
      }
      for (std::size_t column = 0; column < points.size(); ++column)
      {
        this->Scratch[row] =
          this->Scratch[row] + matrix[row * points.size() + column] * points[column];
      }
    }
    points.swap(this->Scratch);
  }

  /// The point of a node at a place: that of an element before, unless it is elsewhere.
  Index pointOf(Index node, const Vec3& place)
  {
    Index& first = this->Points[static_cast<std::size_t>(node)];
    Index last = -1;
    for (Index point = first; point >= 0; point = this->NextCopy[static_cast<std::size_t>(point)])
    {
      const double* other = this->Output.points.data() + 3 * point;
      const Vec3 offset = { place[0] - other[0], place[1] - other[1], place[2] - other[2] };
      if (std::sqrt(dot(offset, offset)) <= this->Tolerance)
      {
        return point;
      }
      last = point;
    }
    if (last < 0 && this->Space.continuous)
    {
      std::copy(place.begin(), place.end(), this->Output.points.begin() + 3 * node);
      first = node;
      return node;
    }
    const Index point = this->Output.numberOfPoints();
    this->Output.points.insert(this->Output.points.end(), place.begin(), place.end());
    this->NextCopy.push_back(-1);
    if (last < 0)
    {
      first = point;
      return point;
    }
    ++this->Copies;
    this->NextCopy[static_cast<std::size_t>(last)] = point;
    return point;
  }

  const MfemMesh& Mesh;
  const MfemSpace& Space;
  MeshFile& Output;
  MfemNumbering Numbering;
  std::vector<Index> Points;   ///< by node: the first of its points
  std::vector<Index> NextCopy; ///< by point: the next point of the same node
  Index Copies = 0;
  double Tolerance = 0.0;
  std::array<std::vector<double>, Shapes> Evaluations;
  std::array<std::vector<std::size_t>, Shapes> Orders; ///< place in the lattice, by VTK's node
  std::vector<Vec3> Scratch;
};

/// What the numbering of nodes needs: distinct vertices, no pyramids.
void checkCurved(const MfemMesh& mesh, const MfemSpace& space, const TextCursor& cursor)
{
  for (const MfemElements* part : { &mesh.elements, &mesh.boundary })
  {
    for (std::size_t element = 0; element < part->size(); ++element)
    {
      const Index* begin = part->verticesOf(element);
      const Index* end = part->vertices.data() + part->offsets[element + 1];
      const unsigned char geometry = part->geometries[element];
      if (space.isCubic && (geometry == Cube || geometry == Prism))
      {
        cursor.fail("the collection Cubic is not read for cubes and prisms; call SetCurvature(3)");
      }
      if (geometry == Pyramid)
      {
        cursor.fail("curved pyramids are not read; VTK has no such cells of MFEM's space");
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

/// The file ends, or the part of a parallel mesh.
void readEnd(TextCursor& cursor, MeshFile& mesh)
{
  if (!cursor.skipToToken())
  {
    return;
  }
  const char* place = cursor.place();
  const std::string_view word = cursor.word();
  if (word == "mfem_serial_mesh_end")
  {
    mesh.warnings.push_back(
      "This is the part of one process: what it shares with other parts is left out.");
  }
  else if (word != "mfem_mesh_end")
  {
    cursor.failAt(place,
      "the file continues after the last coordinate: '" + std::string(word.substr(0, 20)) + "'");
  }
}
}

//------------------------------------------------------------------------------
MeshFile readMfem(const std::string& name, bool lowerCells)
{
  const FileContent file(name);
  TextCursor cursor(file, '#');
  MeshFile output;
  readMfemHeader(cursor);
  MfemMesh mesh;
  expectWord(cursor, "dimension");
  mesh.dimension = static_cast<int>(cursor.nextInteger("dimension", 1, 3));
  if (mesh.dimension == 1)
  {
    cursor.fail("meshes of lines are not read");
  }
  mesh.elements = readElements(cursor, "elements", mesh.dimension);
  skipAttributeSets(cursor, "boundary", output);
  mesh.boundary = readElements(cursor, "boundary", mesh.dimension - 1);
  skipAttributeSets(cursor, "vertices", output);
  const bool curved = readVertices(cursor, mesh);
  MfemSpace space;
  bool byNodes = false;
  if (curved)
  {
    readSpace(cursor, mesh, space, byNodes);
    checkCurved(mesh, space, cursor);
  }
  if (mesh.spaceDimension < mesh.dimension)
  {
    cursor.fail("points have " + std::to_string(mesh.spaceDimension) + " coordinates, elements " +
      std::to_string(mesh.dimension) + " dimensions");
  }
  removeUnusedVertices(mesh, cursor);
  MfemBuilder builder(mesh, space, output);
  if (curved)
  {
    mesh.coordinates = readValues(cursor, builder.numberOfValues(), mesh.spaceDimension, byNodes);
  }
  readEnd(cursor, output);
  builder.addElements(mesh.coordinates);
  MeshArray::Integers references = mesh.elements.attributes;
  if (lowerCells)
  {
    builder.addBoundary(cursor);
    references.insert(
      references.end(), mesh.boundary.attributes.begin(), mesh.boundary.attributes.end());
  }
  if (builder.differentCopies() > 0)
  {
    output.warnings.push_back("Elements have different coordinates at a common node: " +
      std::to_string(builder.differentCopies()) +
      " more points were made, as a periodic mesh needs them.");
  }
  output.cellArrays.push_back({ "Reference", 1, std::move(references) });
  return output;
}
}
