// SPDX-License-Identifier: BSD-3-Clause
// Points at the same place on the seams of meshes in pieces: which are one, and which stay apart.
// Duplicate cells, and the boundary of meshes that have some.
#include "Pieces.h"
#include "Registry.h"
#include "tautline/Core/CountingSort.h"
#include "tautline/Mesh/BoundaryPoints.h"
#include "tautline/Mesh/CoincidentPoints.h"
#include "tautline/Mesh/CornerPoints.h"

using namespace tautline;

namespace
{
CoincidentPoints found(const MeshData& data)
{
  return findCoincidentPoints(Mesh(data.view()));
}

Index nearPoints(const MeshData& data, Index* first = nullptr)
{
  const Mesh mesh(data.view());
  return countNearPoints(mesh, boundaryPoints(mesh), first);
}

/// The mesh whose cells have the representatives.
MeshData merged(MeshData data)
{
  const CoincidentPoints points = found(data);
  for (Index& node : data.connectivity)
  {
    node = points.any() ? points.representative[node] : node;
  }
  return data;
}

MeshData block(CellType type, Index n)
{
  return blockMesh(type, n, n, topology(type).dimension == 2 ? 0 : n);
}

void append(MeshData& data, const MeshData& more)
{
  const Index shift = data.numberOfPoints();
  data.points.insert(data.points.end(), more.points.begin(), more.points.end());
  for (Index cell = 0; cell < more.numberOfCells(); ++cell)
  {
    std::vector<Index> nodes = more.nodes(cell);
    for (Index& node : nodes)
    {
      node += shift;
    }
    data.addCell(static_cast<int>(more.types[cell]), nodes);
  }
}

/// Each merged point has the place of its representative, and cells of the merged mesh correspond
/// to the points of the whole one.
void checkAgainstWhole(const Pieces& pieces, const MeshData& whole)
{
  const CoincidentPoints points = found(pieces.mesh);
  TAUTLINE_CHECK_EQUAL(points.merged, pieces.copies);
  TAUTLINE_CHECK_EQUAL(points.apart(), 0);
  std::map<Index, Index> pointOf; // of the representatives
  for (Index p = 0; p < pieces.mesh.numberOfPoints() && points.any(); ++p)
  {
    const Index one = points.representative[p];
    TAUTLINE_CHECK(one <= p && points.representative[one] == one);
    TAUTLINE_CHECK_EQUAL(pieces.pointOf[one], pieces.pointOf[p]);
    const auto known = pointOf.emplace(pieces.pointOf[p], one);
    TAUTLINE_CHECK_EQUAL(known.first->second, one);
  }
  const MeshData one = merged(pieces.mesh);
  const Boundary mine = Mesh(one.view()).boundary(), given = Mesh(whole.view()).boundary();
  TAUTLINE_CHECK_EQUAL(mine.facets, given.facets);
  TAUTLINE_CHECK_EQUAL(mine.nonManifold, given.nonManifold);
  TAUTLINE_EACH(Index, n, static_cast<Index>(one.connectivity.size()),
    TAUTLINE_CHECK_EQUAL(int(mine.isBoundaryPoint[one.connectivity[n]]),
      int(given.isBoundaryPoint[whole.connectivity[n]])));
}

TAUTLINE_PART(testPieces)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const MeshData whole = block(type, 4);
    TAUTLINE_CHECK(!found(whole).any() && found(whole).representative.empty());
    checkAgainstWhole(exploded(whole), whole);
    const Pieces quarters = inQuarters(whole, 2.0);
    checkAgainstWhole(quarters, whole);
    const CoincidentPoints points = found(quarters.mesh);
    TAUTLINE_CHECK_EQUAL(points.seams, 1);
    TAUTLINE_CHECK(points.first > 0 && points.representative[points.first] < points.first);
    // Two seams that do not touch.
    const Pieces three = inPieces(whole,
      [&](Index cell)
      {
        const double x = centerOf(whole, cell)[0];
        return Index(x > 1) + Index(x > 3);
      });
    TAUTLINE_CHECK_EQUAL(found(three.mesh).seams, 2);
    const Index perSeam = topology(type).dimension == 2 ? 5 : 25;
    TAUTLINE_CHECK_EQUAL(found(three.mesh).merged, 2 * perSeam);
    const Index cubes = topology(type).dimension == 2 ? 4 : 16;
    const bool cut = type == CellType::Tetrahedron || type == CellType::Wedge;
    TAUTLINE_CHECK(found(three.mesh).facets == 2 * cubes ||
      (cut && found(three.mesh).facets == (type == CellType::Wedge ? 2 : 4) * cubes));
  }
}

