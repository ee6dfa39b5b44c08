// SPDX-License-Identifier: BSD-3-Clause
// Which way round the cells are listed: consistently, all reversed, or mixed, which tangled is not.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Mesh/CellOrder.h"

using namespace tautline;

namespace
{
MeshData box(CellType type)
{
  return blockMesh(type, 4, 3, topology(type).dimension == 2 ? 0 : 2);
}

/// Lists the nodes of a cell in the opposite order.
void flip(MeshData& data, Index cell)
{
  const std::vector<std::pair<int, int>> swaps[] = { { { 1, 2 } }, { { 1, 3 } }, { { 1, 2 } },
    { { 1, 3 }, { 5, 7 } }, { { 1, 2 }, { 4, 5 } }, { { 1, 3 } } };
  for (const auto& pair : swaps[topologyIndex(cornerType(data.types[cell]))])
  {
    const Index first = data.offsets[cell];
    std::swap(data.connectivity[first + pair.first], data.connectivity[first + pair.second]);
  }
}

Orientation orientationOf(const Mesh& mesh)
{
  return mesh.orientation(validityOf(mesh).data());
}

//------------------------------------------------------------------------------
void testOrientation(CellType type)
{
  const MeshData data = box(type);
  const Index cells = data.numberOfCells();
  Orientation o = orientationOf(Mesh(data.view()));
  TAUTLINE_CHECK_EQUAL(o.state, Orientation::Consistent);
  TAUTLINE_CHECK_EQUAL(o.positiveCells, cells);

  MeshData reversed = data;
  for (Index i = 0; i < cells; ++i)
  {
    flip(reversed, i);
  }
  Mesh reversedMesh(reversed.view());
  o = orientationOf(reversedMesh);
  TAUTLINE_CHECK_EQUAL(o.state, Orientation::Reversed);
  TAUTLINE_CHECK_EQUAL(o.negativeCells, cells);
  reversedMesh.setMirrored(true);
  o = orientationOf(reversedMesh);
  TAUTLINE_CHECK_EQUAL(o.state, Orientation::Consistent);
  TAUTLINE_CHECK_EQUAL(o.positiveCells, cells);

  // One cell the other way round: each facet it shares disagrees.
  MeshData mixed = data;
  const Index odd = cells / 2;
  flip(mixed, odd);
  o = orientationOf(Mesh(mixed.view()));
  TAUTLINE_CHECK_EQUAL(o.state, Orientation::Mixed);
  MeshData alone = singleCell(type, idealCell(type));
  MeshData without = TAUTLINE_CHANGED(data, types[odd] = 0);
  const Index own = Mesh(alone.view()).boundary().facets,
              opened = Mesh(without.view()).boundary().facets - Mesh(data.view()).boundary().facets;
  TAUTLINE_CHECK_EQUAL(o.disagreeing, (own + opened) / 2);
  TAUTLINE_CHECK_EQUAL(o.negativeCells, 1);

  // Two parts, one reversed.
  MeshData parts = data;
  const Index shift = data.numberOfPoints();
  for (Index i = 0; i < shift; ++i)
  {
    parts.addPoint(data.point(i) + Vec3{ 10, 0, 0 });
  }
  for (Index i = 0; i < cells; ++i)
  {
    std::vector<Index> nodes = data.nodes(i);
    std::for_each(nodes.begin(), nodes.end(), [&](Index& n) { n += shift; });
    parts.addCell(type, nodes);
    flip(parts, cells + i);
  }
  o = orientationOf(Mesh(parts.view()));
  TAUTLINE_CHECK_EQUAL(o.state, Orientation::Mixed);
  TAUTLINE_CHECK_EQUAL(o.parts, 2);
  TAUTLINE_CHECK_EQUAL(o.reversedParts, 1);
  TAUTLINE_CHECK_EQUAL(o.disagreeing, 0);

  // The order found makes both consistent.
  for (MeshData* of : { &mixed, &parts })
  {
    const Mesh given(of->view());
    const CellOrder order = consistentOrder(given, validityOf(given).data());
    TAUTLINE_CHECK_EQUAL(order.reversed, of == &mixed ? 1 : cells);
    TAUTLINE_CHECK_EQUAL(order.ambiguous, 0);
    TAUTLINE_CHECK_EQUAL(order.cells, of->numberOfCells());
    for (Index i = 0; i < of->numberOfCells(); ++i)
    {
      TAUTLINE_CHECK_EQUAL(
        static_cast<bool>(order.reverse[i]), of == &mixed ? i == odd : i >= cells);
      if (order.reverse[i])
      {
        reverseCell(type, of->connectivity.data() + of->offsets[i]);
      }
    }
    o = orientationOf(Mesh(of->view()));
    TAUTLINE_CHECK_EQUAL(o.state, Orientation::Consistent);
    TAUTLINE_CHECK_EQUAL(o.positiveCells, of->numberOfCells());
  }

  // A vertex pulled through its neighbors tangles the mesh; its orientation stays what it was.
  for (const MeshData* start : std::initializer_list<const MeshData*>{ &data, &reversed })
  {
    MeshData tangled = *start;
    const Boundary boundary = Mesh(data.view()).boundary();
    const auto inside =
      std::find(boundary.isBoundaryPoint.begin(), boundary.isBoundaryPoint.end(), 0) -
      boundary.isBoundaryPoint.begin();
    TAUTLINE_CHECK(inside < tangled.numberOfPoints());
    tangled.setPoint(inside, tangled.point(inside) + Vec3{ 1.6, 0.2, 0 });
    o = orientationOf(Mesh(tangled.view()));
    TAUTLINE_CHECK(o.negativeCells > 0);
    TAUTLINE_CHECK_EQUAL(o.disagreeing, 0);
    if (start == &data)
    {
      TAUTLINE_CHECK(o.positiveCells > 0);
      TAUTLINE_CHECK_EQUAL(o.parts, 1);
    }
    TAUTLINE_CHECK_EQUAL(o.state, start == &data ? Orientation::Consistent : Orientation::Reversed);
  }
}

//------------------------------------------------------------------------------
/// Inner points mirrored: most cells are inverted, yet the boundary determines the inside.
TAUTLINE_PART(testMostlyInverted)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const Index n = type == CellType::Triangle ? 8 : 10;
    MeshData data = blockMesh(type, n, n, type == CellType::Triangle ? 0 : n);
    const Boundary boundary = Mesh(data.view()).boundary();
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      if (!boundary.isBoundaryPoint[i])
      {
        data.setPoint(i, Vec3{ double(n) - data.point(i)[0], data.point(i)[1], data.point(i)[2] });
      }
    }
    Orientation o = orientationOf(Mesh(data.view()));
    TAUTLINE_CHECK(o.negativeCells > o.positiveCells);
    TAUTLINE_CHECK_EQUAL(o.state, Orientation::Consistent);
    for (Index i = 0; i < data.numberOfCells(); ++i)
    {
      flip(data, i);
    }
    Mesh reversed(data.view());
    o = orientationOf(reversed);
    TAUTLINE_CHECK(o.negativeCells < o.positiveCells);
    TAUTLINE_CHECK_EQUAL(o.state, Orientation::Reversed);
    reversed.setMirrored(true);
    TAUTLINE_CHECK_EQUAL(orientationOf(reversed).state, Orientation::Consistent);
  }
}

