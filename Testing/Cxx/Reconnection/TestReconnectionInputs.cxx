// SPDX-License-Identifier: BSD-3-Clause
// improveConnectivity() with input it rejects, and with input at the limits of what it takes.

#include "Reconnecting.h"
#include "Registry.h"

using namespace tautline;

namespace
{
TAUTLINE_PART(testRejections)
{
  const ReconnectionOptions defaults;
  MeshData mixed = blockMesh(CellType::Tetrahedron, 2, 2, 2);
  mixed.addCell(CellType::Hexahedron, idealCell(CellType::Hexahedron));
  TAUTLINE_CHECK_THROWS(reconnect(mixed, defaults), wording("1-cells-are-not-tetrahedra"));
  TAUTLINE_CHECK_THROWS(reconnect(blockMesh(CellType::Triangle, 2, 2, 0), defaults),
    wording("8-cells-are-not-tetrahedra"));
  MeshData line = blockMesh(CellType::Tetrahedron, 1, 1, 1);
  constexpr int vtkLine = 3;
  line.addCell(vtkLine, { 0, 1 });
  TAUTLINE_CHECK_THROWS(reconnect(line, defaults), wording("1-cells-are-not-tetrahedra"));

  MeshData inverted = blockMesh(CellType::Tetrahedron, 2, 2, 2);
  std::swap(inverted.connectivity[4], inverted.connectivity[5]);
  TAUTLINE_CHECK_THROWS(
    reconnect(inverted, defaults), wording("1-inverted-or-degenerate-tetrahedra"));
  TAUTLINE_CHECK_THROWS(reconnect(inverted, defaults), wording("untangle-mesh"));
  MeshData flat = blockMesh(CellType::Tetrahedron, 2, 2, 2);
  flat.addCell(CellType::Tetrahedron, std::vector<Index>{ 0, 1, 2, 2 });
  TAUTLINE_CHECK_THROWS(reconnect(flat, defaults), "degenerate");

  for (double value :
    { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
  {
    MeshData data = TAUTLINE_CHANGED(blockMesh(CellType::Tetrahedron, 2, 2, 2), points[7] = value);
    TAUTLINE_CHECK_THROWS(reconnect(data, defaults), wording("nan-or-infinite"));
  }

  MeshData twice = blockMesh(CellType::Tetrahedron, 2, 2, 2);
  twice.addCell(CellType::Tetrahedron,
    std::vector<Index>(twice.connectivity.begin(), twice.connectivity.begin() + 4));
  TAUTLINE_CHECK_THROWS(reconnect(twice, defaults), wording("three-or-more"));
  MeshData alone = singleCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron));
  alone.addCell(CellType::Tetrahedron, std::vector<Index>{ 0, 1, 2, 3 });
  TAUTLINE_CHECK_THROWS(reconnect(alone, defaults), wording("same-side"));
  MeshData overlapping = singleCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron));
  overlapping.addPoint({ 0.4, 0.3, 0.7 });
  overlapping.addCell(CellType::Tetrahedron, std::vector<Index>{ 0, 1, 2, 4 });
  TAUTLINE_CHECK_THROWS(reconnect(overlapping, defaults), wording("same-side"));
}

TAUTLINE_PART(testOptions)
{
  const MeshData data = blockMesh(CellType::Tetrahedron, 2, 2, 2);
  const auto rejected = [&](const auto& change, const char* text)
  {
    ReconnectionOptions options;
    change(options);
    TAUTLINE_CHECK_THROWS(reconnect(data, options), text);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double angle : { 0.0, -1.0, 61.0, nan })
  {
    rejected([&](ReconnectionOptions& o) { o.targetAngle = angle; }, "target angle");
  }
  for (double count : { -0.1, 1.1, nan })
  {
    rejected([&](ReconnectionOptions& o) { o.smallestCount = count; }, "smallest count");
  }
  for (double count : { 0.9, nan, std::numeric_limits<double>::infinity() })
  {
    rejected([&](ReconnectionOptions& o) { o.largestCount = count; }, "largest count");
  }
  for (double angle : { -0.1, 1.1, nan })
  {
    rejected([&](ReconnectionOptions& o) { o.flatAngle = angle; }, "flat angle");
  }
  rejected([](ReconnectionOptions& o) { o.maximumSeconds = -1; }, "time limit");
}