TAUTLINE_PART(testInvariance)
{
  const MeshData whole = block(CellType::Tetrahedron, 4);
  const Pieces pieces = inQuarters(whole, 2.0);
  const CoincidentPoints expected = found(pieces.mesh);
  for (double scale : { 1e-150, 1e-12, 1e12, 1e100 })
  {
    for (double offset : { 0.0, 1e3, -1e8 })
    {
      const Context context(std::to_string(scale) + " " + std::to_string(offset));
      MeshData moved = pieces.mesh;
      moved.transform([&](Vec3 p) { return scale * (p + Vec3{ offset, offset, offset }); });
      const CoincidentPoints points = found(moved);
      TAUTLINE_CHECK(points.representative == expected.representative);
      TAUTLINE_CHECK_EQUAL(points.seams, expected.seams);
    }
  }
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    const CoincidentPoints points = found(shuffled(pieces.mesh, seed));
    TAUTLINE_CHECK_EQUAL(points.merged, expected.merged);
    TAUTLINE_CHECK_EQUAL(points.facets, expected.facets);
    TAUTLINE_CHECK_EQUAL(points.seams, expected.seams);
  }
  // 0 and -0 are the same place; here the seam is at x = 0.
  MeshData signs = pieces.mesh;
  signs.transform([](Vec3 p) { return p - Vec3{ 2, 2, 0 }; });
  for (Index p = 0; p < signs.numberOfPoints(); p += 2)
  {
    signs.points[3 * p] = signs.points[3 * p] == 0 ? -0.0 : signs.points[3 * p];
  }
  TAUTLINE_CHECK_EQUAL(found(signs).merged, expected.merged);
  // The next number up is another place, and near.
  MeshData off = pieces.mesh;
  for (Index p = 0; p < off.numberOfPoints(); ++p)
  {
    const bool copy = expected.representative[p] != p;
    off.points[3 * p] = copy ? std::nextafter(off.points[3 * p], 10.0) : off.points[3 * p];
  }
  TAUTLINE_CHECK(!found(off).any());
  Index first = -1;
  TAUTLINE_CHECK(nearPoints(off, &first) > expected.merged);
  TAUTLINE_CHECK(first >= 0);
  TAUTLINE_CHECK_EQUAL(nearPoints(pieces.mesh), 0);
  TAUTLINE_CHECK_EQUAL(nearPoints(whole), 0);
}

