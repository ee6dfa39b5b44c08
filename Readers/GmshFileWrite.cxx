// SPDX-License-Identifier: BSD-3-Clause
#include "GmshFile.h"

#include "CellPlaces.h"
#include "TextOutput.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace tautline
{
namespace
{
/// A geometric entity: cells of one dimension with one physical tag.
struct WrittenEntity
{
  int dimension = 0;
  Index tag = 1;
  Index reference = 0;
  std::array<double, 3> low, high;
};

/// The entities of a mesh and the entity of each cell.
struct Entities
{
  std::vector<WrittenEntity> list; ///< by dimension, then tag
  std::vector<std::size_t> ofCell;
};

constexpr Index LargestTag = std::numeric_limits<int>::max();

Index wholeValue(const MeshArray* array, std::size_t i, Index otherwise)
{
  if (!array || array->components != 1)
  {
    return otherwise;
  }
  const double value = array->at(i);
  return value >= -static_cast<double>(LargestTag) && value <= static_cast<double>(LargestTag)
    ? static_cast<Index>(value)
    : otherwise;
}

void extend(WrittenEntity& entity, const MeshFile& mesh, std::size_t cell)
{
  for (Index i = mesh.offsets[cell]; i < mesh.offsets[cell + 1]; ++i)
  {
    const auto node = static_cast<std::size_t>(mesh.connectivity[static_cast<std::size_t>(i)]);
    for (std::size_t c = 0; c < 3; ++c)
    {
      entity.low[c] = std::min(entity.low[c], mesh.points[3 * node + c]);
      entity.high[c] = std::max(entity.high[c], mesh.points[3 * node + c]);
    }
  }
}

/// Each (dimension, Entity, Reference) is an entity; it keeps its tag unless the tag is already in
/// use.
Entities findEntities(const MeshFile& mesh)
{
  const MeshArray* tags = findArray(mesh.cellArrays, "Entity");
  const MeshArray* references = findArray(mesh.cellArrays, "Reference");
  references = references ? references : findArray(mesh.cellArrays, "BoundaryMarker");
  std::map<std::tuple<int, Index, Index>, std::size_t> known;
  std::set<std::pair<int, Index>> taken;
  Entities entities;
  constexpr double Far = std::numeric_limits<double>::max();
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    const Index reference = wholeValue(references, cell, 0);
    const Index preferred =
      std::max<Index>(1, wholeValue(tags, cell, std::max<Index>(1, reference)));
    const int dimension = cellDimension(mesh.cellTypes[cell]);
    const auto [entry, added] =
      known.insert({ { dimension, preferred, reference }, entities.list.size() });
    if (added)
    {
      Index tag = preferred;
      while (!taken.insert({ dimension, tag }).second)
      {
        tag = tag < LargestTag ? tag + 1 : 1;
      }
      entities.list.push_back(
        { dimension, tag, reference, { Far, Far, Far }, { -Far, -Far, -Far } });
    }
    entities.ofCell.push_back(entry->second);
    extend(entities.list[entry->second], mesh, cell);
  }
  if (entities.list.empty())
  {
    entities.list.push_back({ 0, 1, 0, { 0, 0, 0 }, { 0, 0, 0 } });
  }
  return entities;
}

/// Writes numbers as text with blanks between them, or as bytes.
class Record
{
public:
  Record(TextOutput& out, bool binary)
    : Out(out)
    , Binary(binary)
  {
  }
  Record& size(std::size_t value) { return this->put<std::uint64_t>(static_cast<Index>(value)); }
  Record& tag(Index value) { return this->put<std::int32_t>(value); }
  Record& real(double value)
  {
    if (this->Binary)
    {
      this->Out.binary(value);
      return *this;
    }
    this->Out << value << ' ';
    return *this;
  }
  void endLine()
  {
    if (!this->Binary)
    {
      this->Out.endLine();
    }
  }

private:
  template <class T>
  Record& put(Index value)
  {
    if (this->Binary)
    {
      this->Out.binary(static_cast<T>(value));
    }
    else
    {
      this->Out << value << ' ';
    }
    return *this;
  }
  TextOutput& Out;
  bool Binary;
};

void writeNames(TextOutput& out, const MeshFile& mesh)
{
  const MeshArray* groups = findArray(mesh.fieldArrays, "PhysicalGroups");
  const auto names = std::find_if(mesh.fieldStrings.begin(), mesh.fieldStrings.end(),
    [](const MeshStrings& s) { return s.name == "PhysicalNames"; });
  if (!groups || groups->components != 2 || names == mesh.fieldStrings.end() ||
    2 * names->values.size() != groups->size())
  {
    return;
  }
  out << "$PhysicalNames\n" << static_cast<Index>(names->values.size());
  out.endLine();
  for (std::size_t i = 0; i < names->values.size(); ++i)
  {
    out << static_cast<Index>(groups->at(2 * i)) << ' ' << static_cast<Index>(groups->at(2 * i + 1))
        << " \"" << names->values[i] << '"';
    out.endLine();
  }
  out << "$EndPhysicalNames\n";
}

void writeEntities(TextOutput& out, const Entities& entities, bool binary)
{
  Record record(out, binary);
  out << "$Entities\n";
  for (int dimension = 0; dimension < 4; ++dimension)
  {
    record.size(static_cast<std::size_t>(std::count_if(entities.list.begin(), entities.list.end(),
      [dimension](const WrittenEntity& e) { return e.dimension == dimension; })));
  }
  record.endLine();
  for (int dimension = 0; dimension < 4; ++dimension)
  {
    for (const WrittenEntity& entity : entities.list)
    {
      if (entity.dimension != dimension)
      {
        continue;
      }
      record.tag(entity.tag).real(entity.low[0]).real(entity.low[1]).real(entity.low[2]);
      if (dimension > 0)
      {
        record.real(entity.high[0]).real(entity.high[1]).real(entity.high[2]);
      }
      record.size(entity.reference != 0);
      if (entity.reference != 0)
      {
        record.tag(entity.reference);
      }
      if (dimension > 0)
      {
        record.size(0);
      }
      record.endLine();
    }
  }
  out << (binary ? "\n" : "") << "$EndEntities\n";
}

void writeNodes(TextOutput& out, const MeshFile& mesh, const WrittenEntity& entity, bool binary)
{
  Record record(out, binary);
  const auto count = static_cast<std::size_t>(mesh.numberOfPoints());
  out << "$Nodes\n";
  record.size(count > 0).size(count).size(count > 0).size(count).endLine();
  if (count > 0)
  {
    record.tag(entity.dimension).tag(entity.tag).tag(0).size(count).endLine();
  }
  for (std::size_t i = 1; i <= count; ++i)
  {
    record.size(i).endLine();
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    record.real(mesh.points[3 * i])
      .real(mesh.points[3 * i + 1])
      .real(mesh.points[3 * i + 2])
      .endLine();
  }
  out << (binary ? "\n" : "") << "$EndNodes\n";
}

Index nodesOf(const MeshFile& mesh, std::size_t cell)
{
  return mesh.offsets[cell + 1] - mesh.offsets[cell];
}

/// The ends of the runs of cells of one type and entity.
std::vector<std::size_t> findBlocks(const MeshFile& mesh, const Entities& entities)
{
  std::vector<std::size_t> ends;
  for (std::size_t cell = 1; cell <= mesh.cellTypes.size(); ++cell)
  {
    if (cell == mesh.cellTypes.size() || mesh.cellTypes[cell] != mesh.cellTypes[cell - 1] ||
      nodesOf(mesh, cell) != nodesOf(mesh, cell - 1) ||
      entities.ofCell[cell] != entities.ofCell[cell - 1])
    {
      ends.push_back(cell);
    }
  }
  return ends;
}

void writeElements(TextOutput& out, const MeshFile& mesh, const Entities& entities, bool binary)
{
  Record record(out, binary);
  const std::vector<std::size_t> ends = findBlocks(mesh, entities);
  const std::size_t count = mesh.cellTypes.size();
  out << "$Elements\n";
  record.size(ends.size()).size(count).size(count > 0).size(count).endLine();
  std::size_t cell = 0;
  for (const std::size_t end : ends)
  {
    const WrittenEntity& entity = entities.list[entities.ofCell[cell]];
    const GmshCell& gmsh = *gmshCellByType(mesh.cellTypes[cell], nodesOf(mesh, cell));
    record.tag(entity.dimension).tag(entity.tag).tag(gmsh.code).size(end - cell).endLine();
    std::array<int, MaxGmshNodes> place{}; // of VTK's node in Gmsh's order
    for (std::size_t i = 0; i < static_cast<std::size_t>(gmsh.nodes); ++i)
    {
      place[gmsh.order.empty() ? i : static_cast<std::size_t>(gmsh.order[i])] = static_cast<int>(i);
    }
    for (; cell < end; ++cell)
    {
      record.size(cell + 1);
      for (std::size_t i = 0; i < static_cast<std::size_t>(gmsh.nodes); ++i)
      {
        const auto at = static_cast<std::size_t>(mesh.offsets[cell] + place[i]);
        record.size(static_cast<std::size_t>(mesh.connectivity[at] + 1));
      }
      record.endLine();
    }
  }
  out << (binary ? "\n" : "") << "$EndElements\n";
}

void writeData(TextOutput& out, const MeshArray& array, const char* section, bool binary)
{
  const std::size_t count = array.size() / static_cast<std::size_t>(array.components);
  std::string name = array.name;
  std::replace(name.begin(), name.end(), '"', '\'');
  out << '$' << section << "\n1\n\"" << name << "\"\n1\n0\n3\n0\n"
      << array.components << '\n'
      << static_cast<Index>(count);
  out.endLine();
  Record record(out, binary);
  for (std::size_t tuple = 0; tuple < count; ++tuple)
  {
    record.tag(static_cast<Index>(tuple + 1));
    for (std::size_t c = 0; c < static_cast<std::size_t>(array.components); ++c)
    {
      record.real(array.at(tuple * static_cast<std::size_t>(array.components) + c));
    }
    record.endLine();
  }
  out << (binary ? "\n" : "") << "$End" << section << '\n';
}

void refuseUnknown(const MeshFile& mesh, const std::string& name)
{
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    const unsigned char type = mesh.cellTypes[cell];
    if (!gmshCellByType(type, nodesOf(mesh, cell)))
    {
      const bool curved = linearType(type) != type;
      throw FileError(name + ": Gmsh files cannot hold " + cellPlural(type) + " (cell " +
        std::to_string(cell) + ")" +
        (curved ? " of " + std::to_string(nodesOf(mesh, cell)) +
              " nodes: only cells of orders 1 to 4, the same along all axes, are supported; write "
              ".vtu"
                : std::string("; run Triangulate first")));
    }
  }
}
}

//------------------------------------------------------------------------------
std::vector<std::string> writeGmsh(const MeshFile& mesh, const std::string& name, bool binary)
{
  refuseUnknown(mesh, name);
  const Entities entities = findEntities(mesh);
  const auto largest = std::max_element(entities.list.begin(), entities.list.end(),
    [](const WrittenEntity& a, const WrittenEntity& b) { return a.dimension < b.dimension; });
  TextOutput out(name);
  out << "$MeshFormat\n4.1 " << (binary ? 1 : 0) << " 8\n";
  if (binary)
  {
    out.binary(std::int32_t{ 1 });
    out << '\n';
  }
  out << "$EndMeshFormat\n";
  writeNames(out, mesh);
  writeEntities(out, entities, binary);
  writeNodes(out, mesh, *largest, binary);
  writeElements(out, mesh, entities, binary);
  for (const MeshArray& array : mesh.pointArrays)
  {
    writeData(out, array, "NodeData", binary);
  }
  for (const MeshArray& array : mesh.cellArrays)
  {
    const bool inElements =
      (array.name == "Entity" || array.name == "Reference") && array.components == 1;
    if (!inElements)
    {
      writeData(out, array, "ElementData", binary);
    }
  }
  out.close();
  return { name };
}
}