TAUTLINE_PART(testSmall)
{
  TAUTLINE_LET(ReconnectionOptions, options, smallestCount = 0.0, largestCount = 100.0);
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    options.boundary = boundary;
    const ReconnectionResult empty = reconnect(MeshData(), options);
    TAUTLINE_CHECK(empty.points.empty() && empty.tetrahedra.empty() && empty.history.empty());
    TAUTLINE_LET(MeshData, unused, addPoint({ 1, 2, 3 }));
    TAUTLINE_CHECK(reconnect(unused, options).points == unused.points);

    MeshData one = singleCell(
      CellType::Tetrahedron, { { 0, 0, 0 }, { 1, 0, 0 }, { 0.3, 1, 0 }, { 0.4, 0.4, 0.05 } });
    one.addPoint({ 9, 9, 9 }); // of no cell
    const ReconnectionResult result = reconnect(one, options);
    checkResult(one, result);
    TAUTLINE_CHECK(
      boundary != BoundaryMotion::Fixed || outerFacets(outputOf(result)) == outerFacets(one));
    TAUTLINE_CHECK(std::count(result.originalPoints.begin(), result.originalPoints.end(), 4) == 1);

    // Everything is fixed, and no operation may change anything.
    const MeshData block = sliverBlock(3, 3, 1.0);
    const std::vector<unsigned char> fixed(block.numberOfPoints(), 1);
    ReconnectionOptions nothing = options;
    TAUTLINE_SET(nothing, fixed = fixed.data(), swap = nothing.insert = nothing.contract = false);
    const ReconnectionResult kept = reconnect(block, nothing);
    TAUTLINE_CHECK(kept.points == block.points && kept.tetrahedra == block.connectivity);
    nothing.swap = nothing.insert = nothing.contract = true;
    const ReconnectionResult swapped = reconnect(block, nothing);
    checkResult(block, swapped);
    TAUTLINE_CHECK(std::equal(block.points.begin(), block.points.end(), swapped.points.begin()));
  }
}

/// Two blocks that share one vertex or one edge, or lie beside each other with points of their own:
/// the boundary is not manifold at the shared points.
TAUTLINE_PART(testNonManifold)
{
  for (const Vec3& shift : { Vec3{ 3, 3, 3 }, Vec3{ 3, 3, 0 }, Vec3{ 3, 0, 0 } })
  {
    MeshData data = sliverBlock(3, 3, 1.0);
    const MeshData other = sliverBlock(3, 4, 1.0);
    const bool glue = shift[1] != 0.0;
    std::vector<Index> ids;
    for (Index i = 0; i < other.numberOfPoints(); ++i)
    {
      const Vec3 p = other.point(i) + shift;
      Index same = -1;
      for (Index k = 0; glue && k < 64; ++k)
      {
        same = data.point(k) == p ? k : same;
      }
      ids.push_back(same >= 0 ? same : data.addPoint(p));
    }
    for (Index c = 0; c < other.numberOfCells(); ++c)
    {
      const Index* v = &other.connectivity[4 * c];
      data.addCell(
        CellType::Tetrahedron, std::vector<Index>{ ids[v[0]], ids[v[1]], ids[v[2]], ids[v[3]] });
    }
    for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
    {
      TAUTLINE_LET(ReconnectionOptions, options, boundary = boundary);
      const ReconnectionResult result = reconnect(data, options);
      checkResult(data, result);
      TAUTLINE_CHECK(result.history.back().smallestAngle > result.history.front().smallestAngle);
      if (boundary == BoundaryMotion::Fixed)
      {
        TAUTLINE_CHECK(outerFacets(outputOf(result)) == outerFacets(data));
      }
      // Points shared by the blocks stay at their place.
      const MeshData output = outputOf(result);
      for (std::size_t i = 0; glue && i < result.originalPoints.size(); ++i)
      {
        const Index original = result.originalPoints[i];
        if (std::count(ids.begin(), ids.end(), original) == 1 && original < 64 && original >= 0)
        {
          TAUTLINE_CHECK(output.point(static_cast<Index>(i)) == data.point(original));
        }
      }
    }
  }
}

