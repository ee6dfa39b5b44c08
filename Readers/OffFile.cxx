// SPDX-License-Identifier: BSD-3-Clause
#include "OffFile.h"

#include "TextCursor.h"
#include "TextOutput.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// The kinds of numbers of a vertex.
struct Layout
{
  bool colors = false;
  bool normals = false;
};

/// Geomview's default color of a face.
constexpr double Grey = 170.0;

Layout readKeyword(TextCursor& cursor)
{
  Layout layout;
  if (!cursor.skipToToken())
  {
    cursor.fail("the file is empty");
  }
  const char* place = cursor.place();
  if (*place >= '0' && *place <= '9')
  {
    return layout; // the keyword may be left out
  }
  const std::string word(cursor.word());
  std::string_view rest = word;
  layout.colors = !rest.empty() && rest[0] == 'C';
  rest.remove_prefix(layout.colors);
  layout.normals = !rest.empty() && rest[0] == 'N';
  rest.remove_prefix(layout.normals);
  if (rest != "OFF")
  {
    cursor.failAt(place, "expected OFF, COFF, NOFF or CNOFF, found '" + word.substr(0, 20) + "'");
  }
  if (!cursor.lineIsOver() && cursor.word() == "BINARY")
  {
    cursor.fail("binary OFF files are not supported; save it as text");
  }
  cursor.moveTo(place + word.size());
  return layout;
}

/// Reads colors of any form; all are bytes unless one has a decimal point.
class Colors
{
public:
  void read(TextCursor& cursor, int components)
  {
    for (int c = 0; c < components; ++c)
    {
      cursor.skipBlanks();
      const char* place = cursor.place();
      const double value = cursor.real("colour");
      const std::string_view text(place, static_cast<std::size_t>(cursor.place() - place));
      this->Fractions |= text.find_first_of(".eE") != text.npos;
      if (!(value >= 0.0 && value <= 255.0))
      {
        cursor.failAt(
          place, "a color is " + std::string(text) + ", from 0 to 255 (or to 1.0) is allowed");
      }
      this->Values.push_back(value);
    }
  }
  void add(double value) { this->Values.push_back(value); }
  bool fractions() const { return this->Fractions; }
  MeshArray array(int components)
  {
    if (this->Fractions)
    {
      return { "Color", components, std::move(this->Values) };
    }
    return { "Color", components, MeshArray::Bytes(this->Values.begin(), this->Values.end()) };
  }

private:
  std::vector<double> Values;
  bool Fractions = false;
};

void readVertices(TextCursor& cursor, Layout layout, Index count, MeshFile& mesh)
{
  const int fixed = layout.normals ? 6 : 3;
  cursor.skipToToken();
  const int columns = count > 0 ? cursor.tokensInLine() : fixed + 4;
  const int colors = layout.colors ? columns - fixed : 0;
  if (layout.colors && colors != 3 && colors != 4)
  {
    cursor.fail("a vertex has " + std::to_string(columns) + " numbers; " + std::to_string(fixed) +
      " and 3 or 4 for a color are expected");
  }
  mesh.points.resize(static_cast<std::size_t>(3 * count));
  std::vector<double> normals(layout.normals ? mesh.points.size() : 0);
  Colors vertexColors;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
  {
    cursor.skipToToken();
    for (std::size_t c = 0; c < 3; ++c)
    {
      mesh.points[3 * i + c] = cursor.coordinate("coordinate");
    }
    for (std::size_t c = 0; layout.normals && c < 3; ++c)
    {
      normals[3 * i + c] = cursor.coordinate("normal");
    }
    vertexColors.read(cursor, colors);
    cursor.expectLineEnd();
  }
  if (layout.normals)
  {
    mesh.pointArrays.push_back({ "Normals", 3, std::move(normals) });
  }
  if (layout.colors)
  {
    mesh.pointArrays.push_back(vertexColors.array(colors));
  }
}

/// The colors after the corners: none, or 3 or 4 numbers each.
struct FaceColors
{
  std::vector<int> components; ///< for each face
  Colors colors;
};

void readFaces(TextCursor& cursor, Index count, MeshFile& mesh, FaceColors& colors)
{
  const unsigned char types[] = { FileVertex, FileLine, FileTriangle, FileQuadrilateral };
  std::vector<Index> ids;
  for (Index i = 0; i < count; ++i)
  {
    if (!cursor.skipToToken())
    {
      cursor.fail("the file ends before face " + std::to_string(i));
    }
    const Index corners = cursor.integer("number of corners", 1, std::numeric_limits<Index>::max());
    cursor.expectRoom(corners, 2, "number of corners");
    ids.clear();
    for (Index c = 0; c < corners; ++c)
    {
      cursor.skipToToken(); // long faces may take several lines
      ids.push_back(cursor.integer("vertex", 0, mesh.numberOfPoints() - 1));
    }
    mesh.addCell(corners <= 4 ? types[corners - 1] : static_cast<unsigned char>(FilePolygon),
      ids.data(), corners);
    const int rest = cursor.tokensInLine();
    const int components =
      rest == 3 || rest == 4 ? rest : 0; // one number would be an entry of a color map
    colors.components.push_back(components);
    colors.colors.read(cursor, components);
    cursor.skipRestOfLine();
  }
}

