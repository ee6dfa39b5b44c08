// SPDX-License-Identifier: BSD-3-Clause
// Data derived from a mesh: dimension and plane, boundary, adjacency; rejected meshes.
#include "Blocks.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr int boxSize[3] = { 4, 3, 2 };

MeshData box(CellType type)
{
  return blockMesh(type, boxSize[0], boxSize[1], topology(type).dimension == 2 ? 0 : boxSize[2]);
}

Dimension dimensionOf(const MeshData& data)
{
  return Mesh(data.view()).dimension();
}

//------------------------------------------------------------------------------
void checkPlane(const MeshData& data, const Vec3& expected)
{
  const Mesh mesh(data.view());
  TAUTLINE_CHECK(mesh.dimension() == Dimension::Planar);
  const Vec3 n = mesh.normal(), e1 = mesh.frame()[0], e2 = mesh.frame()[1];
  TAUTLINE_CHECK_NEAR(norm(n), 1, 1e-14);
  TAUTLINE_CHECK_NEAR(norm(cross(n, expected)), 0, 1e-9);
  TAUTLINE_CHECK_NEAR(norm(cross(e1, e2) - n), 0, 1e-14);
  TAUTLINE_CHECK_NEAR(norm(e1), 1, 1e-14);
  TAUTLINE_CHECK_NEAR(dot(e1, e2), 0, 1e-14);
  const auto largest = std::max_element(
    n.begin(), n.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  TAUTLINE_CHECK(*largest > 0);
}

TAUTLINE_PART(testDimension)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    const MeshData flat = box(type);
    checkPlane(flat, { 0, 0, 1 });
    TAUTLINE_CHECK(Mesh(flat.view()).normal() == (Vec3{ 0, 0, 1 }));
    TAUTLINE_CHECK(
      Mesh(flat.view()).frame() == (std::array<Vec3, 2>{ Vec3{ 1, 0, 0 }, { 0, 1, 0 } }));
    MeshData other = flat;
    other.transform(TAUTLINE_PLACE(p[2], p[0], p[1]));
    checkPlane(other, { 1, 0, 0 });
    other.transform(TAUTLINE_PLACE(p[2], p[0], p[1]));
    checkPlane(other, { 0, 1, 0 });
    Random random(15);
    for (double scale : { 1e-8, 1.0, 1e8 })
    {
      const Columns r = randomRotation(random);
      const Vec3 offset = random.vector(-3, 3);
      other = flat;
      other.transform([&](const Vec3& p) { return scale * (r * p + offset); });
      checkPlane(other, r[2]);
    }
    // Out of the plane by less and by more than a millionth of the diagonal, which is 5.
    other = flat;
    for (double height : { 4e-6, 6e-6 })
    {
      other.setPoint(7, flat.point(7) + Vec3{ 0, 0, height });
      TAUTLINE_CHECK(
        dimensionOf(other) == (height < 5e-6 ? Dimension::Planar : Dimension::Surface));
    }
    // Points no cell uses, and points that are not finite, do not count.
    other = TAUTLINE_CHANGED(flat, addPoint({ 0, 0, 9 }));
    TAUTLINE_CHECK(dimensionOf(other) == Dimension::Planar);
    other.setPoint(0, { 0, std::nan(""), 9 });
    TAUTLINE_CHECK(dimensionOf(other) == Dimension::Planar);
    TAUTLINE_CHECK_EQUAL(Mesh(other.view()).nonFinitePoints(), 1);
  }
  MeshData mixed = box(CellType::Quadrilateral);
  mixed.addCell(CellType::Triangle, { 0, 1, 5 });
  TAUTLINE_CHECK(dimensionOf(mixed) == Dimension::Planar);
  TAUTLINE_CHECK_EQUAL(Mesh(mixed.view()).blocks().size(), 2u);
  const Index apex = mixed.addPoint({ 0, 0, 1 });
  mixed.addCell(CellType::Triangle, { 0, 1, apex });
  TAUTLINE_CHECK(dimensionOf(mixed) == Dimension::Surface);
  mixed.addCell(CellType::Tetrahedron, { 0, 1, 5, apex });
  TAUTLINE_CHECK(dimensionOf(mixed) == Dimension::Volume);
  TAUTLINE_CHECK(Mesh(mixed.view()).normal() == (Vec3{ 0, 0, 0 }));

  MeshData none;
  TAUTLINE_CHECK(dimensionOf(none) == Dimension::None);
  TAUTLINE_SET(none, addPoint({ 0, 0, 0 }), addPoint({ 1, 0, 0 }));
  constexpr int vtkLine = 3;
  none.addCell(vtkLine, { 0, 1 });
  TAUTLINE_CHECK(dimensionOf(none) == Dimension::None);
  TAUTLINE_CHECK_EQUAL(Mesh(none.view()).unsupportedCells(), 1);
  TAUTLINE_CHECK_EQUAL(static_cast<int>(validityOf(none)[0]), static_cast<int>(NotMeasured));
  TAUTLINE_CHECK_EQUAL(Mesh(none.view()).boundary().facets, 0);
}