/// Regions in the pattern of a chessboard meet at edges and at a point; each keeps its facets.
TAUTLINE_PART(testRegionsAtPoint)
{
  const MeshData data = sliverBlock(4, 6, 1.0);
  std::vector<Index> regions;
  const MeshData plain = blockMesh(CellType::Tetrahedron, 4, 4, 4);
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Vec3 m = Mesh(plain.view()).center(c, CellType::Tetrahedron);
    regions.push_back(((m[0] < 2) + (m[1] < 2) + (m[2] < 2)) % 2);
  }
  for (Index blockSize : { data.numberOfCells(), data.numberOfCells() / 4 })
  {
    TAUTLINE_LET(ReconnectionOptions, options, regions = regions.data(), blockSize = blockSize);
    const ReconnectionResult result = reconnect(data, options);
    checkResult(data, result);
    TAUTLINE_CHECK(result.history.back().edgeRemovals > 0);
    auto after =
      collect<Index>(result.originalCells, [&](Index original) { return regions[original]; });
    for (Index region : { 0, 1 })
    {
      TAUTLINE_CHECK(
        outerFacets(outputOf(result), after, region) == outerFacets(data, regions, region));
    }
  }
}

/// How many cells have each facet, by the coordinates of its corners.
std::map<std::array<Vec3, 3>, int> usesOfFacets(const MeshData& data)
{
  constexpr int faces[4][3] = { { 1, 2, 3 }, { 0, 2, 3 }, { 0, 1, 3 }, { 0, 1, 2 } };
  std::map<std::array<Vec3, 3>, int> uses;
  for (Index n = 0; n < 4 * data.numberOfCells(); ++n)
  {
    const Index* v = &data.connectivity[4 * (n / 4)];
    const int* f = faces[n % 4];
    std::array<Vec3, 3> key = { data.point(v[f[0]]), data.point(v[f[1]]), data.point(v[f[2]]) };
    std::sort(key.begin(), key.end());
    ++uses[key];
  }
  return uses;
}

