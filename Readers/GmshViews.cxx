// SPDX-License-Identifier: BSD-3-Clause
#include "CellPlaces.h"
#include "GmshFile.h"
#include "TextOutput.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tautline
{
namespace
{
/// The letter of an element in the name of its list, and the number of its corners.
struct ViewCell
{
  int dimension;
  std::size_t corners;
  char letter;
};
constexpr std::array<ViewCell, 8> ViewCells = { { { 0, 1, 'P' }, { 1, 2, 'L' }, { 2, 3, 'T' },
  { 2, 4, 'Q' }, { 3, 4, 'S' }, { 3, 8, 'H' }, { 3, 6, 'I' }, { 3, 5, 'Y' } } };

const ViewCell& viewCell(unsigned char type)
{
  const int dimension = cellDimension(type);
  const auto corners = static_cast<std::size_t>(cellNodes(type));
  return *std::find_if(ViewCells.begin(), ViewCells.end(),
    [=](const ViewCell& c) { return c.dimension == dimension && c.corners == corners; });
}

/// The part of an array in a view: all components, or one if Gmsh has no name for their number.
struct View
{
  const MeshArray& array;
  bool ofPoints;
  std::size_t first;
  std::size_t count;

  char letter() const { return this->count == 1 ? 'S' : this->count == 3 ? 'V' : 'T'; }
};

/// Adds an element with its values. If a value is not finite, which Gmsh cannot read, nothing is
/// added and the result is false.
bool writeElement(TextOutput& out, const MeshFile& mesh, const View& view, std::size_t cell)
{
  const unsigned char type = linearType(mesh.cellTypes[cell]);
  const ViewCell& form = viewCell(type);
  const Index size = mesh.offsets[cell + 1] - mesh.offsets[cell];
  const std::vector<int>& order = gmshCellByType(mesh.cellTypes[cell], size)->order;
  const auto stride = static_cast<std::size_t>(view.array.components);
  std::array<std::size_t, 8> nodes{};
  for (std::size_t i = 0; i < form.corners; ++i)
  {
    const auto place = static_cast<std::size_t>(mesh.offsets[cell]) +
      (order.empty() ? i : static_cast<std::size_t>(order[i]));
    nodes[i] = static_cast<std::size_t>(mesh.connectivity[place]);
    for (std::size_t c = 0; c < view.count; ++c)
    {
      if (!std::isfinite(
            view.array.at((view.ofPoints ? nodes[i] : cell) * stride + view.first + c)))
      {
        return false;
      }
    }
  }
  out << view.letter() << form.letter;
  for (std::size_t i = 0; i < 3 * form.corners; ++i)
  {
    out << (i == 0 ? '(' : ',') << mesh.points[3 * nodes[i / 3] + i % 3];
  }
  out << "){";
  for (std::size_t i = 0; i < view.count * form.corners; ++i)
  {
    const std::size_t tuple = view.ofPoints ? nodes[i / view.count] : cell;
    out << (i == 0 ? "" : ",");
    out << view.array.at(tuple * stride + view.first + i % view.count);
  }
  out << "};";
  out.endLine();
  return true;
}

void writeView(TextOutput& out, const MeshFile& mesh, const View& view, std::string name,
  std::vector<std::string>* warnings)
{
  std::replace(name.begin(), name.end(), '"', '\'');
  out << "View \"" << name << "\" {\n";
  const std::size_t cells = mesh.cellTypes.size();
  std::size_t omitted = 0, first = 0;
  for (std::size_t cell = 0; cell < cells; ++cell)
  {
    if (!writeElement(out, mesh, view, cell))
    {
      first = omitted == 0 ? cell : first;
      ++omitted;
    }
  }
  out << "};\n";
  if (omitted > 0 && warnings)
  {
    warnings->push_back("view \"" + name + "\": " + std::to_string(omitted) + " of " +
      std::to_string(cells) +
      " elements are left out, because Gmsh cannot read values that are not " +
      "finite (the first is cell " + std::to_string(first) + ")");
  }
}

void writeViews(TextOutput& out, const MeshFile& mesh, const MeshArray& array, bool ofPoints,
  std::vector<std::string>* warnings)
{
  constexpr std::size_t scalar = 1, vector = 3, tensor = 9;
  const auto components = static_cast<std::size_t>(array.components);
  if (components == scalar || components == vector || components == tensor)
  {
    writeView(out, mesh, { array, ofPoints, 0, components }, array.name, warnings);
    return;
  }
  for (std::size_t c = 0; c < components; ++c)
  {
    writeView(
      out, mesh, { array, ofPoints, c, scalar }, array.name + "_" + std::to_string(c), warnings);
  }
}
}

//------------------------------------------------------------------------------
std::vector<std::string> writeGmshViews(
  const MeshFile& mesh, const std::string& name, std::vector<std::string>* warnings)
{
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    if (!gmshCellByType(mesh.cellTypes[cell], mesh.offsets[cell + 1] - mesh.offsets[cell]))
    {
      throw FileError(name + ": Gmsh's views cannot hold " + cellPlural(mesh.cellTypes[cell]) +
        " (cell " + std::to_string(cell) + "); run Triangulate first");
    }
  }
  if (mesh.pointArrays.empty() && mesh.cellArrays.empty())
  {
    throw FileError(name +
      ": a .pos file holds arrays of numbers, and this mesh has none; measure it first, or write "
      ".msh");
  }
  TextOutput out(name);
  for (const MeshArray& array : mesh.pointArrays)
  {
    writeViews(out, mesh, array, true, warnings);
  }
  for (const MeshArray& array : mesh.cellArrays)
  {
    writeViews(out, mesh, array, false, warnings);
  }
  out.close();
  return { name };
}
}
