// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetGenRecords.h
 * @brief Headers and records of TetGen's files, for those who read all of them or a range.
 */
#ifndef tautline_TetGenRecords_h
#define tautline_TetGenRecords_h

#include "FileRanges.h"
#include "MeshFile.h"
#include "TextCursor.h"

namespace tautline
{
namespace tetgen
{
constexpr char Comment = '#';

/// The header of the vertices.
struct NodeHeader
{
  Index count = 0;
  int dimension = 3;
  Index attributes = 0;
  bool markers = false;
};

/// Vertices and how other files number them.
struct NodeList
{
  NodeHeader header;
  Index base = 0; ///< number of the first vertex, 0 or 1
  Index last() const { return this->base + this->header.count - 1; }
};

/// The header of the elements, and the number of the first.
struct ElementHeader
{
  Index count = 0, nodes = 0, attributes = 0, base = 0;
  unsigned char type = 0;
};

/// The header of faces (3 or 6 nodes) or edges (2 or 3) with an optional marker, what the first of
/// them tells about all, and its number.
struct BoundaryHeader
{
  bool faces = false, markers = false;
  Index count = 0, base = 0;
  unsigned char type = 0;
  Index nodes() const { return cellNodes(this->type); }
};

/// Each reads the header of a file. The number of the first record, `base`, is left to peekBase().
NodeHeader readNodeHeader(TextCursor& cursor);
ElementHeader readElementHeader(TextCursor& cursor, const NodeHeader& nodes);
/// @param quadraticMesh whether the cells before have nodes on their edges
BoundaryHeader readBoundaryHeader(TextCursor& cursor, bool faces, bool quadraticMesh);

/// The number of the first record, 0 or 1; leaves the cursor before it.
Index peekBase(TextCursor& cursor, const char* what);

/// The vertices from `first` on, as the points of a mesh that has none. `file` has the names of
/// attributes.
void readNodeRecords(TextCursor& cursor, const FileContent& file, const NodeList& nodes,
  Index first, Index count, MeshFile& mesh);
/// The elements from `first` on, as the only cells of a mesh; Reference is a double.
void readElementRecords(TextCursor& cursor, const FileContent& file, const ElementHeader& header,
  const NodeList& nodes, Index first, Index count, MeshFile& mesh);
/// The faces or edges from `first` on; numbers of neighbours are skipped.
void readBoundaryRecords(TextCursor& cursor, const BoundaryHeader& header, const NodeList& nodes,
  Index first, Index count, MeshFile& mesh);

/// References become whole numbers where all of them are, on all ranks if there are some.
void makeIntegral(std::vector<MeshArray>& arrays, const FileRanges* ranges);
/// A vertex cell of each of the points from `first` on.
void addVertexCells(MeshFile& mesh, Index first, Index count);
}
}
#endif
