// SPDX-License-Identifier: BSD-3-Clause
#include "TetGenFile.h"

#include "FileNames.h"
#include "FileRanges.h"
#include "FileSet.h"
#include "PartExchange.h"
#include "TetGenRecords.h"

#include <numeric>

namespace tautline
{
using namespace tetgen;

namespace
{
/// One of the files of a set, as the ranks read it: the header by all, then ranges.
class SharedFile
{
public:
  SharedFile(const FileRanges& ranges, const std::string& name, SetCheck& set)
    : Ranges(ranges)
    , Name(name)
    , Head(ranges.head(name))
    , HeadCursor(this->Head, Comment)
  {
    const FileContent tail = ranges.tail(name);
    ranges.together([&] { set.add(tail); });
  }

  /// What `read` finds with a cursor at the begin of the file. There must be records: nothing is
  /// gained by dividing none.
  template <class Header, class Read>
  Header readHeader(const Read& read, Index Header::*base)
  {
    return this->Ranges.agreed(
      [&]
      {
        Header header = read(this->HeadCursor);
        header.*base = peekBase(this->HeadCursor, "number of the first record");
        return header;
      });
  }

  /// Calls read(cursor, file, first, count) for the own ones of the records after the header, of so
  /// many columns each.
  template <class Read>
  void records(Index count, Index columns, const Read& read)
  {
    const Index begin = this->HeadCursor.place() - this->Head.begin();
    const Index end = this->Ranges.agreed([&] { return fileSize(this->Name); });
    const LineShare lines = this->Ranges.lines(this->Name, begin, end, Comment, count);
    this->Ranges.together(
      [&]
      {
        expectColumns(this->Name, lines, columns);
        TextCursor cursor(lines.text, Comment);
        read(cursor, this->Head, lines.first, lines.count);
      });
  }

private:
  const FileRanges& Ranges;
  std::string Name;
  FileContent Head;
  TextCursor HeadCursor;
};

NodeList shareNodes(
  const FileRanges& ranges, const std::string& name, SetCheck& set, MeshFile& mesh)
{
  SharedFile file(ranges, name, set);
  const auto nodes = file.readHeader(
    [](TextCursor& cursor) { return NodeList{ readNodeHeader(cursor) }; }, &NodeList::base);
  const NodeHeader& header = nodes.header;
  file.records(header.count, 1 + header.dimension + header.attributes + header.markers,
    [&](TextCursor& cursor, const FileContent& head, Index first, Index count)
    {
      readNodeRecords(cursor, head, nodes, first, count, mesh);
      cursor.expectFileEnd("vertex");
    });
  return nodes;
}

/// @return the type of the elements
unsigned char shareElements(const FileRanges& ranges, const std::string& name, SetCheck& set,
  const NodeList& nodes, MeshFile& mesh)
{
  SharedFile file(ranges, name, set);
  const auto header =
    file.readHeader([&](TextCursor& cursor) { return readElementHeader(cursor, nodes.header); },
      &ElementHeader::base);
  file.records(header.count, 1 + header.nodes + header.attributes,
    [&](TextCursor& cursor, const FileContent& head, Index first, Index count)
    { readElementRecords(cursor, head, header, nodes, first, count, mesh); });
  makeIntegral(mesh.cellArrays, &ranges);
  return header.type;
}

/// @return the type of the faces or edges
unsigned char shareBoundary(const FileRanges& ranges, const std::string& name, SetCheck& set,
  const NodeList& nodes, bool faces, bool quadraticMesh, MeshFile& mesh)
{
  SharedFile file(ranges, name, set);
  const auto header = file.readHeader([&](TextCursor& cursor)
    { return readBoundaryHeader(cursor, faces, quadraticMesh); },
    &BoundaryHeader::base);
  file.records(header.count, 1 + header.nodes() + header.markers,
    [&](TextCursor& cursor, const FileContent&, Index first, Index count)
    { readBoundaryRecords(cursor, header, nodes, first, count, mesh); });
  return header.type;
}
}

//------------------------------------------------------------------------------
MeshShare shareTetGen(const FileRanges& ranges, const std::string& name, bool lowerCells)
{
  const auto [stem, extension] = splitExtension(name);
  ranges.require(extension == "node" || extension == "ele" || extension == "face" ||
    extension == "edge"); // others are lists of facets, which are read whole
  const std::string names[] = { stem + ".node", stem + ".ele", stem + ".face", stem + ".edge" };
  const bool elements = ranges.exists(names[1]);
  const bool withLower = lowerCells || !elements;
  const bool faces = ranges.exists(names[2]) && withLower;
  const bool edges = ranges.exists(names[3]) && withLower;
  ranges.require((elements || extension != "ele") && (faces || !withLower || extension != "face") &&
    (edges || !withLower || extension != "edge"));
  std::vector<std::string> set = { names[0] };
  const bool read[] = { elements, faces, edges };
  for (std::size_t i = 0; i < std::size(read); ++i)
  {
    if (read[i])
    {
      set.push_back(names[i + 1]);
    }
  }
  ranges.expectLarge(set);

  MeshShare share;
  MeshFile& mesh = share.mesh;
  SetCheck check;
  const NodeList nodes = shareNodes(ranges, names[0], check, mesh);
  bool quadratic = false;
  const auto endSection = [&]
  {
    const Index before =
      std::accumulate(share.sectionCells.begin(), share.sectionCells.end(), Index(0));
    share.sectionCells.push_back(mesh.numberOfCells() - before);
  };
  if (elements)
  {
    quadratic = cellNodes(shareElements(ranges, names[1], check, nodes, mesh)) > 4;
    endSection();
  }
  if (faces)
  {
    const unsigned char type = shareBoundary(ranges, names[2], check, nodes, true, quadratic, mesh);
    quadratic = quadratic || (!elements && cellNodes(type) > 4);
    endSection();
  }
  if (edges)
  {
    shareBoundary(ranges, names[3], check, nodes, false, quadratic, mesh);
    endSection();
  }
  if (!elements && !faces && !edges)
  {
    const std::vector<Index> begins = rankBegins(ranges.group(), mesh.numberOfPoints());
    ranges.together(
      [&]
      {
        addVertexCells(
          mesh, begins[static_cast<std::size_t>(ranges.group().rank())], mesh.numberOfPoints());
      });
    endSection();
  }
  if (!lowerCells)
  {
    keepHighestDimension(ranges, share);
  }
  return share;
}
}
