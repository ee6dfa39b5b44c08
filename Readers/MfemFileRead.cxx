// SPDX-License-Identifier: BSD-3-Clause
#include "MfemContents.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// Adds the points and cells of a mesh; finds nodes, and evaluates them.
class MfemBuilder
{
public:
  MfemBuilder(const MfemContents& contents, MeshFile& output)
    : Mesh(contents.mesh)
    , Space(contents.space)
    , Output(output)
    , Numbering(*contents.numbering)
    , Points(static_cast<std::size_t>(this->Numbering.numberOfNodes()), -1)
  {
    std::array<bool, MfemShapes> used{};
    for (const MfemElements* part : { &this->Mesh.elements, &this->Mesh.boundary })
    {
      for (const unsigned char geometry : part->geometries)
      {
        used[geometry] = true;
      }
    }
    for (int geometry = 0; geometry < MfemShapes; ++geometry)
    {
      if (used[static_cast<std::size_t>(geometry)])
      {
        this->prepare(geometry);
      }
    }
  }

  /// Makes the points from the values of the space, and the elements.
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
        mfemCellType(geometry, this->Space.order), cell.data(), static_cast<Index>(cell.size()));
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
        cursor.fail("boundary element " + std::to_string(element) + " is not a side of an element");
      }
      this->Output.addCell(
        mfemCellType(geometry, this->Space.order), cell.data(), static_cast<Index>(cell.size()));
    }
  }

  Index differentCopies() const { return this->Copies; }

private:
  static constexpr double RelativeTolerance = 1e-9; ///< relative to the size of the mesh
  static constexpr std::size_t ElementsPerPoll = 4096;

  /// Finds the positions of the nodes of VTK's cell in the lattice, and the evaluation of values.
  void prepare(int geometry)
  {
    const auto at = static_cast<std::size_t>(geometry);
    const MfemShape& shape = mfemShape(geometry);
    const int order = this->Space.order;
    const std::vector<LatticePoint> lattice = shape.lattice(order);
    const unsigned char type = mfemCellType(geometry, order);
    std::vector<Vec3> places;
    // A pyramid is of first order and has only its corners.
    for (const LatticePoint& place : shape.dimension == 0 || geometry == MfemPyramid
        ? shape.corners
        : cellPlaces(type, static_cast<Index>(lattice.size())))
    {
      const auto found = std::find(lattice.begin(), lattice.end(), place);
      this->Orders[at].push_back(static_cast<std::size_t>(found - lattice.begin()));
      places.push_back({ static_cast<double>(place[0]) / order,
        static_cast<double>(place[1]) / order, static_cast<double>(place[2]) / order });
    }
    if (shape.dimension > 1 && (geometry != MfemPyramid || !this->Space.continuous))
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

  /// The positions of VTK's nodes from the values of an element, in the order of the lattice.
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

  /// The point of a node at a position: the point from an earlier element, unless its position
  /// differs.
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
  const MfemNumbering& Numbering;
  std::vector<Index> Points;   ///< by node: its first point
  std::vector<Index> NextCopy; ///< by point: the next point of the same node
  Index Copies = 0;
  double Tolerance = 0.0;
  std::array<std::vector<double>, MfemShapes> Evaluations;
  std::array<std::vector<std::size_t>, MfemShapes> Orders; ///< lattice index, by VTK's node
  std::vector<Vec3> Scratch;
};
}

//------------------------------------------------------------------------------
MeshFile readMfem(const std::string& name, bool lowerCells)
{
  const FileContent file(name);
  TextCursor cursor(file, '#');
  MfemContents contents;
  readMfemContents(cursor, nullptr, contents);
  const MfemMesh& mesh = contents.mesh;
  MeshFile output;
  output.warnings = contents.warnings;
  MfemBuilder builder(contents, output);
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
      " additional points were created, as required for a periodic mesh.");
  }
  output.cellArrays.push_back({ "Reference", 1, std::move(references) });
  return output;
}
}
