// SPDX-License-Identifier: BSD-3-Clause
#include "GmshFile.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
constexpr Index UnknownDimension = -1; // of a physical group

/// Moves past the line that ends a section.
void expectEnd(TextCursor& cursor, const std::string& section)
{
  const bool old = section == "NOD" || section == "ELM"; // of version 1
  const std::string end = (old ? "$END" : "$End") + section;
  if (!cursor.skipToToken() || cursor.word() != end)
  {
    cursor.fail("expected " + end + " (is the count of the section right?)");
  }
}

/// Dimension and tag of the entity of a node, and its coordinates on a curve or a surface.
void skipParameters(GmshInput& input)
{
  const auto next = [&](const char* what, Index low, Index high)
  {
    return input.binary ? Index{ input.cursor.binary<std::int32_t>(what) }
                        : input.integer(what, low, high);
  };
  const Index dimension = next("dimension of the entity of a node", 0, 3);
  next("tag of an entity", -LargestGmshNumber, LargestGmshNumber);
  for (Index i = 0; i < dimension && dimension < 3; ++i)
  {
    input.coordinate("parametric coordinate");
  }
}

/// Skips a section that is not used.
void skipSection(TextCursor& cursor, const std::string& section)
{
  const std::string end = "$End" + section;
  const std::string_view rest(cursor.place(), cursor.bytesLeft());
  const std::size_t found = rest.find("\n" + end);
  if (found == rest.npos)
  {
    cursor.fail("no " + end);
  }
  cursor.moveTo(cursor.place() + found + 1 + end.size());
}

/// Moves to the byte after the end of this line, where binary data begin.
void finishLine(TextCursor& cursor)
{
  cursor.skipRestOfLine();
  if (!cursor.atEnd())
  {
    cursor.moveTo(cursor.place() + 1);
  }
}

double readFormat(GmshInput& input)
{
  TextCursor& cursor = input.cursor;
  cursor.skipToToken();
  const double version = cursor.real("version");
  const Index type = cursor.integer("file type", 0, 1);
  const Index size = cursor.integer("size of numbers", 4, 8);
  constexpr double known[] = { 2.0, 2.1, 2.2, 4.0, 4.1 };
  if (std::find(std::begin(known), std::end(known), version) == std::end(known))
  {
    cursor.fail("version " + std::to_string(version).substr(0, 4) +
      " of the format cannot be read; 1, 2, 4.0 and 4.1 can: gmsh -save -format msh41 FILE");
  }
  if (type == 1 && size != 8)
  {
    cursor.fail("numbers of " + std::to_string(size) + " bytes; 8 are expected");
  }
  input.binary = type == 1;
  finishLine(cursor);
  if (input.binary)
  {
    const auto one = cursor.binary<std::int32_t>("the byte order");
    cursor.setSwap(one != 1);
  }
  expectEnd(cursor, "MeshFormat");
  return version;
}

void readPhysicalNames(GmshInput& input)
{
  TextCursor& cursor = input.cursor;
  cursor.skipToToken();
  MeshArray groups{ "PhysicalGroups", 2, MeshArray::Integers() };
  MeshStrings names{ "PhysicalNames", {} };
  for (Index count = cursor.count("number of names", 7); count > 0; --count)
  {
    cursor.skipToToken();
    auto& numbers = std::get<MeshArray::Integers>(groups.values);
    const char* place = cursor.place();
    const Index first = cursor.integer("dimension or physical tag");
    cursor.skipBlanks();
    const bool onlyTag = *cursor.place() == '"'; // as in old files
    if (!onlyTag && (first < 0 || first > 3))
    {
      cursor.failAt(place, "dimension is " + std::to_string(first) + ", 0 to 3 is allowed");
    }
    numbers.push_back(onlyTag ? UnknownDimension : first);
    numbers.push_back(onlyTag ? first : cursor.integer("physical tag"));
    names.values.push_back(cursor.quoted("name of a group"));
  }
  expectEnd(cursor, "PhysicalNames");
  input.mesh.fieldArrays.push_back(std::move(groups));
  input.mesh.fieldStrings.push_back(std::move(names));
}

