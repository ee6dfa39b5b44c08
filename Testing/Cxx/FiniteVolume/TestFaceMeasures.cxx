// SPDX-License-Identifier: BSD-3-Clause
// Metrics of finite volumes: known values, invariances, bad cells.
#include "Blocks.h"
#include "FaceMeshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr double rounding = 1e-12;

/// A prism of height 1 over a polygon.
MeshData prism(const std::vector<Vec3>& corners, FaceMesh& mesh)
{
  MeshData data;
  std::vector<Index> cell;
  for (double z : { 0.0, 1.0 })
  {
    for (const Vec3& p : corners)
    {
      data.addPoint({ p[0], p[1], z });
    }
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    cell.push_back(static_cast<Index>(i));
  }
  ListedFacets facets;
  const ListedFaces list = extrude(static_cast<Index>(corners.size()), { cell }, facets);
  mesh = findFaces(2 * static_cast<Index>(corners.size()), list, {}, {});
  return data;
}

/// The quality of a tetrahedron with the radius from the lengths of its edges (Crelle).
double tetQualityByEdges(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const double volume = dot(b - a, cross(c - a, d - a)) / 6;
  const double x = norm(b - a) * norm(d - c), y = norm(c - a) * norm(d - b),
               z = norm(d - a) * norm(c - b), s = (x + y + z) / 2;
  const double radius = std::sqrt(s * (s - x) * (s - y) * (s - z)) / (6 * std::abs(volume));
  return volume / (8 / (9 * std::sqrt(3.0)) * radius * radius * radius);
}
}

TAUTLINE_PART(testCubes)
{
  const MeshData data = blockMesh(CellType::Hexahedron, 3, 3, 3);
  const Index middle = 13;
  const auto at = [&](Metric metric) { return faceMetricOf(data, metric)[middle]; };
  TAUTLINE_CHECK_NEAR(at(Metric::NonOrthogonality), 0, 1e-5);
  TAUTLINE_CHECK_NEAR(at(Metric::FaceSkewness), 0, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::OrthogonalQuality), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::FaceWeight), 0.5, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::VolumeRatio), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::PyramidVolume), 1.0 / 6, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::FaceArea), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::FaceFlatness), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::FaceConcavity), 0, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::FaceTwist), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::CellVolume), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::Openness), 0, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::CellAspectRatio), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::CellDeterminant), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::AreaDeterminant), 1, rounding);
  TAUTLINE_CHECK_NEAR(at(Metric::CellConcavity), -std::sqrt(0.5), rounding);
  // Written by checkMesh of OpenFOAM v1912 for cubes.
  TAUTLINE_CHECK_NEAR(at(Metric::CenterTetQuality), 0.464758001545, 1e-12);
  TAUTLINE_CHECK_NEAR(at(Metric::FanTetQuality),
    tetQualityByEdges({ 0.5, 0.5, 0.5 }, { 0, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 }), rounding);
  // In the corner, only three faces have another cell.
  TAUTLINE_CHECK_NEAR(faceMetricOf(data, Metric::CellDeterminant)[0], 1.0 / 8, rounding);
}

TAUTLINE_PART(testShearedAndStretched)
{
  MeshData data = blockMesh(CellType::Hexahedron, 3, 3, 3);
  const double shear = 0.7;
  data.transform([=](const Vec3& p) { return Vec3{ p[0] + shear * p[1], p[1], p[2] }; });
  const double angle = std::atan(shear);
  TAUTLINE_CHECK_NEAR(
    faceMetricOf(data, Metric::NonOrthogonality)[13], angle * DegreesPerRadian, 1e-9);
  TAUTLINE_CHECK_NEAR(faceMetricOf(data, Metric::OrthogonalQuality)[13], std::cos(angle), rounding);
  TAUTLINE_CHECK_NEAR(faceMetricOf(data, Metric::InternalSkewness)[13], 0, rounding);
  // From the foot of the center of the cell to the center of the face: 0.35 in a face of width 1.
  TAUTLINE_CHECK_NEAR(faceMetricOf(data, Metric::BoundarySkewness)[0], 0.5 * shear / 0.5, rounding);

  MeshData stretched = blockMesh(CellType::Hexahedron, 2, 1, 1);
  stretched.transform([](const Vec3& p) { return Vec3{ p[0] < 1.5 ? p[0] : 4.0, p[1], p[2] }; });
  TAUTLINE_CHECK_NEAR(faceMetricOf(stretched, Metric::FaceWeight)[0], 0.25, rounding);
  TAUTLINE_CHECK_NEAR(faceMetricOf(stretched, Metric::VolumeRatio)[0], 1.0 / 3, rounding);
  TAUTLINE_CHECK_NEAR(faceMetricOf(stretched, Metric::CellAspectRatio)[1], 3, rounding);
  const FaceMesh mesh = faceMeshOf(stretched);
  const FaceMeasures measures(mesh, stretched.points.data(), FaceConvention::Esi);
  TAUTLINE_CHECK_NEAR(measures.ownerWeights()[0], 0.75, rounding);
}