/// One tuple per face from the tuples of the colored faces.
void addFaceColors(FaceColors& faces, MeshFile& mesh)
{
  const int width = faces.components.empty()
    ? 0
    : *std::max_element(faces.components.begin(), faces.components.end());
  if (width == 0)
  {
    return;
  }
  const bool fractions = faces.colors.fractions();
  const MeshArray read = faces.colors.array(1);
  MeshArray array = MeshArray::make("Color", width, fractions ? 'f' : 'u', 0);
  array.resize(faces.components.size() * static_cast<std::size_t>(width));
  std::size_t from = 0, to = 0;
  for (const int components : faces.components)
  {
    for (int c = 0; c < width; ++c)
    {
      const double full = fractions ? 1.0 : 255.0;
      const double missing = c == 3 ? full : fractions ? Grey / 255.0 : Grey;
      setValue(array, to++, c < components ? read.at(from++) : missing);
    }
  }
  mesh.cellArrays.push_back(std::move(array));
}
}

//------------------------------------------------------------------------------
MeshFile readOff(const std::string& name, bool lowerCells)
{
  const FileContent file(name);
  TextCursor cursor(file, '#');
  const Layout layout = readKeyword(cursor);
  cursor.skipToToken();
  const Index vertices = cursor.count("number of vertices", 6);
  const Index faces = cursor.count("number of faces", 4);
  if (!cursor.lineIsOver())
  {
    cursor.integer("number of edges");
  }
  cursor.expectLineEnd();
  MeshFile mesh;
  readVertices(cursor, layout, vertices, mesh);
  FaceColors colors;
  readFaces(cursor, faces, mesh, colors);
  cursor.expectFileEnd("face");
  addFaceColors(colors, mesh);
  if (!lowerCells)
  {
    mesh.keepHighestDimension();
  }
  return mesh;
}

namespace
{
bool isColor(const MeshArray* array)
{
  return array && (array->components == 3 || array->components == 4) && array->code() != 'i';
}

void writeColor(TextOutput& out, const MeshArray& array, std::size_t tuple)
{
  for (std::size_t c = 0; c < static_cast<std::size_t>(array.components); ++c)
  {
    const double value = array.at(tuple * static_cast<std::size_t>(array.components) + c);
    out << ' ' << value;
    out << (array.code() == 'f' && value == std::floor(value) ? ".0" : "");
  }
}
}

//------------------------------------------------------------------------------
std::vector<std::string> writeOff(const MeshFile& mesh, const std::string& name)
{
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    const unsigned char type = mesh.cellTypes[cell];
    const bool linear = cellDimension(type) < 3 &&
      (type == FilePolygon || (cellNodes(type) > 0 && cellNodes(type) <= 4)) && type != FileLine3;
    if (!linear)
    {
      throw FileError(name + ": OFF files cannot hold " + cellPlural(type) + " (cell " +
        std::to_string(cell) + "); run Extract Surface first, or write Gmsh's .msh");
    }
  }
  const MeshArray* colors = findArray(mesh.pointArrays, "Color");
  const MeshArray* faceColors = findArray(mesh.cellArrays, "Color");
  const MeshArray* normals = findArray(mesh.pointArrays, "Normals");
  colors = isColor(colors) ? colors : nullptr;
  normals = normals && normals->components == 3 ? normals : nullptr;
  TextOutput out(name);
  out << (colors ? "C" : "") << (normals ? "N" : "") << "OFF\n"
      << mesh.numberOfPoints() << ' ' << mesh.numberOfCells() << " 0";
  out.endLine();
  for (std::size_t i = 0; i < static_cast<std::size_t>(mesh.numberOfPoints()); ++i)
  {
    out << mesh.points[3 * i] << ' ' << mesh.points[3 * i + 1] << ' ' << mesh.points[3 * i + 2];
    for (std::size_t c = 0; normals && c < 3; ++c)
    {
      out << ' ' << normals->at(3 * i + c);
    }
    if (colors)
    {
      writeColor(out, *colors, i);
    }
    out.endLine();
  }
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    out << mesh.offsets[cell + 1] - mesh.offsets[cell];
    for (Index i = mesh.offsets[cell]; i < mesh.offsets[cell + 1]; ++i)
    {
      out << ' ' << mesh.connectivity[static_cast<std::size_t>(i)];
    }
    if (isColor(faceColors))
    {
      writeColor(out, *faceColors, cell);
    }
    out.endLine();
  }
  out.close();
  return { name };
}
}