/// Facets of the plane x = 2 that are marked are kept, whether they divide the mesh, end inside it
/// or reach its surface; without marks some of them are lost.
TAUTLINE_PART(testMarkedFacets)
{
  const MeshData plain = blockMesh(CellType::Tetrahedron, 4, 4, 4), data = sliverBlock(4, 6, 1.0);
  constexpr int faces[4][3] = { { 1, 2, 3 }, { 0, 2, 3 }, { 0, 1, 3 }, { 0, 1, 2 } };
  for (double low : { 0.0, 1.0 })
  {
    for (double high : { 3.0, 4.0 })
    {
      std::vector<std::array<Index, 3>> marked;
      std::set<std::array<Vec3, 3>> keys;
      for (Index n = 0; n < 4 * data.numberOfCells(); ++n)
      {
        const Index* v = &data.connectivity[4 * (n / 4)];
        const std::array<Index, 3> f = { v[faces[n % 4][0]], v[faces[n % 4][1]],
          v[faces[n % 4][2]] };
        const bool within = std::all_of(f.begin(), f.end(),
          [&](Index p)
          {
            const Vec3 x = plain.point(p);
            return x[0] == 2.0 && x[1] >= low && x[1] <= high && x[2] >= low && x[2] <= high;
          });
        std::array<Vec3, 3> key = { data.point(f[0]), data.point(f[1]), data.point(f[2]) };
        std::sort(key.begin(), key.end());
        if (within && keys.insert(key).second)
        {
          marked.push_back(f);
        }
      }
      const auto lostOf = [&](const ReconnectionResult& result)
      {
        const auto uses = usesOfFacets(outputOf(result));
        return std::count_if(keys.begin(), keys.end(),
          [&](const auto& key)
          {
            const auto found = uses.find(key);
            return found == uses.end() || found->second != 2;
          });
      };
      for (auto boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
      {
        for (Index blockSize : { data.numberOfCells(), data.numberOfCells() / 4 })
        {
          TAUTLINE_LET(ReconnectionOptions, options, boundary = boundary, blockSize = blockSize);
          TAUTLINE_CHECK(lostOf(reconnect(data, options)) > 0);
          options.markedFacets = marked;
          options.markedFacets.push_back({ 0, 1, 124 }); // no facet: without effect
          const ReconnectionResult result = reconnect(data, options);
          checkResult(data, result);
          TAUTLINE_CHECK_EQUAL(result.markedFacets, static_cast<Index>(keys.size()));
          TAUTLINE_CHECK_EQUAL(lostOf(result), 0);
          TAUTLINE_CHECK(result.history.back().edgeRemovals > 0);
        }
      }
      TAUTLINE_LET(
        ReconnectionOptions, options, markedFacets = marked, boundary = BoundaryMotion::OnSurface);
      TAUTLINE_CHECK_EQUAL(lostOf(reconnect(data, options)), 0);
      options.markedFacets = { { 0, 1, data.numberOfPoints() } };
      TAUTLINE_CHECK_THROWS(reconnect(data, options), wording("does-not-have"));
    }
  }
}

/// One layer of cells: every cavity touches the boundary on two sides.
TAUTLINE_PART(testThinPlate)
{
  MeshData data = blockMesh(CellType::Tetrahedron, 8, 8, 1);
  Random random(2);
  data.transform(
    [&](const Vec3& p)
    {
      const bool rim = p[0] == 0.0 || p[0] == 8.0 || p[1] == 0.0 || p[1] == 8.0;
      const Vec3 d = random.vector(-0.2, 0.2);
      return rim ? p : p + Vec3{ d[0], d[1], 0.0 };
    });
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    TAUTLINE_LET(ReconnectionOptions, options, boundary = boundary);
    const ReconnectionResult result = reconnect(data, options);
    checkResult(data, result);
    if (boundary == BoundaryMotion::Fixed)
    {
      TAUTLINE_CHECK(outerFacets(outputOf(result)) == outerFacets(data));
    }
    else
    {
      TAUTLINE_CHECK(result.history.back().worstQuality > result.history.front().worstQuality);
    }
  }
}

/// Points at the same place in two parts that touch: both parts stay as they are there.
TAUTLINE_PART(testDuplicatePoints)
{
  MeshData data = sliverBlock(3, 3, 1.0);
  const Index first = data.numberOfPoints();
  const MeshData other = sliverBlock(3, 4, 1.0);
  for (Index i = 0; i < other.numberOfPoints(); ++i)
  {
    data.addPoint(other.point(i) + Vec3{ 3, 0, 0 });
  }
  for (Index c = 0; c < other.numberOfCells(); ++c)
  {
    const Index* v = &other.connectivity[4 * c];
    data.addCell(CellType::Tetrahedron,
      std::vector<Index>{ v[0] + first, v[1] + first, v[2] + first, v[3] + first });
  }
  const ReconnectionResult result = reconnect(data, {});
  checkResult(data, result);
  TAUTLINE_CHECK(result.history.back().smallestAngle > result.history.front().smallestAngle);
  TAUTLINE_CHECK(outerFacets(outputOf(result)) == outerFacets(data));
}

/// All cells listed in the opposite order: so is the result.
TAUTLINE_PART(testMirrored)
{
  const MeshData data = sliverBlock(4, 5, 1.0);
  MeshData reversed = data;
  for (std::size_t i = 0; i < reversed.connectivity.size(); i += 4)
  {
    std::swap(reversed.connectivity[i + 2], reversed.connectivity[i + 3]);
  }
  TAUTLINE_CHECK_THROWS(reconnect(reversed, {}), "reversed");
  Mesh mesh(reversed.view());
  mesh.setMirrored(true);
  const ReconnectionResult result = improveConnectivity(mesh, {});
  ReconnectionResult expected = reconnect(data, {});
  for (std::size_t i = 0; i < expected.tetrahedra.size(); i += 4)
  {
    std::swap(expected.tetrahedra[i + 2], expected.tetrahedra[i + 3]);
  }
  TAUTLINE_CHECK(result.tetrahedra == expected.tetrahedra && result.points == expected.points);
}
}
