// SPDX-License-Identifier: BSD-3-Clause
// Triangles without area and tetrahedra without volume: Improve Mesh removes them and keeps the
// region that the mesh fills, Optimize Mesh does not fold a surface over at them.
#include "Reconnecting.h"
#include "Registry.h"
#include "Surfaces.h"
#include "Triangulating.h"
#include "VtkMeshes.h"
#include "tautline/Reconnection/DegenerateCells.h"
#include "vtkMeshImprover.h"
#include "vtkMeshOptimizer.h"

using namespace tautline;

namespace
{
constexpr int Side = 4; ///< squares along an edge of the cube's surface

/// The surface of the unit cube, as outer sides.
MeshData cube()
{
  MeshData data = cubeSurface(CellType::Triangle, Side);
  Vec3 low = { HUGE_VAL, HUGE_VAL, HUGE_VAL }, high = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], data.point(p)[c]);
      high[c] = std::max(high[c], data.point(p)[c]);
    }
  }
  data.transform(
    [&](const Vec3& p)
    {
      return Vec3{ (p[0] - low[0]) / (high[0] - low[0]), (p[1] - low[1]) / (high[1] - low[1]),
        (p[2] - low[2]) / (high[2] - low[2]) };
    });
  return data;
}

/// Divides an edge of one cell only: the facets at the edge get degenerate cells, so that the mesh
/// conforms.
void slit(MeshData& data, Index cell, int from, int to, double at)
{
  TAUTLINE_LET(MeshData, result, points = data.points);
  const std::vector<Index> own = data.nodes(cell);
  const Index a = own[from], b = own[to];
  const Index middle = result.addPoint(data.point(a) + at * (data.point(b) - data.point(a)));
  const auto replaced = [](std::vector<Index> nodes, Index one, Index other)
  {
    std::replace(nodes.begin(), nodes.end(), one, other);
    return nodes;
  };
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    result.addCell(data.types[c], c == cell ? replaced(own, b, middle) : data.nodes(c));
  }
  result.addCell(data.types[cell], replaced(own, a, middle));
  // Over each facet at the edge: the cell with the point opposite it moved into the facet.
  for (const Index opposite : own)
  {
    if (opposite != a && opposite != b)
    {
      result.addCell(data.types[cell], replaced(own, opposite, middle));
    }
  }
  data = result;
}

/// Triangles of the cube's surface that face inwards.
Index inwards(const MeshData& data)
{
  Index count = 0;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    Vec3 center = { -0.5, -0.5, -0.5 };
    for (const Index p : data.nodes(cell))
    {
      center += (1.0 / 3.0) * data.point(p);
    }
    count += dot(areaVector(data, cell), center) < -1e-14;
  }
  return count;
}

Index invalidOf(const MeshData& data)
{
  const std::vector<signed char> validity = validityOf(data);
  return std::count_if(validity.begin(), validity.end(), [](signed char v) { return v != Valid; });
}

/// Every edge of a closed surface has two triangles in opposite senses.
void checkClosed(const MeshData& data)
{
  std::map<std::pair<Index, Index>, int> edges;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const std::vector<Index> nodes = data.nodes(cell);
    for (int k = 0; k < 3; ++k)
    {
      ++edges[{ nodes[k], nodes[(k + 1) % 3] }];
    }
  }
  for (const auto& [edge, uses] : edges)
  {
    TAUTLINE_CHECK_EQUAL(uses, 1);
    TAUTLINE_CHECK_EQUAL(edges.count({ edge.second, edge.first }), 1u);
  }
}

MeshData improved(const MeshData& data, const std::string& sentence)
{
  TAUTLINE_NEW(
    vtkMeshImprover, filter, SetInputData(toGrid(data)), SetMergeCoincidentPoints(false));
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(!messages.has("ERROR"));
  TAUTLINE_CHECK(contains(filter->GetSummary(), sentence));
  return toMesh(outputOf<vtkUnstructuredGrid>(filter));
}