/// A saddle: its area vector equals the square's, its triangles are larger.
TAUTLINE_PART(testWarpedFaces)
{
  const double h = 0.4;
  MeshData data = singleCell(CellType::Hexahedron, idealCell(CellType::Hexahedron));
  const auto lift = [&](Index node, double by)
  {
    const double* p = &data.points[3 * node];
    data.setPoint(node, { p[0], p[1], p[2] + by });
  };
  lift(5, h);
  lift(7, h);
  TAUTLINE_CHECK_NEAR(
    faceMetricOf(data, Metric::FaceFlatness)[0], 1 / std::sqrt(1 + h * h), rounding);
  // The conventions agree on a saddle, which is symmetric, and on plane faces, not on others.
  const auto volumes = [&](FaceConvention convention)
  { return faceMetricOf(data, Metric::CellVolume, convention)[0]; };
  TAUTLINE_CHECK_NEAR(volumes(FaceConvention::Esi), volumes(FaceConvention::Foundation), rounding);
  lift(5, h);
  data.setPoint(6, { 1.6, 1.3, 1.2 });
  const FaceMesh mesh = faceMeshOf(data);
  const FaceGeometry esi = faceGeometry(mesh, data.points.data(), FaceConvention::Esi);
  const FaceGeometry other = faceGeometry(mesh, data.points.data(), FaceConvention::Foundation);
  double largest = 0;
  for (Index face = 0; face < mesh.faces(); ++face)
  {
    TAUTLINE_CHECK_NEAR(norm(esi.area[face] - other.area[face]), 0, rounding);
    largest = std::max(largest, norm(esi.center[face] - other.center[face]));
  }
  TAUTLINE_CHECK(largest > 1e-3);
}

TAUTLINE_PART(testConcave)
{
  FaceMesh mesh;
  // The edges turn inward by 45 degrees at one corner, along the diagonal and then to the left.
  const MeshData notched =
    prism({ { 0, 0, 0 }, { 2, 0, 0 }, { 1, 1, 0 }, { 1, 2, 0 }, { 0, 2, 0 } }, mesh);
  const FaceMeasures measures(mesh, notched.points.data(), FaceConvention::Esi);
  TAUTLINE_CHECK_NEAR(measures.evaluate(Metric::FaceConcavity).cells[0], 45, 1e-9);
  TAUTLINE_CHECK(measures.evaluate(Metric::CellConcavity).cells[0] > 0.1);
  const MeshData square = prism({ { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 } }, mesh);
  const FaceMeasures convex(mesh, square.points.data(), FaceConvention::Esi);
  TAUTLINE_CHECK_NEAR(convex.evaluate(Metric::FaceConcavity).cells[0], 0, 1e-9);
  TAUTLINE_CHECK(convex.evaluate(Metric::CellConcavity).cells[0] < 0);
}

/// Values do not depend on place, size and turn of the mesh, sizes as their unit has it. The aspect
/// ratio is by the axes.
TAUTLINE_PART(testInvariance)
{
  Random random(3);
  for (CellType type :
    { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    MeshData data = blockMesh(type, 3, 3, 3);
    data.transform(
      [&](const Vec3& p)
      {
        return p +
          Vec3{ random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2) };
      });
    MeshData moved = data;
    const Columns turn = randomRotation(random);
    const double scale = 3;
    moved.transform([&](const Vec3& p) { return scale * (turn * p) + Vec3{ 1, -2, 5 }; });
    for (Metric metric : faceMetrics())
    {
      const MetricInfo& info = metricInfo(metric);
      const Context context(info.name);
      if (!info.rotationInvariant || metric == Metric::Openness)
      {
        continue;
      }
      const std::vector<double> before = faceMetricOf(data, metric);
      const std::vector<double> after = faceMetricOf(moved, metric);
      const double factor = std::pow(scale, info.lengthPower(3));
      TAUTLINE_CHECK_EQUAL(info.lengthPower(3) == 0, info.scaleInvariant);
      TAUTLINE_EACH(std::size_t, i, before.size(),
        TAUTLINE_CHECK_NEAR(
          after[i], factor * before[i], 1e-9 * std::max(1.0, std::abs(factor * before[i]))));
      for (double value : before)
      {
        TAUTLINE_CHECK(info.full3D.low - rounding <= value && value <= info.full3D.high + rounding);
      }
    }
  }
}

/// Two wedges through each other, a flat cell and a point that is not a number.
TAUTLINE_PART(testInvalidCells)
{
  MeshData data = blockMesh(CellType::Hexahedron, 2, 2, 2);
  FaceMesh mesh = faceMeshOf(data);
  const auto validity = [&]
  { return FaceMeasures(mesh, data.points.data(), FaceConvention::Esi).validity(); };
  TAUTLINE_EACH_OF(signed char v, validity(), TAUTLINE_CHECK_EQUAL(int(v), int(Valid)));
  const Index corner = 0;
  data.setPoint(corner, { 2.2, 2.2, 2.2 });
  TAUTLINE_CHECK_EQUAL(int(validity()[0]), int(Inverted));
  data.setPoint(corner, { std::nan(""), 0, 0 });
  TAUTLINE_CHECK_EQUAL(int(validity()[0]), int(NonFinite));
  MeshData flat = singleCell(CellType::Hexahedron, std::vector<Vec3>(8, Vec3{ 1, 1, 1 }));
  mesh = faceMeshOf(flat);
  const FaceMeasures measures(mesh, flat.points.data(), FaceConvention::Esi);
  TAUTLINE_CHECK_EQUAL(int(measures.validity()[0]), int(Degenerate));
  for (Metric metric : faceMetrics())
  {
    const Context context(metricInfo(metric).name);
    TAUTLINE_CHECK(std::isfinite(measures.evaluate(metric).cells[0]));
  }
}

TAUTLINE_PART(testOtherFamilies)
{
  const MeshData data = blockMesh(CellType::Hexahedron, 1, 1, 1);
  TAUTLINE_CHECK_THROWS(
    faceMetricOf(data, Metric::MeanRatio), wording("one-of-elements-not-of-faces"));
  const Mesh mesh(data.view());
  std::vector<double> values(1);
  TAUTLINE_CHECK_THROWS(evaluateMetric(mesh, Metric::FaceWeight, {}, values.data()),
    wording("compares-the-cells-on-both-sides"));
  TAUTLINE_CHECK(!objectiveProblem(Metric::FaceWeight).empty());
}
