// SPDX-License-Identifier: BSD-3-Clause
// Owners, neighbors and patches from the faces of cells.
#include "Blocks.h"
#include "FaceMeshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr double rounding = 1e-13;

/// A polyhedron of the faces of a cube, some of them turned.
ListedFaces turnedCube(const MeshData& data, unsigned turned)
{
  ListedFaces list = facesOf(data);
  for (Index face = 0; face + 1 < static_cast<Index>(list.faceOffsets.size()); ++face)
  {
    if ((turned >> face) & 1u)
    {
      std::reverse(list.nodes.begin() + list.faceOffsets[face],
        list.nodes.begin() + list.faceOffsets[face + 1]);
    }
  }
  return list;
}

MeshData cube()
{
  return singleCell(CellType::Hexahedron, idealCell(CellType::Hexahedron));
}
}

/// Each cell is closed, internal faces are in upper triangular order, and the volumes add up.
TAUTLINE_PART(testFacesOfBlocks)
{
  for (CellType type :
    { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    const Context context(topology(type).name);
    const MeshData data = blockMesh(type, 3, 4, 5);
    const FaceMesh mesh = faceMeshOf(data);
    const FaceMeasures measures(mesh, data.points.data(), FaceConvention::Esi);
    TAUTLINE_CHECK_EQUAL(mesh.cells, data.view().numberOfCells);
    TAUTLINE_CHECK_EQUAL(mesh.patches.size(), 1u);
    TAUTLINE_CHECK_EQUAL(mesh.patches[0].count, mesh.faces() - mesh.internalFaces);
    for (Index face = 0; face < mesh.internalFaces; ++face)
    {
      TAUTLINE_CHECK(mesh.owner[face] < mesh.neighbor[face]);
      TAUTLINE_CHECK(face == 0 || mesh.owner[face - 1] < mesh.owner[face] ||
        (mesh.owner[face - 1] == mesh.owner[face] &&
          mesh.neighbor[face - 1] < mesh.neighbor[face]));
    }
    TAUTLINE_CHECK(largestOf(measures.evaluate(Metric::Openness).cells) < rounding);
    double boundary = 0, volume = 0;
    for (Index face = mesh.internalFaces; face < mesh.faces(); ++face)
    {
      const FaceGeometry& g = measures.geometry();
      boundary += dot(g.area[face], g.center[face]) / 3; // Gauss
    }
    for (double v : measures.geometry().volume)
    {
      volume += v;
    }
    TAUTLINE_CHECK_RELATIVE(volume, boundary, rounding);
    TAUTLINE_CHECK(smallestOf(measures.evaluate(Metric::PyramidVolume).cells) > 0);
  }
}

/// Faces that are listed in any sense are turned so that the cell has the same positive volume.
TAUTLINE_PART(testTurnFaces)
{
  const MeshData data = cube();
  const double* points = data.points.data();
  for (unsigned turned = 1; turned < 63; ++turned)
  {
    ListedFaces list = turnedCube(data, turned);
    TAUTLINE_CHECK_EQUAL(turnFaces(list, 0, points).open, 0);
    const FaceMesh mesh = findFaces(8, list, {}, {});
    TAUTLINE_CHECK_NEAR(faceGeometry(mesh, points, FaceConvention::Esi).volume[0], 1, rounding);
  }
  // All faces turned agree with each other: this is an inverted cell, and stays one.
  ListedFaces list = turnedCube(data, 63);
  TAUTLINE_CHECK_EQUAL(turnFaces(list, 0, points).open, 0);
  const FaceMesh inverted = findFaces(8, list, {}, {});
  TAUTLINE_CHECK_NEAR(faceGeometry(inverted, points, FaceConvention::Esi).volume[0], -1, rounding);
  reverseFaces(list);
  const FaceMesh again = findFaces(8, list, {}, {});
  TAUTLINE_CHECK_NEAR(faceGeometry(again, points, FaceConvention::Esi).volume[0], 1, rounding);

  // Without one face the cell is open.
  list = turnedCube(data, 0);
  list.faceOffsets.pop_back();
  list.nodes.resize(list.faceOffsets.back());
  list.cellOffsets.back() = 5;
  TAUTLINE_CHECK_EQUAL(turnFaces(list, 0, points).open, 1);
}

/// Two facets at one face make it two faces of the boundary, each of the cell that it points out
/// of; one facet does not.
TAUTLINE_PART(testBaffle)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 1, 1);
  const FaceMesh plain = faceMeshOf(data);
  TAUTLINE_CHECK_EQUAL(plain.internalFaces, 1);
  std::vector<Index> nodes(plain.nodes.begin(), plain.nodes.begin() + plain.size(0));
  ListedFacets facets;
  addFacet(facets, nodes, 0);
  TAUTLINE_CHECK_EQUAL(
    findFaces(plain.points, facesOf(data), facets, { patchOf("a", "wall") }).internalFaces, 1);
  std::reverse(nodes.begin(), nodes.end());
  addFacet(facets, nodes, 1);
  const FaceMesh baffle =
    findFaces(plain.points, facesOf(data), facets, { patchOf("a", "wall"), patchOf("b", "wall") });
  TAUTLINE_CHECK_EQUAL(baffle.internalFaces, 0);
  TAUTLINE_CHECK_EQUAL(baffle.patches.size(), 3u);
  TAUTLINE_CHECK_EQUAL(baffle.owner[baffle.patches[0].first], 0);
  TAUTLINE_CHECK_EQUAL(baffle.owner[baffle.patches[1].first], 1);
  TAUTLINE_CHECK_EQUAL(baffle.facet[0], 0);
  TAUTLINE_CHECK_EQUAL(baffle.patches[2].count, 10);
  const FaceMeasures measures(baffle, data.points.data(), FaceConvention::Esi);
  TAUTLINE_CHECK(largestOf(measures.evaluate(Metric::Openness).cells) < rounding);

  // Pieces that were put together have both sides of what was their border.
  const FaceMesh closed = findFaces(
    plain.points, facesOf(data), facets, { patchOf("a", "processor"), patchOf("b", "processor") });
  TAUTLINE_CHECK_EQUAL(closed.internalFaces, 1);
  TAUTLINE_CHECK_EQUAL(closed.strayFacets, 0);

  // A facet that is no face of a cell is counted and left out.
  addFacet(facets, { 0, 1, 2 }, 0);
  TAUTLINE_CHECK_EQUAL(
    findFaces(plain.points, facesOf(data), facets, { patchOf("a", "wall"), patchOf("b", "wall") })
      .strayFacets,
    1);
}