/// $NodeData or $ElementData.
void readData(GmshInput& input, bool points)
{
  TextCursor& cursor = input.cursor;
  cursor.skipToToken();
  std::string name;
  const Index strings = cursor.integer("number of strings", 0, 100);
  for (Index i = 0; i < strings; ++i)
  {
    cursor.skipToToken();
    const std::string text = cursor.quoted("string");
    name = i == 0 ? text : name;
  }
  for (Index reals = input.cursor.skipToToken() ? cursor.integer("number of reals", 0, 100) : 0;
       reals > 0; --reals)
  {
    cursor.skipToToken();
    cursor.real("real tag");
  }
  cursor.skipToToken();
  std::vector<Index> tags(static_cast<std::size_t>(cursor.integer("number of integers", 3, 100)));
  for (Index& tag : tags)
  {
    cursor.skipToToken();
    tag = cursor.integer("integer tag");
  }
  const char* place = cursor.place();
  const Index components = tags[1], count = tags[2];
  if (components < 1 || components > 1000)
  {
    cursor.failAt(place, "data with " + std::to_string(components) + " components");
  }
  finishLine(cursor);
  cursor.expectRoom(count,
    input.binary ? static_cast<std::size_t>(4 + 8 * components)
                 : static_cast<std::size_t>(2 + 2 * components),
    "number of values");
  GmshTags elements;
  if (!points)
  {
    elements.assign(input.elementTags);
  }
  const GmshTags& known = points ? input.nodes : elements;
  const Index tuples = points ? input.mesh.numberOfPoints() : input.mesh.numberOfCells();
  const auto size = static_cast<std::size_t>(tuples * components);
  if (sizeof(double) * size > input.dataBudget)
  {
    cursor.failAt(place, "the arrays of this file would be far larger than the file");
  }
  input.dataBudget -= sizeof(double) * size;
  MeshArray array{ name.empty() ? "Data" : name, static_cast<int>(components),
    MeshArray::Doubles(size, std::numeric_limits<double>::quiet_NaN()) };
  auto& values = std::get<MeshArray::Doubles>(array.values);
  for (Index i = 0; i < count; ++i)
  {
    place = cursor.place();
    const Index tag = input.binary ? cursor.binary<std::int32_t>("a node or element number")
                                   : input.integer("node or element number", 0, LargestGmshNumber);
    const Index at = known.find(tag);
    if (at < 0)
    {
      cursor.failAt(place,
        "data of the unknown " + std::string(points ? "node " : "element ") + std::to_string(tag));
    }
    for (Index c = 0; c < components; ++c)
    {
      values[static_cast<std::size_t>(at * components + c)] =
        input.binary ? cursor.binary<double>("a value") : cursor.real("value");
    }
  }
  expectEnd(cursor, points ? "NodeData" : "ElementData");
  std::vector<MeshArray>& arrays = points ? input.mesh.pointArrays : input.mesh.cellArrays;
  arrays.erase(std::remove_if(arrays.begin(), arrays.end(),
                 [&](const MeshArray& other) { return other.name == array.name; }),
    arrays.end());
  arrays.push_back(std::move(array));
}

/// Sets missing dimensions of physical groups to the dimensions of their elements.
void findDimensions(GmshInput& input)
{
  const auto groups = std::find_if(input.mesh.fieldArrays.begin(), input.mesh.fieldArrays.end(),
    [](const MeshArray& array) { return array.name == "PhysicalGroups"; });
  if (groups == input.mesh.fieldArrays.end())
  {
    return;
  }
  auto& numbers = std::get<MeshArray::Integers>(groups->values);
  for (std::size_t i = 0; i < numbers.size(); i += 2)
  {
    for (std::size_t c = 0; numbers[i] == UnknownDimension && c < input.references.size(); ++c)
    {
      if (input.references[c] == numbers[i + 1])
      {
        numbers[i] = cellDimension(input.mesh.cellTypes[c]);
      }
    }
    numbers[i] = numbers[i] == UnknownDimension ? 3 : numbers[i];
  }
}

MeshFile finish(GmshInput& input)
{
  findDimensions(input);
  if (input.basesLeftOut > 0)
  {
    input.mesh.warnings.push_back("VTK's quadratic pyramids have no node in their base: in " +
      std::to_string(input.basesLeftOut) + " pyramids of 14 nodes it is left out.");
  }
  MeshFile mesh = std::move(input.mesh);
  if (!input.references.empty())
  {
    mesh.cellArrays.insert(mesh.cellArrays.begin(), { "Entity", 1, std::move(input.entities) });
    mesh.cellArrays.insert(
      mesh.cellArrays.begin(), { "Reference", 1, std::move(input.references) });
  }
  return mesh;
}