TAUTLINE_PART(testSurfaceOrientation)
{
  MeshData curved = box(CellType::Triangle);
  curved.transform(TAUTLINE_PLACE(p[0], p[1], 0.1 * p[0] * p[0]));
  TAUTLINE_CHECK_EQUAL(orientationOf(Mesh(curved.view())).state, Orientation::Consistent);
  flip(curved, 11); // the upper left triangle of an inner square
  const Orientation o = orientationOf(Mesh(curved.view()));
  TAUTLINE_CHECK_EQUAL(o.state, Orientation::Mixed);
  TAUTLINE_CHECK_EQUAL(o.disagreeing, 3);
  TAUTLINE_CHECK_EQUAL(o.negativeCells, 0); // a surface has no signs

  const MeshData moebius = moebiusBand(5);
  TAUTLINE_CHECK_EQUAL(orientationOf(Mesh(moebius.view())).state, Orientation::Mixed);
  TAUTLINE_CHECK_EQUAL(orientationOf(Mesh(moebius.view())).disagreeing, 1);
  const Mesh band(moebius.view());
  const CellOrder order = consistentOrder(band, validityOf(band).data());
  TAUTLINE_CHECK_EQUAL(order.ambiguous, 1);
  TAUTLINE_CHECK_EQUAL(order.firstAmbiguous, 0);
  TAUTLINE_CHECK_EQUAL(order.reversed, 0);
  // On a surface the majority keeps its order.
  const Mesh surface(curved.view());
  const CellOrder few = consistentOrder(surface, validityOf(surface).data());
  TAUTLINE_CHECK_EQUAL(few.reversed, 1);
  TAUTLINE_CHECK_EQUAL(few.reverse[11], 1);
}