/// Surfaces with slits: beside each other, in each other, at the edges of the cube.
std::vector<MeshData> slitCubes()
{
  std::vector<MeshData> cubes(4, cube());
  slit(cubes[0], 0, 0, 2, 0.5);
  slit(cubes[1], 0, 0, 2, 0.5);
  slit(cubes[1], cubes[1].numberOfCells() - 1, 0, 2, 0.5); // a degenerate one itself
  Random random(17);
  for (int i = 0; i < 40; ++i)
  {
    const int from = static_cast<int>(random.integer(3));
    slit(cubes[2], static_cast<Index>(random.integer(static_cast<int>(cubes[2].numberOfCells()))),
      from, (from + 1) % 3, 0.5);
  }
  // A point twice: needles without width.
  MeshData& needles = cubes[3];
  slit(needles, 5, 0, 1, 0.5);
  const Index last = needles.numberOfPoints() - 1;
  needles.setPoint(last, needles.point(needles.nodes(5)[0]));
  return cubes;
}

TAUTLINE_PART(testSurfaces)
{
  for (const MeshData& data : slitCubes())
  {
    TAUTLINE_CHECK(invalidOf(data) > 0);
    TAUTLINE_CHECK_NEAR(areaOf(data), 6.0, 1e-12);
    const Index gone = invalidOf(data);
    const MeshData result = improved(data, std::to_string(gone) + " degenerate triangle");
    TAUTLINE_CHECK_EQUAL(invalidOf(result), 0);
    TAUTLINE_CHECK_NEAR(areaOf(result), 6.0, 1e-9);
    TAUTLINE_CHECK_EQUAL(inwards(result), 0);
    checkClosed(result);
  }
}

/// Marked edges follow, regions come from the cells that are divided, fixed points stay.
TAUTLINE_PART(testKept)
{
  MeshData data = blockMesh(CellType::Triangle, 4, 4, 0);
  data.transform(TAUTLINE_PLACE(p[0], p[1], 0.1 * p[0] * p[0]));
  const std::vector<Index> own = data.nodes(3);
  slit(data, 3, 0, 1, 0.5); // the diagonal of a square, whose other triangle is 2
  DegenerateOptions options;
  options.edges.push_back({ own[0], own[1] });
  const DegenerateRemoval removal = removeDegenerateCells(Mesh(data.view()), options);
  TAUTLINE_CHECK_EQUAL(removal.degenerate, 1);
  TAUTLINE_CHECK_EQUAL(removal.left, 0);
  // One cell less, one more divided.
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(removal.originalCells.size()), data.numberOfCells());
  TAUTLINE_CHECK(std::is_sorted(removal.originalCells.begin(), removal.originalCells.end()));
  TAUTLINE_CHECK_EQUAL(
    std::count(removal.originalCells.begin(), removal.originalCells.end(), Index(2)), 2);
  TAUTLINE_CHECK_EQUAL(removal.edges.size(), 2u);
  const Index middle = data.numberOfPoints() - 1;
  for (const auto& edge : removal.edges)
  {
    TAUTLINE_CHECK(edge[0] == middle || edge[1] == middle);
  }
  // Fixed points at one place are not merged.
  MeshData twice = cube();
  slit(twice, 5, 0, 1, 0.5);
  twice.setPoint(twice.numberOfPoints() - 1, twice.point(twice.nodes(5)[0]));
  const std::vector<unsigned char> all(twice.numberOfPoints(), 1);
  TAUTLINE_LET(DegenerateOptions, held, fixed = all.data());
  const DegenerateRemoval none = removeDegenerateCells(Mesh(twice.view()), held);
  TAUTLINE_CHECK(none.degenerate > 0);
  for (std::size_t p = 0; p < none.mergedInto.size(); ++p)
  {
    TAUTLINE_CHECK_EQUAL(none.mergedInto[p], static_cast<Index>(p));
  }
  // Nothing to do: nothing is copied.
  const MeshData whole = cube();
  TAUTLINE_CHECK(removeDegenerateCells(Mesh(whole.view()), {}).cells.empty());
}