//------------------------------------------------------------------------------
/// Cells with a point that moved have the validity of a mesh there; the others keep theirs.
void testMovedCells(const MeshData& data, bool mirrored)
{
  MeshData moved = data;
  moved.setPoint(2, moved.point(2) + Vec3{ 1.5, 0.25, 0 });
  Mesh mesh(data.view()), there(moved.view());
  mesh.setMirrored(mirrored);
  there.setMirrored(mirrored);
  constexpr signed char unknown = 7;
  std::vector<signed char> validity(data.numberOfCells(), unknown), all(data.numberOfCells());
  mesh.classifyMovedCells(moved.points.data(), validity.data());
  there.classifyCells(all.data());
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const auto* begin = data.connectivity.data() + data.offsets[cell];
    const auto* end = data.connectivity.data() + data.offsets[cell + 1];
    const bool touched = std::find(begin, end, 2) != end;
    TAUTLINE_CHECK_EQUAL(int(validity[cell]), int(touched ? all[cell] : unknown));
  }
}

//------------------------------------------------------------------------------
/// At other points a mesh is what a new one there is: on a tilted plane, off it, in space, with a
/// point that is not finite, and back.
void testAtOtherPoints(MeshData data, bool mirrored)
{
  Mesh mesh(data.view());
  mesh.setMirrored(mirrored);
  const MeshData start = data;
  Random random(21);
  const Columns turn = randomRotation(random);
  MeshData tilted = start, bent = start, broken = start;
  tilted.transform([&](const Vec3& p) { return 3.0 * (turn * p) + Vec3{ 5, 6, 7 }; });
  bent.transform([](const Vec3& p) { return p + Vec3{ 0, 0, 0.1 * p[0] * p[1] }; });
  broken.setPoint(2, { std::nan(""), 0, 0 });
  Mesh moved = mesh;
  for (const MeshData& other : { tilted, bent, broken, start })
  {
    moved = moved.at(other.points.data());
    const Mesh fresh(other.view());
    TAUTLINE_CHECK(moved.view().points == other.points.data());
    TAUTLINE_CHECK(moved.dimension() == fresh.dimension());
    TAUTLINE_CHECK(moved.normal() == fresh.normal());
    TAUTLINE_CHECK(moved.frame() == fresh.frame());
    TAUTLINE_CHECK_EQUAL(moved.nonFinitePoints(), fresh.nonFinitePoints());
    TAUTLINE_CHECK_EQUAL(moved.mirrored(), mirrored);
    TAUTLINE_CHECK_EQUAL(moved.blocks().size(), fresh.blocks().size());
    TAUTLINE_CHECK_EQUAL(moved.higherOrderCells(), fresh.higherOrderCells());
    TAUTLINE_CHECK_EQUAL(moved.unsupportedCells(), fresh.unsupportedCells());
    TAUTLINE_EACH(std::size_t, b, fresh.blocks().size(),
      TAUTLINE_CHECK(moved.blocks()[b].cells == fresh.blocks()[b].cells));
  }
  TAUTLINE_CHECK(mesh.view().points == data.points.data());
}

//------------------------------------------------------------------------------
void testBoundary(CellType type)
{
  const MeshData data = box(type);
  const Mesh mesh(data.view());
  const Index x = boxSize[0], y = boxSize[1], z = boxSize[2];
  Index squares = 2 * (x * y + y * z + z * x), facets = squares;
  switch (type)
  {
    case CellType::Tetrahedron:
      facets = 2 * squares;
      break;
    case CellType::Wedge:
      facets = squares + 2 * x * y; // triangles above and below
      break;
    case CellType::Triangle:
    case CellType::Quadrilateral:
      facets = 2 * (x + y);
      break;
    default:
      break;
  }
  const Boundary boundary = mesh.boundary();
  TAUTLINE_CHECK_EQUAL(boundary.facets, facets);
  TAUTLINE_CHECK_EQUAL(boundary.nonManifold, 0);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i);
    bool outside = false;
    for (int c = 0; c < topology(type).dimension; ++c)
    {
      outside |= p[c] == 0 || p[c] == boxSize[c];
    }
    TAUTLINE_CHECK_EQUAL(boundary.isBoundaryPoint[i] != 0, outside);
  }
  // Without one cell that has all its facets inside, as many more facets as it has.
  const std::vector<signed char> validity = validityOf(mesh);
  TAUTLINE_CHECK(
    std::all_of(validity.begin(), validity.end(), [](signed char v) { return v == Valid; }));
  double sum = sumOf<double>(0, valuesOf(mesh, Metric::Size), [&](double size) { return size; });
  TAUTLINE_CHECK_NEAR(sum, topology(type).dimension == 2 ? x * y : x * y * z, 1e-12);
}