/// A part of few inverted cells beside a mesh is inverted and not also reversed; one of many is
/// reversed and not inverted.
TAUTLINE_PART(testFewBeside)
{
  for (const Index n : { 1, 3 })
  {
    MeshData data = blockMesh(CellType::Hexahedron, 4, 4, 4);
    const MeshData other = blockMesh(CellType::Hexahedron, n, n, n);
    const Index shift = data.numberOfPoints();
    for (Index p = 0; p < other.numberOfPoints(); ++p)
    {
      data.addPoint(other.point(p) + Vec3{ 10, 0, 0 });
    }
    for (Index cell = 0; cell < other.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes = other.nodes(cell);
      std::for_each(nodes.begin(), nodes.end(), [shift](Index& p) { p += shift; });
      data.addCell(CellType::Hexahedron, nodes);
      flip(data, data.numberOfCells() - 1);
    }
    const Mesh mesh(data.view());
    const Orientation o = orientationOf(mesh);
    const bool reversed = n == 3;
    TAUTLINE_CHECK_EQUAL(o.parts, 2);
    TAUTLINE_CHECK_EQUAL(o.reversedParts, reversed ? 1 : 0);
    TAUTLINE_CHECK_EQUAL(o.state, reversed ? Orientation::Mixed : Orientation::Consistent);
    TAUTLINE_CHECK_EQUAL(consistentOrder(mesh, validityOf(mesh).data()).reversed,
      reversed ? other.numberOfCells() : 0);
  }
}

/// The order of the cells does not matter for a tangled mesh either: neighbors determine it.
TAUTLINE_PART(testTangledAndMixed)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    MeshData data = blockMesh(type, 6, 6, topology(type).dimension == 2 ? 0 : 6);
    const Boundary boundary = Mesh(data.view()).boundary();
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      if (!boundary.isBoundaryPoint[i] && i % 3 == 0)
      {
        data.setPoint(i, data.point(i) + Vec3{ 1.3, -0.7, 0 });
      }
    }
    const std::vector<signed char> before = validityOf(Mesh(data.view()));
    MeshData mixed = data;
    Index flipped = 0;
    for (Index i = 0; i < data.numberOfCells(); i += 1 + i % 4)
    {
      flip(mixed, i);
      ++flipped;
    }
    const Mesh given(mixed.view());
    const CellOrder order = consistentOrder(given, validityOf(given).data());
    TAUTLINE_CHECK_EQUAL(order.reversed, flipped);
    for (Index i = 0; i < data.numberOfCells() && !order.reverse.empty(); ++i)
    {
      if (order.reverse[i])
      {
        reverseCell(type, mixed.connectivity.data() + mixed.offsets[i]);
      }
    }
    TAUTLINE_CHECK(std::count(before.begin(), before.end(), Inverted) > 0);
    TAUTLINE_CHECK(validityOf(Mesh(mixed.view())) == before);
  }
}

}
//------------------------------------------------------------------------------
/// A point so far out that signed sizes no longer add up to anything does not turn a mesh round.
TAUTLINE_PART(testFarPoint)
{
  for (const Vec3& far : { Vec3{ 1e21, 3e20, 0 }, Vec3{ -7e20, 1e21, 0 }, Vec3{ 3e20, -1e21, 0 } })
  {
    MeshData data = blockMesh(CellType::Triangle, 6, 6, 0);
    data.setPoint(3 * 7 + 3, far);
    const Orientation o = orientationOf(Mesh(data.view()));
    TAUTLINE_CHECK(o.negativeCells > 0);
    TAUTLINE_CHECK_EQUAL(o.state, Orientation::Consistent);
  }
}

TAUTLINE_TEST(TestOrientation)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    TAUTLINE_RUN(testOrientation(type));
  }
}