TAUTLINE_PART(testApart)
{
  // Two squares that touch at a corner have no facet in common.
  MeshData corner = block(CellType::Quadrilateral, 2);
  MeshData other = corner;
  other.transform([](Vec3 p) { return p + Vec3{ 2, 2, 0 }; });
  append(corner, other);
  TAUTLINE_CHECK(!found(corner).any() && found(corner).apart() == 0);

  // The elements of two meshes at the same place overlap.
  for (CellType type : { CellType::Triangle, CellType::Hexahedron })
  {
    MeshData twice = block(type, 3);
    append(twice, block(type, 3));
    const CoincidentPoints points = found(twice);
    TAUTLINE_CHECK(!points.any());
    TAUTLINE_CHECK_EQUAL(points.overlapping, type == CellType::Triangle ? 12 : 54);
    TAUTLINE_CHECK(points.crowded > 0 && points.firstApart == 0);
  }

  // A third cell at a facet.
  MeshData fan;
  fan.addCell(CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
  fan.addCell(CellType::Triangle, std::vector<Vec3>{ { 1, 0, 0 }, { 0, 0, 0 }, { 0, -1, 0 } });
  TAUTLINE_CHECK_EQUAL(found(fan).merged, 2);
  fan.addCell(CellType::Triangle, std::vector<Vec3>{ { 1, 0, 0 }, { 0, 0, 0 }, { 1, -1, 0 } });
  TAUTLINE_CHECK_EQUAL(found(fan).merged, 0);
  TAUTLINE_CHECK_EQUAL(found(fan).crowded, 1);

  // A cell of no thickness between two others would have points twice.
  MeshData layer = block(CellType::Hexahedron, 1);
  MeshData above = layer;
  above.transform([](Vec3 p) { return p + Vec3{ 0, 0, 1 }; });
  append(layer, above);
  TAUTLINE_CHECK_EQUAL(found(layer).merged, 4);
  layer.addCell(CellType::Hexahedron, std::vector<Index>{ 4, 5, 7, 6, 8, 9, 11, 10 });
  TAUTLINE_CHECK_EQUAL(found(layer).merged, 0);
  TAUTLINE_CHECK(found(layer).collapsing > 0);

  // A slit whose ends are one point each: both sides are one, as all their facets match.
  const MeshData whole = block(CellType::Quadrilateral, 4);
  MeshData slit = whole;
  const Index middle = 2 * 5 + 2, copy = slit.addPoint(whole.point(middle));
  for (Index n = 0; n < static_cast<Index>(slit.connectivity.size()) / 2; ++n)
  {
    slit.connectivity[n] = slit.connectivity[n] == middle ? copy : slit.connectivity[n];
  }
  TAUTLINE_CHECK_EQUAL(Mesh(slit.view()).boundary().facets, 20);
  TAUTLINE_CHECK_EQUAL(found(slit).merged, 1);
  TAUTLINE_CHECK_EQUAL(found(slit).facets, 2);
  TAUTLINE_CHECK(merged(slit).connectivity == whole.connectivity);

  // Points that no cell has, and those that are not finite, do not count.
  TAUTLINE_CHECK(!found(TAUTLINE_CHANGED(whole, addPoint(whole.point(middle)))).any());
  Pieces nan = inQuarters(whole, 2.0);
  for (double& x : nan.mesh.points)
  {
    x = x == 2.0 ? std::numeric_limits<double>::quiet_NaN() : x;
  }
  TAUTLINE_CHECK(!found(nan.mesh).any());
}

TAUTLINE_PART(testSurfaces)
{
  // Sheets in space, of any orientation; three at an edge stay apart.
  const auto sheet = [](double angle, bool reversed)
  {
    MeshData data = block(CellType::Triangle, 3);
    data.transform(TAUTLINE_PLACE(p[0] * std::cos(angle), p[1], p[0] * std::sin(angle)));
    for (Index cell = 0; reversed && cell < data.numberOfCells(); ++cell)
    {
      std::swap(data.connectivity[3 * cell], data.connectivity[3 * cell + 1]);
    }
    return data;
  };
  for (bool reversed : { false, true })
  {
    MeshData data = sheet(0.3, reversed);
    append(data, sheet(2.0, false));
    TAUTLINE_CHECK_EQUAL(found(data).merged, 4);
    append(data, sheet(4.0, false));
    TAUTLINE_CHECK_EQUAL(found(data).merged, 0);
    TAUTLINE_CHECK_EQUAL(found(data).crowded, 3);
  }
  // Where four sheets meet at an edge, its points are on the boundary.
  MeshData cross;
  for (Index k = 0; k < 4; ++k)
  {
    const Vec3 far[] = { { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 } };
    if (k == 0)
    {
      TAUTLINE_SET(cross, addPoint({ 0, 0, 0 }), addPoint({ 0, 0, 1 }));
    }
    const Index a = cross.addPoint(far[k]), b = cross.addPoint(far[k] + Vec3{ 0, 0, 1 });
    cross.addCell(CellType::Quadrilateral,
      k % 2 == 0 ? std::vector<Index>{ 0, a, b, 1 } : std::vector<Index>{ 1, b, a, 0 });
  }
  const std::vector<char> boundary = boundaryPoints(Mesh(cross.view()));
  TAUTLINE_CHECK(boundary[0] && boundary[1]);
}

/// The boundary points, from the facets of cells with different points.
std::vector<char> expectedBoundary(const MeshData& data)
{
  TAUTLINE_LET(MeshData, distinct, points = data.points);
  std::set<std::set<Index>> seen;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const std::vector<Index> nodes = data.nodes(cell);
    if (seen.insert({ nodes.begin(), nodes.end() }).second)
    {
      distinct.addCell(static_cast<int>(data.types[cell]), nodes);
    }
  }
  std::map<std::set<Index>, int> cells;
  const Mesh mesh(distinct.view());
  for (const CellBlock& cellBlock : mesh.blocks())
  {
    const CellTopology& t = topology(cellBlock.type);
    for (Index i = 0; i < cellBlock.count; ++i)
    {
      const Index* node = &distinct.connectivity[distinct.offsets[cellBlock.cell(i)]];
      for (int f = 0; f < (t.dimension == 3 ? t.faces : t.edges); ++f)
      {
        std::set<Index> facet;
        for (int k = 0; k < (t.dimension == 3 ? t.faceSizes[f] : 2); ++k)
        {
          facet.insert(node[t.dimension == 3 ? t.faceNodes[f][k] : t.edgeNodes[f][k]]);
        }
        ++cells[facet];
      }
    }
  }
  std::vector<char> boundary(data.numberOfPoints(), 0);
  for (const auto& [facet, count] : cells)
  {
    for (Index point : facet)
    {
      boundary[point] |= count != 2;
    }
  }
  return boundary;
}