void readSections(GmshInput& input)
{
  TextCursor& cursor = input.cursor;
  double& version = input.version;
  bool nodes = false, elements = false;
  GmshPhysical physical(4);
  while (cursor.skipToToken())
  {
    const char* place = cursor.place();
    const std::string word(cursor.word());
    if (word.size() < 2 || word[0] != '$')
    {
      cursor.failAt(place, "expected a section such as $Nodes, found '" + word.substr(0, 20) + "'");
    }
    const std::string section = word.substr(1);
    if (version == 0.0 && section == "NOD")
    {
      version = 1.0;
    }
    if (version == 0.0 && section != "MeshFormat")
    {
      cursor.failAt(place, "expected $MeshFormat, found '" + word.substr(0, 20) + "'");
    }
    finishLine(cursor);
    if (section == "MeshFormat")
    {
      version = readFormat(input);
    }
    else if (section == "PhysicalNames")
    {
      readPhysicalNames(input);
    }
    else if (section == "Entities" && version >= 4.0)
    {
      readGmshEntities4(input, physical);
      expectEnd(cursor, section);
    }
    else if ((section == "Nodes" || (section == "NOD" && version == 1.0) ||
               (section == "ParametricNodes" && version < 4.0)) &&
      !nodes)
    {
      version >= 4.0 ? readGmshNodes4(input) : readGmshNodes2(input, section == "ParametricNodes");
      expectEnd(cursor, section);
      nodes = true;
    }
    else if (section == "ELM" && version == 1.0 && !elements)
    {
      readGmshElements1(input);
      expectEnd(cursor, section);
      elements = true;
    }
    else if (section == "Elements" && !elements)
    {
      version >= 4.0 ? readGmshElements4(input, physical) : readGmshElements2(input);
      expectEnd(cursor, section);
      elements = true;
    }
    else if (section == "NodeData" || section == "ElementData")
    {
      if (!(section == "NodeData" ? nodes : elements))
      {
        cursor.failAt(place,
          word + " comes before $" + section.substr(0, section.size() - 4) +
            "s: move it after that section");
      }
      readData(input, section == "NodeData");
    }
    else if (section == "Nodes" || section == "ParametricNodes" || section == "Elements")
    {
      cursor.failAt(place, "a second section " + word);
    }
    else
    {
      skipSection(cursor, section);
    }
  }
  if (!nodes)
  {
    cursor.fail("the file ends without $Nodes");
  }
}
}

//------------------------------------------------------------------------------
Index GmshInput::integer(const char* what, Index low, Index high)
{
  this->cursor.skipToToken();
  return this->cursor.integer(what, low, high);
}

//------------------------------------------------------------------------------
double GmshInput::coordinate(const char* what)
{
  if (!this->binary)
  {
    this->cursor.skipToToken();
    return this->cursor.coordinate(what);
  }
  const auto value = this->cursor.binary<double>(what);
  if (!std::isfinite(value))
  {
    this->cursor.fail(std::string(what) + " is not a finite number");
  }
  return value;
}

//------------------------------------------------------------------------------
void readGmshNodes2(GmshInput& input, bool parametric)
{
  TextCursor& cursor = input.cursor;
  const Index count = input.integer("number of nodes", 0, LargestGmshNumber);
  finishLine(cursor);
  cursor.expectRoom(count, input.binary ? 28 : 8, "number of nodes");
  std::vector<Index> tags(static_cast<std::size_t>(count));
  input.mesh.points.resize(static_cast<std::size_t>(3 * count));
  for (std::size_t i = 0; i < tags.size(); ++i)
  {
    tags[i] = input.binary ? cursor.binary<std::int32_t>("a node number")
                           : input.integer("node number", 0, LargestGmshNumber);
    for (std::size_t c = 0; c < 3; ++c)
    {
      input.mesh.points[3 * i + c] = input.coordinate("coordinate");
    }
    if (parametric)
    {
      skipParameters(input);
    }
    cursor.countRecord();
  }
  input.setNodes(std::move(tags));
}

