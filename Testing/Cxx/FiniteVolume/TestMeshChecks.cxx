// SPDX-License-Identifier: BSD-3-Clause
// The checks of checkMesh, one defect at a time. The tutorials of OpenFOAM compare all with its own
// (Testing/OpenFoam).
#include "Blocks.h"
#include "FaceMeshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
MeshCheckReport reportOf(
  const MeshData& data, const FaceMesh& mesh, const MeshCheckFacts& facts = {})
{
  const FaceMeasures measures(mesh, data.points.data(), FaceConvention::Esi);
  return checkMesh(measures, data.points.data(), facts);
}

MeshCheckReport reportOf(const MeshData& data)
{
  const FaceMesh mesh = faceMeshOf(data);
  return reportOf(data, mesh);
}

/// A layer of cells between two "empty" patches.
MeshCheckReport layerReport(const MeshData& data)
{
  const FaceMesh whole = faceMeshOf(data);
  ListedFacets facets;
  addFacets(facets, whole, 0, data, [](const Vec3& p) { return p[2] < 0.5; });
  addFacets(facets, whole, 0, data, [](const Vec3& p) { return p[2] > 0.5; });
  const FaceMesh mesh =
    findFaces(whole.points, facesOf(data), facets, { patchOf("sides", "empty") });
  return reportOf(data, mesh);
}
}

TAUTLINE_PART(testGoodMesh)
{
  for (CellType type :
    { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    const MeshCheckReport report = reportOf(blockMesh(type, 3, 3, 3));
    TAUTLINE_CHECK_EQUAL(report.failed(false), 0);
    TAUTLINE_CHECK_EQUAL(report.verdict(false), wording("mesh-ok"));
    TAUTLINE_CHECK_EQUAL(
      std::count_if(report.faces.begin(), report.faces.end(), [](auto bits) { return bits != 0; }),
      0);
  }
  // Each check has its place and a name of its own.
  const std::vector<MeshCheck> checks = emptyMeshChecks();
  std::set<std::string> names;
  for (std::size_t i = 0; i < checks.size(); ++i)
  {
    TAUTLINE_CHECK_EQUAL(static_cast<std::size_t>(checks[i].kind), i);
    names.insert(checks[i].name);
  }
  TAUTLINE_CHECK_EQUAL(names.size(), static_cast<std::size_t>(MeshCheckKind::Number));
}

TAUTLINE_PART(testTopology)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 2, 2);
  data.addPoint({ 9, 9, 9 });
  MeshCheckFacts facts;
  facts.facesOutOfOrder = 3;
  const FaceMesh mesh = faceMeshOf(data);
  const MeshCheckReport report = reportOf(data, mesh, facts);
  TAUTLINE_CHECK_EQUAL(report[MeshCheckKind::UnusedPoints].offending, 1);
  TAUTLINE_CHECK_EQUAL(report[MeshCheckKind::FaceOrder].offending, 3);
  TAUTLINE_CHECK_EQUAL(report.failed(false), 2);
  TAUTLINE_CHECK_EQUAL(report.verdict(false), wording("failed-2-mesh-checks"));

  // A cube without a face is open; the check of its edges is made on request.
  MeshData one = blockMesh(CellType::Hexahedron, 1, 1, 1);
  ListedFaces list = facesOf(one);
  list.faceOffsets.pop_back();
  list.nodes.resize(list.faceOffsets.back());
  list.cellOffsets.back() = 5;
  const MeshCheckReport open = reportOf(one, findFaces(8, list, {}, {}));
  TAUTLINE_CHECK_EQUAL(open[MeshCheckKind::OpenCells].offending, 1);
  TAUTLINE_CHECK(open[MeshCheckKind::OpenCells].thorough);
  TAUTLINE_CHECK_EQUAL(open[MeshCheckKind::CellOpenness].offending, 1);
  TAUTLINE_CHECK_EQUAL(open[MeshCheckKind::BoundaryOpenness].offending, 1);
  TAUTLINE_CHECK(open.failed(true) > open.failed(false));
}