/// Optimize Mesh keeps the surface where it is, and names what is left.
TAUTLINE_PART(testOptimize)
{
  for (const MeshData& data : slitCubes())
  {
    const Index gone = invalidOf(data);
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)),
      SetMergeCoincidentPoints(false), SetPreset(vtkMeshOptimizer::CUSTOM),
      AddObjectiveByName("imr"), SetMaximumIterations(10), Update());
    const MeshData result = toMesh(outputOf<vtkUnstructuredGrid>(filter));
    TAUTLINE_CHECK(result.points != data.points);
    TAUTLINE_CHECK_NEAR(areaOf(result), 6.0, 1e-9);
    TAUTLINE_CHECK_EQUAL(inwards(result), 0);
    TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), gone);
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("improve-mesh-removes")));
  }
}

/// Two layers whose squares meet with crossing diagonals, and a flat tetrahedron between each two.
MeshData withSlivers(Index n)
{
  MeshData data = blockMesh(CellType::Tetrahedron, n, n, 1);
  const MeshData upper = blockMesh(CellType::Tetrahedron, n, n, 1);
  const Index layer = (n + 1) * (n + 1);
  for (Index p = layer; p < upper.numberOfPoints(); ++p)
  {
    data.addPoint(upper.point(p) + Vec3{ 0, 0, 1 });
  }
  for (Index cell = 0; cell < upper.numberOfCells(); ++cell)
  {
    std::vector<Index> nodes = upper.nodes(cell);
    std::for_each(nodes.begin(), nodes.end(), [layer](Index& p) { p += layer; });
    data.addCell(upper.types[cell], nodes);
  }
  for (Index j = 0; j < n; ++j)
  {
    for (Index i = 0; i < n; ++i)
    {
      const Index p4 = layer + i + (n + 1) * j, p5 = p4 + 1, p7 = p4 + n + 1, p6 = p7 + 1;
      // The diagonal of the lower layer is the lower edge of the flat one.
      data.addCell(CellType::Tetrahedron,
        (i + j) % 2 == 0 ? std::vector<Index>{ p5, p7, p4, p6 }
                         : std::vector<Index>{ p4, p6, p7, p5 });
    }
  }
  return data;
}

TAUTLINE_PART(testTetrahedra)
{
  std::vector<MeshData> blocks(4, blockMesh(CellType::Tetrahedron, 3, 3, 3));
  slit(blocks[0], 30, 0, 1, 0.5);
  slit(blocks[1], 0, 0, 3, 0.5); // at the boundary
  Random random(5);
  for (int i = 0; i < 20; ++i)
  {
    const int from = static_cast<int>(random.integer(4));
    slit(blocks[2], static_cast<Index>(random.integer(130)), from, (from + 1) % 4, 0.5);
  }
  blocks[3] = withSlivers(3);
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    const Context context("block " + std::to_string(i));
    const MeshData& data = blocks[i];
    TAUTLINE_CHECK(invalidOf(data) > 0);
    const MeshData result = improved(data, "");
    TAUTLINE_CHECK_EQUAL(invalidOf(result), 0);
    TAUTLINE_CHECK_NEAR(volumeOf(result), volumeOf(data), 1e-9);
    TAUTLINE_CHECK_EQUAL(Mesh(result.view()).boundary().nonManifold, 0);
  }
  // Flat ones on the boundary are dropped.
  MeshData lid = blockMesh(CellType::Tetrahedron, 2, 2, 1);
  const MeshData two = withSlivers(2);
  for (Index cell = two.numberOfCells() - 4; cell < two.numberOfCells(); ++cell)
  {
    lid.addCell(two.types[cell], two.nodes(cell));
  }
  const DegenerateRemoval removal = removeDegenerateCells(Mesh(lid.view()), {});
  TAUTLINE_CHECK_EQUAL(removal.degenerate, 4);
  TAUTLINE_CHECK_EQUAL(removal.left, 0);
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(removal.originalCells.size()), lid.numberOfCells() - 4);
}
}