TAUTLINE_PART(testOverlaps)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 1, 1);
  const MeshView view = data.view();
  const std::vector<Index> first(view.connectivity, view.connectivity + 8);
  data.addCell(CellType::Hexahedron, first);
  TAUTLINE_CHECK_THROWS(faceMeshOf(data), wording("remove-duplicate-and-overlapping-cells"));
}

/// Periodic in one direction: as in the middle of a row of three.
TAUTLINE_PART(testTranslatedPatches)
{
  const double tilt = 0.3;
  const auto sheared = [tilt](Vec3 p)
  {
    const double x = p[0] - std::floor(p[0] + 1e-9); // the same in each unit of length
    return Vec3{ p[0] + tilt * p[1] * p[1], p[1] + 0.1 * std::sin(2 * Pi * x), p[2] };
  };
  const auto coupledRow = [&](int units)
  {
    MeshData data = blockMesh(CellType::Hexahedron, 4 * units, 3, 2);
    data.transform([&](const Vec3& p) { return Vec3{ p[0] / 4, p[1] / 3, p[2] / 2 }; });
    const double length = largestX(data);
    const MeshData plain = data;
    const FaceMesh whole = faceMeshOf(data);
    ListedFacets facets;
    addFacets(facets, whole, 0, plain, [](const Vec3& p) { return p[0] < 1e-9; });
    addFacets(facets, whole, 1, plain, [=](const Vec3& p) { return p[0] > length - 1e-9; });
    data.transform(sheared);
    const FaceMesh mesh = findFaces(whole.points, facesOf(data), facets,
      { patchOf("left", "cyclic", 1), patchOf("right", "cyclic", 0) });
    return std::make_pair(data, mesh);
  };
  const auto one = coupledRow(1), three = coupledRow(3);
  for (Metric metric : { Metric::NonOrthogonality, Metric::FaceSkewness, Metric::FaceWeight,
         Metric::VolumeRatio, Metric::CellDeterminant, Metric::OrthogonalQuality,
         Metric::FanTetQuality, Metric::FaceTwist })
  {
    const Context context(metricInfo(metric).name);
    const auto values = [metric](const std::pair<MeshData, FaceMesh>& of)
    {
      return FaceMeasures(of.second, of.first.points.data(), FaceConvention::Esi)
        .evaluate(metric)
        .cells;
    };
    std::vector<double> alone = values(one), inRow = values(three);
    std::sort(alone.begin(), alone.end());
    std::sort(inRow.begin(), inRow.end());
    TAUTLINE_EACH(std::size_t, i, alone.size(), TAUTLINE_CHECK_NEAR(alone[i], inRow[3 * i], 1e-9));
  }
  const FaceMeasures measures(one.second, one.first.points.data(), FaceConvention::Esi);
  const MeshCheckReport report = checkMesh(measures, one.first.points.data());
  TAUTLINE_CHECK_EQUAL(report[MeshCheckKind::CoupledPoints].offending, 0);
  // Patches of other sizes are not coupled.
  TAUTLINE_CHECK(one.second.coupled(one.second.patches[0].first) >= 0);
}