void testAdjacency(const MeshData& data)
{
  const Mesh mesh(data.view());
  std::vector<std::set<Index>> expected(data.numberOfPoints());
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const CellType type = cornerType(data.types[cell]);
    for (int k = 0; type != CellType::Unsupported && k < topology(type).nodes; ++k)
    {
      expected[data.connectivity[data.offsets[cell] + k]].insert(cell);
    }
  }
  const VertexCells adjacency = mesh.vertexCells();
  TAUTLINE_CHECK_EQUAL(adjacency.offsets.size(), expected.size() + 1);
  for (Index v = 0; v < data.numberOfPoints(); ++v)
  {
    const std::vector<Index> cells(adjacency.cells.begin() + adjacency.offsets[v],
      adjacency.cells.begin() + adjacency.offsets[v + 1]);
    TAUTLINE_CHECK(cells == std::vector<Index>(expected[v].begin(), expected[v].end()));
  }
}

/// Hexahedra, wedges, pyramids and tetrahedra that fit each other, and lines and points beside.
MeshData mixedMesh()
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 1, 1);
  const Index top = data.addPoint({ 0.5, 0.5, 2 });
  data.addCell(CellType::Pyramid, { 6, 7, 10, 9, top });
  const Index side = data.addPoint({ 2.5, 0.5, 0.5 });
  data.addCell(CellType::Pyramid, { 2, 8, 11, 5, side });
  data.addCell(CellType::Tetrahedron, { 8, 2, side, data.addPoint({ 3, -1, 0.5 }) });
  constexpr int vtkVertex = 1;
  TAUTLINE_SET(data, addCell(vtkVertex, { 3 }),
    addCell(
      CellType::Wedge, { 6, 7, data.addPoint({ 0, 0, 2 }), 9, 10, data.addPoint({ 0, 1, 2 }) }),
    addCell(CellType::Triangle, { 0, 1, 3 }));
  return data;
}

TAUTLINE_PART(testMixed)
{
  const MeshData data = mixedMesh();
  const Mesh mesh(data.view());
  TAUTLINE_CHECK(mesh.dimension() == Dimension::Volume);
  TAUTLINE_CHECK_EQUAL(mesh.blocks().size(), 5u);
  TAUTLINE_CHECK_EQUAL(mesh.unsupportedCells(), 1);
  testAdjacency(data);
  // The face 6 7 10 9 has a hexahedron, a pyramid and a wedge: not manifold, and so boundary.
  const Boundary boundary = mesh.boundary();
  TAUTLINE_CHECK_EQUAL(boundary.nonManifold, 1);
  const Index faces = 2 * 6 + 2 * 5 + 4 + 5, shared = 2 /* hexahedra */ + 3 + 2 /* pyramid */ + 2;
  TAUTLINE_CHECK_EQUAL(boundary.facets, faces - shared);
}

/// The facets of a mesh large enough to be filed in parts: none is lost, none is there twice.
TAUTLINE_PART(testLargeBoundary)
{
  constexpr int n = 45;
  const MeshData data = blockMesh(CellType::Tetrahedron, n, n, n);
  constexpr Index filedAtOnce = Index(1) << 20;
  TAUTLINE_CHECK(4 * data.numberOfCells() > filedAtOnce);
  const Mesh mesh(data.view());
  Index wrong = 0;
  const auto& boundary = mesh.boundary().isBoundaryPoint;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3& x = data.point(p);
    const bool outer = std::any_of(&x[0], &x[0] + 3, [](double c) { return c == 0 || c == n; });
    wrong += outer != (boundary[p] != 0);
  }
  TAUTLINE_CHECK_EQUAL(wrong, 0);
}

