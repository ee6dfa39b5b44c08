// SPDX-License-Identifier: BSD-3-Clause
#include "MfemContents.h"
#include "TextOutput.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tautline
{
namespace
{
constexpr double RelativeTolerance = 1e-9; ///< relative to the size of the mesh, as in the reader
constexpr double NoValue = std::numeric_limits<double>::quiet_NaN();

std::size_t toSize(Index i)
{
  return static_cast<std::size_t>(i);
}

Index cellSize(const MeshFile& mesh, std::size_t cell)
{
  return mesh.offsets[cell + 1] - mesh.offsets[cell];
}

Vec3 pointAt(const MeshFile& mesh, Index point)
{
  const double* x = mesh.points.data() + 3 * point;
  return { x[0], x[1], x[2] };
}

/// The values of a space on the cells of a mesh.
class MfemValues
{
public:
  explicit MfemValues(const MfemSpace& space)
    : Space(space)
  {
  }

  /// The values of an element, in the order of its shape's lattice.
  const std::vector<Vec3>& ofCell(const MeshFile& mesh, std::size_t cell)
  {
    const unsigned char type = mesh.cellTypes[cell];
    const Index nodes = cellSize(mesh, cell);
    auto [found, isNew] = this->Matrices.insert({ { type, nodes }, {} });
    if (isNew)
    {
      found->second = this->Space.interpolation(mfemShape(mfemGeometry(type)), type, nodes);
    }
    const std::vector<double>& matrix = found->second;
    const Index* ids = mesh.connectivity.data() + mesh.offsets[cell];
    this->Values.assign(matrix.size() / toSize(nodes), { 0.0, 0.0, 0.0 });
    for (std::size_t row = 0; row < this->Values.size(); ++row)
    {
      for (Index i = 0; i < nodes; ++i)
      {
        const double share = matrix[row * toSize(nodes) + toSize(i)];
        if (share != 0.0)
        {
          this->Values[row] += share * pointAt(mesh, ids[i]);
        }
      }
    }
    return this->Values;
  }

private:
  const MfemSpace& Space;
  std::map<std::pair<unsigned char, Index>, std::vector<double>> Matrices;
  std::vector<Vec3> Values;
};

/// Whether a cell has the same points in two meshes.
bool sameCell(const MeshFile& a, const MeshFile& b, std::size_t cell)
{
  return std::all_of(a.connectivity.begin() + a.offsets[cell],
    a.connectivity.begin() + a.offsets[cell + 1],
    [&](Index point)
    {
      return std::equal(&a.points[toSize(3 * point)], &a.points[toSize(3 * point)] + 3,
        &b.points[toSize(3 * point)]);
    });
}

/// The cells of a dimension as elements, whose vertices are the renumbered corners.
MfemElements elementsOf(const MeshFile& mesh, int dimension, std::vector<Index>& vertexOf,
  Index& vertices, std::vector<std::size_t>* cells)
{
  const MeshArray* references = findArray(mesh.cellArrays, "Reference");
  MfemElements elements;
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    const unsigned char type = mesh.cellTypes[cell];
    if (cellDimension(type) != dimension)
    {
      continue;
    }
    const int geometry = mfemGeometry(type);
    // The corners come first in VTK's cells, in the positions of MFEM's corners.
    const int order =
      type == FilePyramid || type == FileVertex ? 0 : cellOrder(type, cellSize(mesh, cell));
    const std::vector<LatticePoint> places =
      order > 0 ? cellPlaces(type, cellSize(mesh, cell)) : mfemShape(geometry).corners;
    for (LatticePoint corner : mfemShape(geometry).corners)
    {
      for (int& c : corner)
      {
        c *= std::max(order, 1);
      }
      const auto found = std::find(places.begin(), places.end(), corner);
      const Index point = mesh.connectivity[toSize(mesh.offsets[cell]) +
        static_cast<std::size_t>(found - places.begin())];
      Index& vertex = vertexOf[toSize(point)];
      vertex = vertex < 0 ? vertices++ : vertex;
      elements.vertices.push_back(vertex);
    }
    const double reference = references && references->components == 1 ? references->at(cell) : 1.0;
    const bool isAttribute = reference >= 1.0 && reference <= std::numeric_limits<int>::max();
    elements.attributes.push_back(isAttribute ? static_cast<Index>(reference) : 1);
    elements.geometries.push_back(static_cast<unsigned char>(geometry));
    elements.offsets.push_back(static_cast<Index>(elements.vertices.size()));
    if (cells)
    {
      cells->push_back(cell);
    }
  }
  return elements;
}

/// The largest order of the cells; throws for cells that MFEM does not have.
int findOrder(const MeshFile& mesh, const std::string& name)
{
  int largest = 1;
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    const unsigned char type = mesh.cellTypes[cell];
    const bool straight = type == FilePyramid || type == FileVertex;
    const int order = straight ? 1 : cellOrder(type, cellSize(mesh, cell));
    if (order == 0 || mfemGeometry(type) < 0)
    {
      throw FileError(name + ": MFEM's files cannot hold " + cellPlural(type) + " of " +
        std::to_string(cellSize(mesh, cell)) + " nodes (cell " + std::to_string(cell) +
        "): cells of orders 1 to " + std::to_string(MaxMfemOrder) +
        ", the same along all axes, are supported; write .vtu");
    }
    largest = std::max(largest, order);
  }
  const bool hasPyramids =
    std::find(mesh.cellTypes.begin(), mesh.cellTypes.end(), FilePyramid) != mesh.cellTypes.end();
  if (largest > 1 && hasPyramids)
  {
    throw FileError(
      name + ": MFEM's nodes of pyramids are not supported: triangulate the mesh, or write .vtu");
  }
  return largest;
}