/// A sector of a ring, coupled with itself by a rotation, is measured as the ring.
TAUTLINE_PART(testRotatedPatches)
{
  const int around = 3, sectors = 4;
  const auto bent = [&](double perUnit)
  {
    return [=](const Vec3& p)
    {
      const double angle = perUnit * p[0], radius = 1 + p[1] + 0.2 * p[1] * p[1];
      return Vec3{ radius * std::cos(angle), radius * std::sin(angle), p[2] + 0.1 * p[1] };
    };
  };
  const double step = 2 * Pi / (around * sectors);
  MeshData sector = blockMesh(CellType::Hexahedron, around, 2, 2);
  const double length = largestX(sector), perUnit = around * step / length;
  const FaceMesh whole = faceMeshOf(sector);
  ListedFacets facets;
  addFacets(facets, whole, 0, sector, [](const Vec3& p) { return p[0] < 1e-9; });
  addFacets(facets, whole, 1, sector, [=](const Vec3& p) { return p[0] > length - 1e-9; });
  sector.transform(bent(perUnit));
  const FaceMesh coupled = findFaces(whole.points, facesOf(sector), facets,
    { patchOf("start", "cyclic", 1), patchOf("end", "cyclic", 0) });
  // Three sectors in a row; the cells of the middle one have all neighbors.
  MeshData row = blockMesh(CellType::Hexahedron, 3 * around, 2, 2);
  row.transform(
    [&](const Vec3& p) {
      return bent(perUnit)({ p[0] * 3 * length / largestX(row), p[1], p[2] });
    });
  for (Metric metric : { Metric::NonOrthogonality, Metric::FaceSkewness, Metric::FaceWeight,
         Metric::VolumeRatio, Metric::CellDeterminant })
  {
    const Context context(metricInfo(metric).name);
    const FaceMeasures measures(coupled, sector.points.data(), FaceConvention::Esi);
    const std::vector<double> alone = measures.evaluate(metric).cells;
    const std::vector<double> inRow = faceMetricOf(row, metric);
    for (double value : alone)
    {
      const bool found = std::any_of(
        inRow.begin(), inRow.end(), [=](double v) { return std::abs(v - value) < 1e-9; });
      TAUTLINE_CHECK(found);
    }
  }
}

