// SPDX-License-Identifier: BSD-3-Clause
// PT-Scotch divides the graph of the cells: parts of about equal size with a short border.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Solvers/GraphPartition.h"

using namespace tautline;

namespace
{
/// The number of edges between two triangles or quadrilaterals of different parts.
Index cutEdges(const MeshData& data, const std::vector<int>& parts)
{
  std::map<std::pair<Index, Index>, std::vector<int>> edges;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const Index begin = data.offsets[cell], size = data.offsets[cell + 1] - begin;
    for (Index k = 0; k < size; ++k)
    {
      const Index a = data.connectivity[begin + k], b = data.connectivity[begin + (k + 1) % size];
      edges[{ std::min(a, b), std::max(a, b) }].push_back(parts[cell]);
    }
  }
  return std::count_if(edges.begin(), edges.end(),
    [](const auto& edge) { return edge.second.size() == 2 && edge.second[0] != edge.second[1]; });
}

void testParts(CellType type, int parts)
{
  const Context context(std::to_string(parts) + " parts of " + topology(type).plural);
  const bool flat = topology(type).dimension == 2;
  const MeshData data = shuffled(flat ? movedBlock(type, 24, 0.1) : movedBlock(type, 8, 0.1), 5);
  const Mesh mesh(data.view());
  const std::vector<int> found = partitionGraph(mesh, parts);
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(found.size()), data.numberOfCells());
  std::vector<double> sizes(parts, 0.0);
  for (const int part : found)
  {
    TAUTLINE_CHECK(part >= 0 && part < parts);
    sizes[part] += 1.0;
  }
  const double mean = static_cast<double>(data.numberOfCells()) / parts;
  TAUTLINE_EACH_OF(
    const double size, sizes, TAUTLINE_CHECK(size > 0.8 * mean && size < 1.2 * mean));
  if (flat && parts == 2)
  {
    // Straight through the middle are 24 edges of squares; at random about half of all.
    TAUTLINE_CHECK(cutEdges(data, found) <= 2 * 24);
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestGraphPartition)
{
  TAUTLINE_RUN(testParts(CellType::Quadrilateral, 2));
  TAUTLINE_RUN(testParts(CellType::Triangle, 2));
  TAUTLINE_RUN(testParts(CellType::Tetrahedron, 7));
  TAUTLINE_RUN(testParts(CellType::Hexahedron, 4));
  const MeshData data = blockMesh(CellType::Quadrilateral, 2, 2, 0);
  const Mesh mesh(data.view());
  TAUTLINE_CHECK(partitionGraph(mesh, 1) == std::vector<int>(4, 0));
  for (const int parts : { 0, -1, 5 })
  {
    try
    {
      partitionGraph(mesh, parts);
      TAUTLINE_CHECK(!"rejected");
    }
    catch (const Error& error)
    {
      TAUTLINE_CHECK(contains(error.what(), wording("a-mesh-of-4-cells")));
    }
  }
}