/// Sheared until faces are severely non-orthogonal, which is a warning; then folded.
TAUTLINE_PART(testNonOrthogonality)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 2, 2);
  data.transform([](const Vec3& p) { return Vec3{ p[0] + 3 * p[1], p[1], p[2] }; });
  const MeshCheckReport severe = reportOf(data);
  // Four inner faces across x and four across y, all by the same angle.
  TAUTLINE_CHECK_EQUAL(severe[MeshCheckKind::NonOrthogonality].warned, 8);
  TAUTLINE_CHECK_NEAR(
    severe[MeshCheckKind::NonOrthogonality].most, std::atan(3) * DegreesPerRadian, 1e-9);
  TAUTLINE_CHECK_EQUAL(severe[MeshCheckKind::NonOrthogonality].offending, 0);
  TAUTLINE_CHECK(!severe[MeshCheckKind::NonOrthogonality].failed());

  MeshData folded = blockMesh(CellType::Hexahedron, 2, 2, 2);
  folded.setPoint(13, { 2.5, 2.5, 2.5 }); // the middle one
  const MeshCheckReport report = reportOf(folded);
  TAUTLINE_CHECK(report[MeshCheckKind::PyramidVolume].failed());
  TAUTLINE_CHECK(report[MeshCheckKind::FaceTets].failed());
  // Offending cells are marked.
  const std::uint32_t bit = 1u << static_cast<int>(MeshCheckKind::PyramidVolume);
  const auto marked = std::count_if(
    report.faces.begin(), report.faces.end(), [bit](std::uint32_t bits) { return bits & bit; });
  TAUTLINE_CHECK(marked > 0 && marked <= report[MeshCheckKind::PyramidVolume].offending);
}

TAUTLINE_PART(testSizes)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 1, 1);
  data.transform([](const Vec3& p) { return Vec3{ p[0] > 1.5 ? 1001.0 : p[0], p[1], p[2] }; });
  const MeshCheckReport report = reportOf(data);
  TAUTLINE_CHECK_EQUAL(report[MeshCheckKind::FaceWeight].offending, 1);
  TAUTLINE_CHECK_EQUAL(report[MeshCheckKind::VolumeRatio].offending, 1);
  TAUTLINE_CHECK_EQUAL(report[MeshCheckKind::CellAspectRatio].offending, 0);
  MeshData longer = blockMesh(CellType::Hexahedron, 1, 1, 1);
  longer.transform([](const Vec3& p) { return Vec3{ 1001 * p[0], p[1], p[2] }; });
  TAUTLINE_CHECK_EQUAL(reportOf(longer)[MeshCheckKind::CellAspectRatio].offending, 1);
}

/// Sides that are askew of each other.
TAUTLINE_PART(testLayers)
{
  MeshData data = blockMesh(CellType::Hexahedron, 3, 3, 1);
  TAUTLINE_CHECK_EQUAL(layerReport(data).failed(false), 0);
  TAUTLINE_CHECK_NEAR(layerReport(data)[MeshCheckKind::CellDeterminant].most, 0.5, 1e-12);
  data.transform([](const Vec3& p) { return Vec3{ p[0] + 0.1 * p[2], p[1], p[2] }; });
  const MeshCheckReport report = layerReport(data);
  TAUTLINE_CHECK_EQUAL(report[MeshCheckKind::EdgeAlignment].offending, 16);
  TAUTLINE_CHECK_EQUAL(report.failed(false), 1);
}

/// Coupled faces list their points in opposite order, from corresponding points on.
TAUTLINE_PART(testCoupledPoints)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 2, 2);
  const FaceMesh whole = faceMeshOf(data);
  ListedFacets left;
  addFacets(left, whole, 0, data, [](const Vec3& p) { return p[0] < 0.5; });
  const Index faces = static_cast<Index>(left.patch.size());
  TAUTLINE_CHECK_EQUAL(faces, 4);
  const auto offending = [&](Index firstOfLast)
  {
    ListedFacets facets = left;
    for (Index face = 0; face < faces; ++face)
    {
      std::vector<Index> nodes(4);
      for (Index k = 0; k < 4; ++k)
      {
        nodes[(4 - k) % 4] = left.nodes[4 * face + k] + 2; // on the other side of the block
      }
      std::rotate(
        nodes.begin(), nodes.begin() + (face == faces - 1 ? firstOfLast : 0), nodes.end());
      addFacet(facets, nodes, 1);
    }
    const FaceMesh mesh = findFaces(whole.points, facesOf(data), facets,
      { patchOf("left", "cyclic", 1), patchOf("right", "cyclic", 0) });
    const MeshCheckReport report = reportOf(data, mesh);
    TAUTLINE_CHECK_EQUAL(report[MeshCheckKind::CoupledPoints].offending, report.failed(false));
    return report[MeshCheckKind::CoupledPoints].offending;
  };
  TAUTLINE_CHECK_EQUAL(offending(0), 0);
  TAUTLINE_CHECK_EQUAL(offending(2), 1);
}