void writeElements(TextOutput& out, const char* section, const MfemElements& elements)
{
  out << '\n' << section << '\n' << static_cast<Index>(elements.size());
  out.endLine();
  for (std::size_t e = 0; e < elements.size(); ++e)
  {
    out << elements.attributes[e] << ' ' << static_cast<int>(elements.geometries[e]);
    for (Index i = elements.offsets[e]; i < elements.offsets[e + 1]; ++i)
    {
      out << ' ' << elements.vertices[toSize(i)];
    }
    out.endLine();
  }
}

void writePoint(TextOutput& out, const Vec3& point, int dimension)
{
  for (int c = 0; c < dimension; ++c)
  {
    out << (c > 0 ? " " : "");
    out << point[static_cast<std::size_t>(c)];
  }
  out.endLine();
}

double sizeOf(const MeshFile& mesh)
{
  double low[3], high[3], size = 0.0;
  for (std::size_t c = 0; c < 3 && !mesh.points.empty(); ++c)
  {
    low[c] = high[c] = mesh.points[c];
    for (std::size_t i = c; i < mesh.points.size(); i += 3)
    {
      low[c] = std::min(low[c], mesh.points[i]);
      high[c] = std::max(high[c], mesh.points[i]);
    }
    size = std::max(size, high[c] - low[c]);
  }
  return size;
}

/// The values in H1: for each node the value on its first element, with which others must agree.
std::vector<Vec3> commonValues(const MeshFile& mesh, const std::vector<std::size_t>& cells,
  const MfemNumbering& numbering, const MfemSpace& space, const std::string& name)
{
  std::vector<Vec3> values(toSize(numbering.numberOfNodes()), { NoValue, NoValue, NoValue });
  const double tolerance = RelativeTolerance * sizeOf(mesh);
  MfemValues own(space);
  std::vector<Index> nodes;
  for (std::size_t element = 0; element < cells.size(); ++element)
  {
    pollInterruption(static_cast<Index>(element));
    numbering.nodesOf(element, nullptr, nodes);
    const std::vector<Vec3>& found = own.ofCell(mesh, cells[element]);
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      Vec3& value = values[toSize(nodes[i])];
      const Vec3 offset = found[i] - value;
      if (std::sqrt(dot(offset, offset)) > tolerance)
      {
        throw FileError(name + ": neighbors of cell " + std::to_string(cells[element]) +
          " have different points on the side between them: write L2 nodes");
      }
      value = std::isnan(value[0]) ? found[i] : value;
    }
  }
  return values;
}
}

