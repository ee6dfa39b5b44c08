// SPDX-License-Identifier: BSD-3-Clause
#include "GmshFile.h"

#include <limits>

namespace tautline
{
namespace
{
/// Since this version, blocks begin with the dimension and list all numbers before the points.
constexpr double NewBlocks = 4.1;

/// An unsigned number of 8 bytes, or text.
Index readSize(GmshInput& input, const char* what)
{
  if (!input.binary)
  {
    return input.integer(what, 0, LargestGmshNumber);
  }
  const auto value = input.cursor.binary<std::uint64_t>(what);
  if (value > static_cast<std::uint64_t>(LargestGmshNumber))
  {
    input.cursor.fail(std::string(what) + " is too large");
  }
  return static_cast<Index>(value);
}

/// A number of 4 bytes, or text.
Index readInt(GmshInput& input, const char* what, Index low, Index high)
{
  if (!input.binary)
  {
    return input.integer(what, low, high);
  }
  const Index value = input.cursor.binary<std::int32_t>(what);
  if (value < low || value > high)
  {
    input.cursor.fail(std::string(what) + " is " + std::to_string(value));
  }
  return value;
}

constexpr Index AnyLow = std::numeric_limits<int>::min();
constexpr Index AnyHigh = std::numeric_limits<int>::max();

/// The number of a node or element, which takes 8 bytes since version 4.1.
Index readNumber(GmshInput& input, const char* what)
{
  return input.version >= NewBlocks ? readSize(input, what) : readInt(input, what, 0, AnyHigh);
}

/// The entity of a block.
struct Entity
{
  Index dimension, tag;
};

Entity readEntity(GmshInput& input)
{
  Entity entity{};
  if (input.version >= NewBlocks)
  {
    entity.dimension = readInt(input, "dimension of an entity", 0, 3);
    entity.tag = readInt(input, "entity", AnyLow, AnyHigh);
  }
  else
  {
    entity.tag = readInt(input, "entity", AnyLow, AnyHigh);
    entity.dimension = readInt(input, "dimension of an entity", 0, 3);
  }
  return entity;
}

/// Reads the smallest and the largest number, which are not used.
void skipRange(GmshInput& input, const char* what)
{
  if (input.version >= NewBlocks)
  {
    readSize(input, what);
    readSize(input, what);
  }
}

double readReal(GmshInput& input, const char* what)
{
  if (input.binary)
  {
    return input.cursor.binary<double>(what);
  }
  input.cursor.skipToToken();
  return input.cursor.real(what);
}
}

//------------------------------------------------------------------------------
void readGmshEntities4(GmshInput& input, GmshPhysical& physical)
{
  Index counts[4];
  for (Index& count : counts)
  {
    count = readSize(input, "number of entities");
    input.cursor.expectRoom(count, input.binary ? 36 : 10, "number of entities");
  }
  for (int dimension = 0; dimension < 4; ++dimension)
  {
    for (Index i = 0; i < counts[dimension]; ++i)
    {
      const Index tag = readInt(input, "entity", AnyLow, AnyHigh);
      for (int c = 0; c < (dimension == 0 && input.version >= NewBlocks ? 3 : 6); ++c)
      {
        readReal(input, "bound of an entity");
      }
      const Index groups = readSize(input, "number of physical tags");
      input.cursor.expectRoom(groups, input.binary ? 4 : 2, "number of physical tags");
      for (Index g = 0; g < groups; ++g)
      {
        const Index group = readInt(input, "physical tag", AnyLow, AnyHigh);
        physical[static_cast<std::size_t>(dimension)].emplace(tag, group); // the first one stays
      }
      const Index bounding = dimension == 0 ? 0 : readSize(input, "number of bounding entities");
      input.cursor.expectRoom(bounding, input.binary ? 4 : 2, "number of bounding entities");
      for (Index b = 0; b < bounding; ++b)
      {
        readInt(input, "bounding entity", AnyLow, AnyHigh);
      }
    }
  }
}

//------------------------------------------------------------------------------
void readGmshNodes4(GmshInput& input)
{
  const Index blocks = readSize(input, "number of node blocks");
  const Index count = readSize(input, "number of nodes");
  skipRange(input, "range of node numbers");
  const bool together = input.version < NewBlocks; // each number before its point
  input.cursor.expectRoom(count, input.binary ? 28 : 8, "number of nodes");
  std::vector<Index> tags;
  reserveLarge(tags, static_cast<std::size_t>(count));
  reserveLarge(input.mesh.points, static_cast<std::size_t>(3 * count));
  for (Index block = 0; block < blocks; ++block)
  {
    const Index dimension = readEntity(input).dimension;
    const bool parametric = readInt(input, "parametric flag", 0, 1) == 1;
    const Index size = readSize(input, "nodes in a block");
    if (size > count - static_cast<Index>(tags.size()))
    {
      input.cursor.fail("the blocks have more nodes than the header of $Nodes announces (" +
        std::to_string(count) + ")");
    }
    for (Index i = 0; !together && i < size; ++i)
    {
      tags.push_back(readNumber(input, "node number"));
    }
    for (Index i = 0; i < size; ++i)
    {
      if (together)
      {
        tags.push_back(readNumber(input, "node number"));
      }
      for (int c = 0; c < 3; ++c)
      {
        input.mesh.points.push_back(input.coordinate("coordinate"));
      }
      for (Index c = 0; parametric && c < dimension; ++c)
      {
        readReal(input, "parameter");
      }
      input.cursor.countRecord();
    }
  }
  if (static_cast<Index>(tags.size()) != count)
  {
    input.cursor.fail("the blocks have " + std::to_string(tags.size()) +
      " nodes, the header of $Nodes announces " + std::to_string(count));
  }
  input.setNodes(std::move(tags));
}

//------------------------------------------------------------------------------
void readGmshElements4(GmshInput& input, const GmshPhysical& physical)
{
  const Index blocks = readSize(input, "number of element blocks");
  const Index count = readSize(input, "number of elements");
  skipRange(input, "range of element numbers");
  input.cursor.expectRoom(count, input.binary ? 8 : 4, "number of elements");
  input.reserveElements(static_cast<std::size_t>(count));
  for (Index block = 0; block < blocks; ++block)
  {
    const auto [dimension, entity] = readEntity(input);
    const Index code = readInt(input, "type of an element", AnyLow, AnyHigh);
    const Index size = readSize(input, "elements in a block");
    const GmshCell* cell = gmshCellByCode(code);
    if (!cell)
    {
      input.cursor.fail(gmshRefusal(code));
    }
    if (size > count - input.mesh.numberOfCells())
    {
      input.cursor.fail("the blocks have more elements than the header of $Elements announces (" +
        std::to_string(count) + ")");
    }
    const auto& groups = physical[static_cast<std::size_t>(dimension)];
    const auto group = groups.find(entity);
    const auto total = static_cast<std::size_t>(input.mesh.numberOfCells() + size);
    input.references.resize(total, group == groups.end() ? 0 : group->second);
    input.entities.resize(total, entity);
    for (Index i = 0; i < size; ++i)
    {
      const char* place = input.cursor.place();
      input.elementTags.push_back(readNumber(input, "element number"));
      Index nodes[MaxGmshNodes];
      for (int n = 0; n < cell->nodes; ++n)
      {
        nodes[n] = readNumber(input, "node");
      }
      input.addElement(*cell, nodes, place);
      input.cursor.countRecord();
    }
  }
  if (input.mesh.numberOfCells() != count)
  {
    input.cursor.fail("the blocks have " + std::to_string(input.mesh.numberOfCells()) +
      " elements, the header of $Elements announces " + std::to_string(count));
  }
}
}
