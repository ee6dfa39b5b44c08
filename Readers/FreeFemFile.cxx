// SPDX-License-Identifier: BSD-3-Clause
#include "GmshFile.h"

namespace tautline
{
namespace
{
/// Reads cells with a label each, numbered from 1.
void readCells(
  TextCursor& cursor, unsigned char type, Index count, MeshFile& mesh, std::vector<Index>& labels)
{
  const auto size = static_cast<std::size_t>(cellNodes(type));
  cursor.expectRoom(count, 2 * (size + 1), "number of elements");
  std::vector<Index> nodes(static_cast<std::size_t>(count) * size);
  for (std::size_t i = 0, n = 0; i < static_cast<std::size_t>(count); ++i)
  {
    cursor.skipToToken();
    for (std::size_t c = 0; c < size; ++c)
    {
      nodes[n++] = cursor.integer("vertex", 1, mesh.numberOfPoints()) - 1;
    }
    labels.push_back(cursor.integer("label"));
    cursor.expectLineEnd();
  }
  mesh.addCells(type, std::move(nodes));
}
}

//------------------------------------------------------------------------------
MeshFile readFreeFem(const FileContent& file)
{
  TextCursor cursor(file);
  cursor.skipToToken();
  const char* place = cursor.place();
  if (cursor.tokensInLine() != 3)
  {
    cursor.fail("neither $MeshFormat (Gmsh) nor three numbers (FreeFem++: points, elements, "
                "boundary elements): this is not a supported .msh file");
  }
  const Index points = cursor.count("number of points", 6);
  const Index elements = cursor.count("number of elements", 6);
  const Index boundary = cursor.count("number of boundary elements", 4);
  cursor.expectLineEnd();
  cursor.skipToToken();
  const int columns = points > 0 ? cursor.tokensInLine() : 3;
  if (columns != 3 && columns != 4)
  {
    cursor.failAt(place,
      "a point has " + std::to_string(columns) + " numbers; x y label or x y z label are expected");
  }
  MeshFile mesh;
  mesh.points.assign(static_cast<std::size_t>(3 * points), 0.0);
  std::vector<Index> pointLabels(static_cast<std::size_t>(points)), cellLabels;
  for (std::size_t i = 0; i < pointLabels.size(); ++i)
  {
    cursor.skipToToken();
    for (int c = 0; c < columns - 1; ++c)
    {
      mesh.points[3 * i + static_cast<std::size_t>(c)] = cursor.coordinate("coordinate");
    }
    pointLabels[i] = cursor.integer("label");
    cursor.expectLineEnd();
  }
  readCells(cursor, columns == 3 ? FileTriangle : FileTetrahedron, elements, mesh, cellLabels);
  readCells(cursor, columns == 3 ? FileLine : FileTriangle, boundary, mesh, cellLabels);
  cursor.expectFileEnd("boundary element");
  mesh.pointArrays.push_back({ "Reference", 1, std::move(pointLabels) });
  mesh.cellArrays.push_back({ "Reference", 1, std::move(cellLabels) });
  return mesh;
}
}