TAUTLINE_PART(testNonManifold)
{
  MeshData fans; // three triangles at an edge, as the pages of a book
  TAUTLINE_SET(fans,
    addPoints({ { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }, { -1, 1, 0 }, { -1, -1, 0 } }),
    addCell(CellType::Triangle, { 0, 1, 2 }), addCell(CellType::Triangle, { 0, 1, 3 }),
    addCell(CellType::Triangle, { 0, 1, 4 }));
  const Boundary boundary = Mesh(fans.view()).boundary();
  TAUTLINE_CHECK_EQUAL(boundary.nonManifold, 1);
  TAUTLINE_CHECK_EQUAL(boundary.facets, 6);
  TAUTLINE_CHECK_EQUAL(
    std::count(boundary.isBoundaryPoint.begin(), boundary.isBoundaryPoint.end(), 1), 5);

  MeshData shells; // the surfaces of two tetrahedra that share the edge 0 1, and nothing open
  shells.addPoints(
    { { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }, { 1, 1, 0 }, { -1, 0, 0 }, { -1, -1, 0 } });
  for (Index a : { 2, 4 })
  {
    TAUTLINE_SET(shells, addCell(CellType::Triangle, { 0, 1, a }),
      addCell(CellType::Triangle, { 1, 0, a + 1 }), addCell(CellType::Triangle, { 0, a, a + 1 }),
      addCell(CellType::Triangle, { 1, a + 1, a }));
  }
  const Boundary closed = Mesh(shells.view()).boundary();
  TAUTLINE_CHECK_EQUAL(closed.nonManifold, 1);
  TAUTLINE_CHECK_EQUAL(closed.facets, 0);
  TAUTLINE_CHECK((closed.isBoundaryPoint == std::vector<char>{ 1, 1, 0, 0, 0, 0 }));
}

//------------------------------------------------------------------------------
/// Quadratic cells count as their corners, among linear ones.
TAUTLINE_PART(testHigherOrder)
{
  constexpr int vtkQuadraticTriangle = 22;
  MeshData data = box(CellType::Triangle);
  const Index linear = data.numberOfCells();
  data.addCell(vtkQuadraticTriangle, { 0, 1, 6, 8, 8, 8 }); // the middles do not matter here
  const Mesh mesh(data.view());
  TAUTLINE_CHECK_EQUAL(mesh.higherOrderCells(), 1);
  TAUTLINE_CHECK_EQUAL(mesh.unsupportedCells(), 0);
  TAUTLINE_CHECK_EQUAL(mesh.blocks().size(), 1u);
  TAUTLINE_CHECK_EQUAL(mesh.blocks()[0].count, linear + 1);
  const Gradients g = gradientsOf(mesh, Metric::MeanRatio);
  TAUTLINE_CHECK_NEAR(g.values[linear], g.values[0], 1e-15);
  for (int entry = 0; entry < 18; ++entry)
  {
    const double expected = entry < 9 ? g.gradients[entry] : 0;
    TAUTLINE_CHECK_NEAR(g.gradients[9 * linear + entry], expected, 1e-15);
  }
}

TAUTLINE_PART(testRejections)
{
  const MeshData good = box(CellType::Tetrahedron);
  MeshData bad = good;
  for (Index wrong : { Index(-1), good.numberOfPoints(), Index(1) << 40 })
  {
    bad.connectivity[4 * 17 + 2] = wrong;
    TAUTLINE_CHECK_THROWS(Mesh(bad.view()), wording("cell-17-is-not-a-proper-tetrahedron"));
  }
  bad.connectivity[4 * 5] = -1; // the first of several is named
  TAUTLINE_CHECK_THROWS(Mesh(bad.view()), "Cell 5 ");
  bad = TAUTLINE_CHANGED(good, types[3] = static_cast<unsigned char>(CellType::Hexahedron));
  TAUTLINE_CHECK_THROWS(Mesh(bad.view()), wording("cell-3-is-not-a-proper-hexahedron"));
  bad = good;
  bad.offsets[8] = bad.offsets[7];
  TAUTLINE_CHECK_THROWS(Mesh(bad.view()), "Cell 7 ");
  bad = good;
  bad.types[9] = 0; // not even cells that are not measured may have descending offsets
  bad.offsets[10] = bad.offsets[9] - 4;
  TAUTLINE_CHECK_THROWS(Mesh(bad.view()), "Cell 9");
  for (int missing = 0; missing < 4; ++missing)
  {
    MeshView view = good.view();
    TAUTLINE_SET(view, points = missing == 0 ? nullptr : view.points,
      cellTypes = missing == 1 ? nullptr : view.cellTypes,
      offsets = missing == 2 ? nullptr : view.offsets,
      connectivity = missing == 3 ? nullptr : view.connectivity);
    TAUTLINE_CHECK_THROWS(Mesh mesh(view), "incomplete");
  }
  TAUTLINE_CHECK_THROWS(Mesh mesh(TAUTLINE_CHANGED(good.view(), numberOfCells = -1)), "incomplete");
}
}

TAUTLINE_TEST(TestMesh)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    TAUTLINE_RUN(testBoundary(type));
    TAUTLINE_RUN(testAdjacency(box(type)));
    TAUTLINE_RUN(testAtOtherPoints(box(type), topology(type).dimension == 3));
    TAUTLINE_RUN(testMovedCells(box(type), topology(type).dimension == 3));
  }
  TAUTLINE_RUN(testAtOtherPoints(mixedMesh(), false));
}
