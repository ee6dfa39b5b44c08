// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFile.h"

#include "TextCursor.h"

#include <algorithm>
#include <array>

namespace tautline
{
namespace
{
struct CellFacts
{
  unsigned char type;
  int dimension;
  int nodes;
  const char* plural;
};

constexpr std::array<CellFacts, 25> Facts = { {
  { FileVertex, 0, 1, "vertices" },
  { FileLine, 1, 2, "lines" },
  { FileTriangle, 2, 3, "triangles" },
  { FilePolygon, 2, 0, "polygons" },
  { FileQuadrilateral, 2, 4, "quadrilaterals" },
  { FileTetrahedron, 3, 4, "tetrahedra" },
  { FileHexahedron, 3, 8, "hexahedra" },
  { FileWedge, 3, 6, "wedges" },
  { FilePyramid, 3, 5, "pyramids" },
  { FileLine3, 1, 3, "quadratic lines" },
  { FileTriangle6, 2, 6, "quadratic triangles" },
  { FileQuadrilateral8, 2, 8, "quadratic quadrilaterals" },
  { FileTetrahedron10, 3, 10, "quadratic tetrahedra" },
  { FileHexahedron20, 3, 20, "quadratic hexahedra" },
  { FileWedge15, 3, 15, "quadratic wedges" },
  { FilePyramid13, 3, 13, "quadratic pyramids" },
  { FileQuadrilateral9, 2, 9, "biquadratic quadrilaterals" },
  { FileHexahedron27, 3, 27, "triquadratic hexahedra" },
  { FileWedge18, 3, 18, "biquadratic wedges" },
  { FileLagrangeLine, 1, 0, "Lagrange lines" },
  { FileLagrangeTriangle, 2, 0, "Lagrange triangles" },
  { FileLagrangeQuadrilateral, 2, 0, "Lagrange quadrilaterals" },
  { FileLagrangeTetrahedron, 3, 0, "Lagrange tetrahedra" },
  { FileLagrangeHexahedron, 3, 0, "Lagrange hexahedra" },
  { FileLagrangeWedge, 3, 0, "Lagrange wedges" },
} };

constexpr CellFacts Unknown = { 0, -1, 0, "cells of another type" };

/// The properties of each type.
constexpr std::array<CellFacts, 256> makeTable()
{
  std::array<CellFacts, 256> table{};
  for (CellFacts& entry : table)
  {
    entry = Unknown;
  }
  for (const CellFacts& known : Facts)
  {
    table[known.type] = known;
  }
  return table;
}

constexpr std::array<CellFacts, 256> Table = makeTable();

const CellFacts& facts(unsigned char type)
{
  return Table[type];
}

/// Smallest and largest dimension of cells; -1 for both if there are none.
std::pair<int, int> dimensionRange(const std::vector<unsigned char>& types)
{
  std::array<bool, 256> present{};
  for (const unsigned char type : types)
  {
    present[type] = true;
  }
  int low = 3, high = -1;
  for (std::size_t type = 0; type < present.size(); ++type)
  {
    low = present[type] ? std::min(low, Table[type].dimension) : low;
    high = present[type] ? std::max(high, Table[type].dimension) : high;
  }
  return { std::min(low, high), high };
}

/// Keeps the tuples whose flag is set.
template <class Values>
void filterTuples(Values& values, int components, const std::vector<char>& keep)
{
  std::size_t to = 0;
  for (std::size_t tuple = 0; tuple < keep.size(); ++tuple)
  {
    for (int c = 0; c < components && keep[tuple]; ++c)
    {
      values[to++] = values[tuple * components + c];
    }
  }
  values.resize(to);
}
}

//------------------------------------------------------------------------------
int cellDimension(unsigned char type)
{
  return facts(type).dimension;
}

//------------------------------------------------------------------------------
int cellNodes(unsigned char type)
{
  return facts(type).nodes;
}

//------------------------------------------------------------------------------
const char* cellPlural(unsigned char type)
{
  return facts(type).plural;
}

//------------------------------------------------------------------------------
std::size_t MeshArray::size() const
{
  return std::visit([](const auto& v) { return v.size(); }, this->values);
}

//------------------------------------------------------------------------------
double MeshArray::at(std::size_t i) const
{
  return std::visit([i](const auto& v) { return static_cast<double>(v[i]); }, this->values);
}

//------------------------------------------------------------------------------
void MeshArray::resize(std::size_t count)
{
  std::visit([count](auto& v) { v.resize(count); }, this->values);
}

//------------------------------------------------------------------------------
char MeshArray::code() const
{
  return "fiu"[this->values.index()];
}

//------------------------------------------------------------------------------
MeshArray MeshArray::make(std::string name, int components, char code, std::size_t size)
{
  MeshArray array{ std::move(name), components, {} };
  if (code == 'i')
  {
    array.values = Integers(size);
  }
  else if (code == 'u')
  {
    array.values = Bytes(size);
  }
  else
  {
    array.values = Doubles(size);
  }
  return array;
}

//------------------------------------------------------------------------------
int MeshFile::dimension() const
{
  return dimensionRange(this->cellTypes).second;
}

//------------------------------------------------------------------------------
bool MeshFile::planar() const
{
  for (std::size_t z = 2; z < this->points.size(); z += 3)
  {
    if (this->points[z] != 0.0)
    {
      return false;
    }
  }
  return this->dimension() < 3;
}

//------------------------------------------------------------------------------
void MeshFile::keepHighestDimension()
{
  const auto [smallest, largest] = dimensionRange(this->cellTypes);
  if (smallest == largest)
  {
    return;
  }
  std::vector<char> keep(this->cellTypes.size());
  for (std::size_t cell = 0; cell < keep.size(); ++cell)
  {
    keep[cell] = cellDimension(this->cellTypes[cell]) == largest;
  }
  std::vector<Index> ends = { 0 };
  std::size_t to = 0;
  for (std::size_t cell = 0; cell < keep.size(); ++cell)
  {
    for (Index i = this->offsets[cell]; keep[cell] && i < this->offsets[cell + 1]; ++i)
    {
      this->connectivity[to++] = this->connectivity[i];
    }
    if (keep[cell])
    {
      ends.push_back(static_cast<Index>(to));
    }
  }
  this->offsets = std::move(ends);
  this->connectivity.resize(to);
  filterTuples(this->cellTypes, 1, keep);
  for (MeshArray& array : this->cellArrays)
  {
    std::visit([&](auto& v) { filterTuples(v, array.components, keep); }, array.values);
  }
}

//------------------------------------------------------------------------------
void MeshFile::addCells(unsigned char type, std::vector<Index> nodes)
{
  const std::size_t size = static_cast<std::size_t>(cellNodes(type));
  const std::size_t count = nodes.size() / size;
  const Index start = this->offsets.back();
  this->cellTypes.resize(this->cellTypes.size() + count, type);
  const std::size_t old = this->offsets.size();
  resizeLarge(this->offsets, old + count);
  for (std::size_t i = 0; i < count; ++i)
  {
    this->offsets[old + i] = start + static_cast<Index>((i + 1) * size);
  }
  if (this->connectivity.empty())
  {
    this->connectivity = std::move(nodes);
    return;
  }
  // Not insert(): GCC 14 warns of an overflow that cannot occur.
  const std::size_t first = this->connectivity.size();
  this->connectivity.resize(first + nodes.size());
  std::copy(nodes.begin(), nodes.end(), this->connectivity.data() + first);
}

//------------------------------------------------------------------------------
void MeshFile::addCell(unsigned char type, const Index* nodes, Index count)
{
  this->cellTypes.push_back(type);
  this->connectivity.insert(this->connectivity.end(), nodes, nodes + count);
  this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
}

//------------------------------------------------------------------------------
const MeshArray* findArray(const std::vector<MeshArray>& arrays, const std::string& name)
{
  const auto found = std::find_if(
    arrays.begin(), arrays.end(), [&](const MeshArray& array) { return array.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}
}