//------------------------------------------------------------------------------
void readGmshElements2(GmshInput& input)
{
  TextCursor& cursor = input.cursor;
  const Index count = input.integer("number of elements", 0, LargestGmshNumber);
  finishLine(cursor);
  cursor.expectRoom(count, input.binary ? 8 : 6, "number of elements");
  const auto next = [&](const char* what) -> Index
  { return input.binary ? cursor.binary<std::int32_t>(what) : cursor.integer(what); };
  input.reserveElements(static_cast<std::size_t>(count));
  Index inBlock = 0, code = 0, tags = 0;
  for (Index i = 0; i < count; ++i)
  {
    if (!input.binary)
    {
      cursor.skipToToken();
    }
    const char* place = cursor.place();
    Index number = input.binary ? 0 : next("element number");
    if (!input.binary || inBlock == 0)
    {
      code = next("type of an element");
      inBlock = input.binary ? next("number of elements in a block") : 1;
      tags = next("number of tags");
    }
    const GmshCell* cell = gmshCellByCode(code);
    if (!cell)
    {
      cursor.failAt(place, gmshRefusal(code));
    }
    if (inBlock < 1 || tags < 0 || tags > 1000)
    {
      cursor.failAt(place,
        "a block of " + std::to_string(inBlock) + " elements with " + std::to_string(tags) +
          " tags cannot be read");
    }
    number = input.binary ? next("element number") : number;
    Index reference = 0, entity = 0;
    for (Index t = 0; t < tags; ++t)
    {
      const Index tag = next("tag");
      reference = t == 0 ? tag : reference;
      entity = t == 1 ? tag : entity;
    }
    Index nodes[MaxGmshNodes];
    for (int n = 0; n < cell->nodes; ++n)
    {
      nodes[n] = next("node");
    }
    input.addElement(*cell, nodes, place);
    input.elementTags.push_back(number);
    input.references.push_back(reference);
    input.entities.push_back(entity);
    --inBlock;
    if (!input.binary)
    {
      cursor.expectLineEnd();
    }
  }
}

//------------------------------------------------------------------------------
void readGmshElements1(GmshInput& input)
{
  TextCursor& cursor = input.cursor;
  const Index count = input.integer("number of elements", 0, LargestGmshNumber);
  finishLine(cursor);
  cursor.expectRoom(count, 12, "number of elements");
  input.reserveElements(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i)
  {
    cursor.skipToToken();
    const char* place = cursor.place();
    input.elementTags.push_back(cursor.integer("element number"));
    const Index code = cursor.integer("type of an element");
    input.references.push_back(cursor.integer("physical tag"));
    input.entities.push_back(cursor.integer("entity"));
    const Index size = cursor.integer("number of nodes");
    const GmshCell* cell = gmshCellByCode(code);
    if (!cell)
    {
      cursor.failAt(place, gmshRefusal(code));
    }
    if (size != cell->nodes)
    {
      cursor.failAt(place,
        "an element of type " + std::to_string(code) + " with " + std::to_string(size) +
          " nodes, " + std::to_string(cell->nodes) + " are expected");
    }
    Index nodes[MaxGmshNodes];
    for (int n = 0; n < cell->nodes; ++n)
    {
      nodes[n] = cursor.integer("node");
    }
    input.addElement(*cell, nodes, place);
    cursor.expectLineEnd();
  }
}

//------------------------------------------------------------------------------
MeshFile readGmsh(const std::string& name, bool lowerCells)
{
  const FileContent file(name);
  // values for only a few nodes make arrays larger than the file, but no reasonable file makes them
  // huge
  const std::size_t budget = 1048576 + 64 * static_cast<std::size_t>(file.end() - file.begin());
  GmshInput input{ TextCursor(file), false, {}, {}, {}, {}, {}, budget, 0.0, 0 };
  if (!input.cursor.skipToToken())
  {
    input.cursor.fail("the file is empty");
  }
  MeshFile mesh;
  if (*input.cursor.place() == '$')
  {
    readSections(input);
    mesh = finish(input);
  }
  else
  {
    mesh = readFreeFem(file);
  }
  if (!lowerCells)
  {
    mesh.keepHighestDimension();
  }
  return mesh;
}
}