/// A plane mesh as one layer has the volumes of its areas, and open sides only at its edge.
TAUTLINE_PART(testExtrusion)
{
  // A pentagon on a triangle.
  const std::vector<Vec3> corners = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 1, 2, 0 },
    { 0, 1, 0 }, { 3, 2, 0 } };
  std::vector<double> points;
  for (double z : { 0.0, 0.5 })
  {
    for (const Vec3& p : corners)
    {
      points.insert(points.end(), { p[0], p[1], z });
    }
  }
  ListedFacets facets;
  const ListedFaces list = extrude(6, { { 0, 1, 2, 3, 4 }, { 2, 5, 3 } }, facets);
  const FaceMesh mesh =
    findFaces(12, list, facets, { patchOf("below", "empty"), patchOf("above", "empty") });
  const FaceMeasures measures(mesh, points.data(), FaceConvention::Esi);
  TAUTLINE_CHECK_EQUAL(mesh.internalFaces, 1);
  TAUTLINE_CHECK_NEAR(measures.geometry().volume[0], 0.5 * 3, rounding);
  TAUTLINE_CHECK_NEAR(measures.geometry().volume[1], 0.5 * 1, rounding);
  TAUTLINE_CHECK_EQUAL(measures.directions().count(), 2);
  TAUTLINE_CHECK(!measures.directions().geometric[2]);
  TAUTLINE_CHECK_EQUAL(
    checkMesh(measures, points.data())[MeshCheckKind::EdgeAlignment].offending, 0);
}

/// One layer of cells has two sides; a cube and a row of cells have several pairs, and so none.
TAUTLINE_PART(testMarkLayer)
{
  MeshData data = blockMesh(CellType::Hexahedron, 3, 2, 1);
  FaceMesh mesh = faceMeshOf(data);
  const FaceMesh before = mesh;
  TAUTLINE_CHECK_EQUAL(markLayerAlone(mesh, data), 2);
  TAUTLINE_CHECK_EQUAL(mesh.patches.size(), 2u);
  TAUTLINE_CHECK(mesh.patches[0].isEmpty());
  TAUTLINE_CHECK_EQUAL(mesh.patches[0].count, 12);
  TAUTLINE_CHECK_EQUAL(mesh.faces(), before.faces());
  for (Index face = mesh.patches[0].first; face < mesh.faces(); ++face)
  {
    const FaceGeometry g = faceGeometry(mesh, data.points.data(), FaceConvention::Esi);
    const bool side = face < mesh.patches[1].first;
    TAUTLINE_CHECK_NEAR(std::abs(g.area[face][2]), side ? 1 : 0, rounding);
  }
  const FaceMeasures measures(mesh, data.points.data(), FaceConvention::Esi);
  TAUTLINE_CHECK(largestOf(measures.evaluate(Metric::Openness).cells) < rounding);
  TAUTLINE_CHECK_EQUAL(measures.directions().count(), 2);
  for (const auto& size : { std::array<Index, 3>{ 1, 1, 1 }, { 3, 1, 1 }, { 2, 2, 2 } })
  {
    const MeshData other = blockMesh(CellType::Hexahedron, size[0], size[1], size[2]);
    FaceMesh none = faceMeshOf(other);
    TAUTLINE_CHECK_EQUAL(markLayerAlone(none, other), -1);
    TAUTLINE_CHECK_EQUAL(none.patches.size(), 1u);
  }
}

/// Polygons that all run clockwise are turned, others stay.
TAUTLINE_PART(testTurnPolygons)
{
  const std::vector<double> points = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 };
  const std::vector<std::vector<Index>> right = { { 0, 1, 2, 3 } };
  std::vector<std::vector<Index>> cells = right;
  turnPolygons(cells, points.data());
  TAUTLINE_CHECK(cells == right);
  cells = { { 3, 2, 1, 0 } };
  turnPolygons(cells, points.data());
  TAUTLINE_CHECK(cells == right);
}