void checkDuplicates(const MeshData& data, const std::vector<DuplicateCell>& expected)
{
  const Mesh mesh(data.view());
  const std::vector<DuplicateCell> duplicates = findSkin(mesh).duplicates;
  TAUTLINE_CHECK_EQUAL(duplicates.size(), expected.size());
  for (std::size_t i = 0; i < duplicates.size() && i < expected.size(); ++i)
  {
    TAUTLINE_CHECK_EQUAL(duplicates[i].cell, expected[i].cell);
    TAUTLINE_CHECK_EQUAL(duplicates[i].original, expected[i].original);
  }
  const std::vector<char> boundary = expectedBoundary(data);
  TAUTLINE_CHECK(boundaryPoints(mesh) == boundary);
  TAUTLINE_CHECK(mesh.boundary().isBoundaryPoint == boundary);
}

TAUTLINE_PART(testDuplicates)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const MeshData data = block(type, 4);
    checkDuplicates(data, {});
    const Index cells = data.numberOfCells(), nodes = topology(type).nodes;
    const auto add = [&](MeshData& to, Index cell)
    {
      const auto first = data.connectivity.begin() + data.offsets[cell];
      to.addCell(type, std::vector<Index>(first, first + nodes));
    };
    // Each cell by itself: inside and on the boundary.
    for (Index cell = 0; cell < cells; cell += 1 + cells / 40)
    {
      MeshData one = data;
      add(one, cell);
      checkDuplicates(one, { { cells, cell } });
      // Listed in the opposite sense.
      const auto turn = [&]()
      {
        const Index kept = type == CellType::Pyramid ? 1 : 0; // the apex
        std::reverse(one.connectivity.end() - nodes, one.connectivity.end() - kept);
      };
      turn();
      checkDuplicates(one, { { cells, cell } });
      add(one, cell);
      turn();
      checkDuplicates(one, { { cells, cell }, { cells + 1, cell } });
    }
    // All cells, and the cells of a ball inside.
    MeshData twice = data, ball = data;
    std::vector<DuplicateCell> all, inside;
    const double half = 2.0;
    for (Index cell = 0; cell < cells; ++cell)
    {
      add(twice, cell);
      all.push_back({ cells + cell, cell });
      const Vec3 c = centerOf(data, cell);
      const double z = topology(type).dimension == 3 ? c[2] - half : 0.0;
      if (std::max({ std::abs(c[0] - half), std::abs(c[1] - half), std::abs(z) }) < 1)
      {
        inside.push_back({ ball.numberOfCells(), cell });
        add(ball, cell);
      }
    }
    TAUTLINE_CHECK(!inside.empty());
    checkDuplicates(twice, all);
    checkDuplicates(ball, inside);
  }
  // Triangles folded onto their neighbor share an edge with it, and are no duplicates.
  MeshData folded = block(CellType::Triangle, 3);
  const Index extra = folded.addPoint({ 1.2, 1.9, 0 });
  folded.addCell(CellType::Triangle, std::vector<Index>{ 5, 6, extra });
  checkDuplicates(folded, {});
}