//------------------------------------------------------------------------------
std::vector<std::string> writeMfem(const MeshFile& mesh, const std::string& name, bool continuous)
{
  const int order = findOrder(mesh, name);
  const int dimension = mesh.dimension();
  if (dimension < 2)
  {
    throw FileError(name + ": MFEM's meshes of lines are not supported");
  }
  const int spaceDimension = mesh.planar() ? 2 : 3;
  std::vector<Index> vertexOf(toSize(mesh.numberOfPoints()), -1);
  std::vector<std::size_t> cells;
  Index vertices = 0;
  const MfemElements elements = elementsOf(mesh, dimension, vertexOf, vertices, &cells);
  const MfemElements boundary = elementsOf(mesh, dimension - 1, vertexOf, vertices, nullptr);
  MfemSpace space;
  space.continuous = continuous;
  space.order = order;
  space.basis = MfemSpace::GaussLobatto;

  TextOutput out(name);
  out << "MFEM mesh v1.0\n\ndimension\n" << dimension << '\n';
  writeElements(out, "elements", elements);
  writeElements(out, "boundary", boundary);
  out << "\nvertices\n" << vertices << '\n';
  if (order == 1)
  {
    out << spaceDimension << '\n';
    std::vector<Index> pointOfVertex(toSize(vertices));
    for (std::size_t point = 0; point < vertexOf.size(); ++point)
    {
      if (vertexOf[point] >= 0)
      {
        pointOfVertex[toSize(vertexOf[point])] = static_cast<Index>(point);
      }
    }
    for (const Index point : pointOfVertex)
    {
      writePoint(out, pointAt(mesh, point), spaceDimension);
    }
    out.close();
    return { name };
  }
  out << "\nnodes\nFiniteElementSpace\nFiniteElementCollection: " << space.name(dimension)
      << "\nVDim: " << spaceDimension << "\nOrdering: 1\n\n";
  if (continuous)
  {
    const MfemNumbering numbering(vertices, elements, order);
    for (const Vec3& value : commonValues(mesh, cells, numbering, space, name))
    {
      writePoint(out, value, spaceDimension);
    }
  }
  else
  {
    MfemValues own(space);
    for (const std::size_t cell : cells)
    {
      for (const Vec3& value : own.ofCell(mesh, cell))
      {
        writePoint(out, value, spaceDimension);
      }
    }
  }
  out.close();
  return { name };
}

//------------------------------------------------------------------------------
std::vector<std::string> rewriteMfem(
  const MeshFile& mesh, const std::string& source, const std::string& name)
{
  const FileContent file(source);
  TextCursor cursor(file, '#');
  MfemContents contents;
  readMfemContents(cursor, file.begin(), contents);
  const std::size_t elements = contents.mesh.elements.size();
  const MeshFile before = readMfem(source, mesh.cellTypes.size() > elements);
  if (!contents.curved)
  {
    throw FileError(source + ": the file has no nodes whose coordinates could be replaced");
  }
  if (mesh.cellTypes != before.cellTypes || mesh.connectivity != before.connectivity ||
    mesh.points.size() != before.points.size())
  {
    throw FileError(name + ": the mesh has other cells or another number of points than " + source);
  }
  // New values for elements that have moved; values on unmoved neighbors do not change.
  const auto width = toSize(contents.mesh.spaceDimension);
  std::vector<Vec3> values(contents.mesh.coordinates.size() / width, { NoValue, NoValue, NoValue });
  std::vector<char> kept(values.size(), 0);
  MfemValues own(contents.space);
  std::vector<Index> nodes;
  Index first = 0;
  for (std::size_t element = 0; element < elements; ++element)
  {
    pollInterruption(static_cast<Index>(element));
    contents.numbering->nodesOf(element, nullptr, nodes);
    const bool moved = !sameCell(mesh, before, element);
    const std::vector<Vec3>* found = moved ? &own.ofCell(mesh, element) : nullptr;
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      const std::size_t place =
        toSize(contents.space.continuous ? nodes[i] : first + static_cast<Index>(i));
      kept[place] = kept[place] || !moved;
      values[place] = moved ? (*found)[i] : values[place];
    }
    first += static_cast<Index>(nodes.size());
  }
  std::map<std::size_t, std::size_t> inOrder; // position in the text: its coordinate
  for (std::size_t i = 0; i < contents.texts.size(); ++i)
  {
    if (!kept[i / width])
    {
      inOrder.emplace(contents.texts[i].first, i);
    }
  }
  TextOutput out(name);
  std::size_t done = 0;
  for (const auto& [begin, i] : inOrder)
  {
    out << std::string_view(file.begin() + done, begin - done);
    out << values[i / width][i % width];
    done = contents.texts[i].second;
    out.endRecord();
  }
  out << std::string_view(file.begin() + done, toSize(file.end() - file.begin()) - done);
  for (std::size_t point = 0; width < 3 && point < mesh.points.size(); point += 3)
  {
    if (mesh.points[point + 2] != 0.0)
    {
      throw FileError(name + ": point " + std::to_string(point / 3) +
        " leaves the plane of the file, which has no z coordinates");
    }
  }
  out.close();
  return { name };
}
}