/// Several threads find the same as one, in meshes large enough for them.
TAUTLINE_PART(testThreads)
{
  constexpr int several = 3;
  const MeshData whole = block(CellType::Quadrilateral, 360);
  const Mesh wholeMesh(whole.view());
  TAUTLINE_CHECK(numberOfParts(whole.numberOfPoints(), several) > 1);
  TAUTLINE_CHECK(!findCoincidentPoints(wholeMesh, nullptr, several).any());
  MeshData pieces = inQuarters(whole, 180.0).mesh;
  const CoincidentPoints one = findCoincidentPoints(Mesh(pieces.view()), nullptr, 1);
  const CoincidentPoints more = findCoincidentPoints(Mesh(pieces.view()), nullptr, several);
  TAUTLINE_CHECK_EQUAL(one.merged, 2 * 361 + 1);
  TAUTLINE_CHECK_EQUAL(more.merged, one.merged);
  TAUTLINE_CHECK(more.representative == one.representative);

  // One cell more at an edge: whatever the numbers of the points, both pairs are found.
  for (Index at : { 0, 1 })
  {
    MeshData one = whole;
    const double x = static_cast<double>(at);
    const Index first = one.addPoint({ x, 0, 0 });
    TAUTLINE_SET(one, addPoint({ x + 1, 0, 0 }), addPoint({ x, -1, 0 }), addPoint({ x + 1, -1, 0 }),
      addCell(
        CellType::Quadrilateral, std::vector<Index>{ first + 2, first + 3, first + 1, first }));
    const Mesh mesh(one.view());
    TAUTLINE_CHECK_EQUAL(findCoincidentPoints(mesh, nullptr, several).merged, 2);
  }

  // The corners of cells of one dimension only, in several parts.
  const Index free = pieces.addPoint({ -1, -1, -1 });
  const Index top = pieces.addPoint({ 0, 0, 1 });
  pieces.addCell(CellType::Tetrahedron, std::vector<Index>{ 0, 1, 2, top });
  const Mesh mesh(pieces.view());
  for (int threads : { 1, several })
  {
    for (int dimension : { 0, 2, 3 })
    {
      const std::vector<char> corners = cornerPoints(mesh, dimension, threads);
      const Index expected =
        dimension == 3 ? 4 : pieces.numberOfPoints() - (dimension == 2 ? 2 : 1);
      TAUTLINE_CHECK_EQUAL(std::count(corners.begin(), corners.end(), 1), expected);
      TAUTLINE_CHECK_EQUAL(int(corners[free]), 0);
      TAUTLINE_CHECK_EQUAL(int(corners[top]), int(dimension != 2));
    }
  }
}

/// Two pieces with the cells of each other as ghosts: these have no facets, and their points are
/// the faces of the cells that they are copies of.
TAUTLINE_PART(testGhosts)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const MeshData whole = block(type, 4);
    MeshData both = whole;
    append(both, whole);
    const Index cells = whole.numberOfCells(), points = whole.numberOfPoints();
    std::vector<unsigned char> ghosts(2 * cells, 0);
    for (Index cell = 0; cell < cells; ++cell)
    {
      const bool second = centerOf(whole, cell)[0] > 2;
      ghosts[cell + (second ? 0 : cells)] = 1;
    }
    const Mesh mesh(both.view());
    TAUTLINE_CHECK(findCoincidentPoints(mesh).apart() > 0);
    const CoincidentPoints merged = findCoincidentPoints(mesh, nullptr, 1, ghosts.data());
    TAUTLINE_CHECK_EQUAL(merged.apart(), 0);
    TAUTLINE_CHECK_EQUAL(merged.seams, 1);
    TAUTLINE_CHECK_EQUAL(merged.merged, points);
    for (Index p = 0; p < points && merged.any(); ++p)
    {
      TAUTLINE_CHECK_EQUAL(merged.representative[p + points], p);
    }
    TAUTLINE_CHECK_EQUAL(countForeignCells(mesh, ghosts.data()), 0);
    const Index second = std::count(ghosts.begin(), ghosts.begin() + cells, 1);
    TAUTLINE_CHECK_EQUAL(countForeignCells(Mesh(whole.view()), ghosts.data()), second);
  }
}
}
