// SPDX-License-Identifier: BSD-3-Clause
// A mesh has the corners, curves and patches of the geometry, and no others.
#include "Registry.h"
#include "Surfaces.h"
#include "tautline/Boundary/GeometryMatch.h"

using namespace tautline;

namespace
{
GeometryMatch match(const MeshData& data, const MeshData& geometry,
  const FeatureOptions& options = {}, const std::vector<unsigned char>& held = {})
{
  return matchGeometry(
    Mesh(data.view()), options, held.empty() ? nullptr : held.data(), Mesh(geometry.view()));
}

void checkCounts(const GeometryMatch& found, Index corners, int curves, int patches)
{
  TAUTLINE_CHECK_EQUAL(found.features.corners, corners);
  TAUTLINE_CHECK_EQUAL(found.features.curves, curves);
  TAUTLINE_CHECK_EQUAL(found.features.patches, patches);
}

/// The largest distance of the points from a sphere about the middle of the unit cube.
double offSphere(const std::vector<double>& points, double radius)
{
  double off = 0;
  for (std::size_t i = 0; i < points.size(); i += 3)
  {
    const Vec3 x = Vec3{ points[i], points[i + 1], points[i + 2] } - Vec3{ 0.5, 0.5, 0.5 };
    off = std::max(off, std::abs(norm(x) - radius));
  }
  return off;
}

/// A mesh of a cube with rounded edges: its facets bend by up to 90 degrees, the geometry nowhere.
TAUTLINE_PART(testSmoothGeometry)
{
  const MeshData cube = cubeSurface(CellType::Quadrilateral, 2);
  MeshData sphere = sphereSurface(CellType::Triangle, 40);
  const double radius = 0.75;
  sphere.transform([=](Vec3 p) { return radius * p + Vec3{ 0.5, 0.5, 0.5 }; });
  checkCounts(match(cube, cube), 8, 12, 6);
  const GeometryMatch found = match(cube, sphere);
  checkCounts(found, 0, 0, 1);
  TAUTLINE_CHECK_EQUAL(found.cornersOfGeometry, Index(0));
  TAUTLINE_CHECK_EQUAL(found.curvesOfGeometry, 0);
  TAUTLINE_CHECK(offSphere(found.points, radius) < 1e-3);
  TAUTLINE_CHECK(std::all_of(
    found.parts.begin(), found.parts.end(), [](std::int32_t part) { return part == 0; }));
  // Corners that the user gives stay corners; points that are held stay where they are.
  std::vector<signed char> kinds(cube.numberOfPoints(), DetectKind);
  std::vector<unsigned char> held(cube.numberOfPoints(), 0);
  kinds[0] = CornerPoint;
  held[1] = 1;
  TAUTLINE_LET(FeatureOptions, options, kinds = kinds.data());
  const GeometryMatch given = match(cube, sphere, options, held);
  TAUTLINE_CHECK_EQUAL(given.features.corners, Index(1));
  TAUTLINE_CHECK_EQUAL(given.parts[0], std::int32_t(-1));
  TAUTLINE_CHECK_EQUAL(given.parts[1], std::int32_t(-1));
  TAUTLINE_CHECK(std::equal(&given.points[3], &given.points[6], &cube.points[3]));
}

/// A step of the geometry that the mesh has as a row of edges without any angle.
TAUTLINE_PART(testFlatMesh)
{
  MeshData geometry = blockMesh(CellType::Quadrilateral, 8, 8, 0);
  const double slope = 1.5;
  geometry.transform([=](Vec3 p) { return Vec3{ p[0], p[1], slope * std::max(0.0, p[0] - 4) }; });
  MeshData mesh = blockMesh(CellType::Quadrilateral, 8, 8, 0);
  // Nearly on it, and smoother than 40 degrees at the fold by a row of facets between.
  mesh.transform(
    [=](Vec3 p)
    {
      const double up = p[0] <= 4 ? 0 : p[0] <= 5 ? 0.5 * slope : slope * (p[0] - 4);
      return Vec3{ p[0], p[1], up };
    });
  const Features own = findFeatures(Mesh(mesh.view()), {});
  TAUTLINE_CHECK_EQUAL(own.patches, 1);
  TAUTLINE_LET(FeatureOptions, surface, asSurface = true);
  const GeometryMatch found = match(mesh, geometry, surface);
  TAUTLINE_CHECK_EQUAL(found.features.patches, 2);
  TAUTLINE_CHECK_EQUAL(found.curves, found.curvesOfGeometry);
  for (Index p = 0; p < mesh.numberOfPoints(); ++p)
  {
    const Vec3 x = mesh.point(p);
    const bool fold = x[0] == 4 && x[1] > 0 && x[1] < 8;
    const bool inside = x[0] > 0 && x[0] < 8 && x[1] > 0 && x[1] < 8;
    TAUTLINE_CHECK_EQUAL(found.features.kind[p] == CurvePoint && inside, fold);
    const double up = found.points[3 * p + 2], along = found.points[3 * p];
    TAUTLINE_CHECK_NEAR(up, slope * std::max(0.0, along - 4), 1e-12);
  }
}

/// A row of edges beside a curve, nearer than a sixth of its own length, is not on it.
TAUTLINE_PART(testThinRows)
{
  MeshData geometry = cubeSurface(CellType::Quadrilateral, 4);
  MeshData mesh = geometry;
  constexpr double thin = 0.02;
  // The second row below the top is close to the top.
  mesh.transform([=](Vec3 p) { return Vec3{ p[0], p[1], p[2] == 0.75 ? 1 - thin : p[2] }; });
  checkCounts(match(mesh, geometry), 8, 12, 6);
}

/// The points of a mesh on one side of a thin plate slide on that side.
TAUTLINE_PART(testThinWall)
{
  MeshData plate = cubeSurface(CellType::Quadrilateral, 8);
  constexpr double thickness = 0.01;
  const auto flatten = [](Vec3 p) { return Vec3{ p[0], p[1], thickness * p[2] }; };
  plate.transform(flatten);
  MeshData mesh = plate;
  // Off by more than half of the thickness, so that the other side is nearer.
  mesh.transform(
    [](Vec3 p)
    {
      return Vec3{ p[0], p[1],
        p[2] == thickness && p[0] == 0.5 && p[1] == 0.5 ? 0.3 * thickness : p[2] };
    });
  const GeometryMatch found = match(mesh, plate);
  checkCounts(found, 8, 12, 6);
  for (Index p = 0; p < plate.numberOfPoints(); ++p)
  {
    TAUTLINE_CHECK_NEAR(found.points[3 * p + 2], plate.point(p)[2], 1e-12);
  }
}

TAUTLINE_PART(testElsewhere)
{
  const MeshData cube = cubeSurface(CellType::Triangle, 4);
  MeshData far = cube;
  constexpr double millimeters = 1000;
  far.transform([](Vec3 p) { return millimeters * (p - Vec3{ 0.5, 0.5, 0.5 }); });
  TAUTLINE_CHECK_THROWS(match(cube, far), wording("geometry-is-elsewhere"));
  far = cube;
  far.transform([](Vec3 p) { return p + Vec3{ 0.05, 0, 0 }; });
  TAUTLINE_CHECK_EQUAL(match(cube, far).corners, Index(8));
}

/// An edge that fades into a smooth surface is noise if it has few edges.
TAUTLINE_PART(testNoise)
{
  constexpr int n = 12;
  for (int length : { 1, 6 })
  {
    MeshData sheet = blockMesh(CellType::Quadrilateral, n, n, 0);
    sheet.transform(
      [=](Vec3 p)
      {
        const bool ridge = p[1] == n / 2 && p[0] >= 3 && p[0] <= 3 + length;
        return Vec3{ p[0], p[1], ridge ? 0.5 : 0.0 };
      });
    const auto edgesInside = [&](const FeatureOptions& options)
    { return static_cast<int>(findFeatures(Mesh(sheet.view()), options).edges.size()) - 4 * n; };
    TAUTLINE_LET(FeatureOptions, all, shortestCurve = 0);
    TAUTLINE_CHECK_EQUAL(edgesInside({}) > 0, length > 1);
    TAUTLINE_CHECK(edgesInside(all) > 0);
  }
}

/// A crease that fades out is a curve up to where it clearly bends.
TAUTLINE_PART(testFadingCrease)
{
  constexpr int n = 24;
  constexpr double sharpest = 70, ofTheAngle = 1.25;
  const FeatureOptions options;
  // The normals of the two sides of a roof differ by 2 atan(slope).
  MeshData roof = blockMesh(CellType::Quadrilateral, n, 2, 0);
  const auto bendAt = [=](double x) { return sharpest * (1 - x / n); };
  roof.transform(
    [=](Vec3 p)
    {
      const double slope = std::tan(bendAt(p[0]) / 2 * Pi / 180);
      return Vec3{ p[0], p[1], p[1] == 1 ? slope : 0.0 };
    });
  const Features found = findFeatures(Mesh(roof.view()), options);
  TAUTLINE_LET(FeatureOptions, all, shortestCurve = 0);
  const Features whole = findFeatures(Mesh(roof.view()), all);
  const auto lastOf = [&](const Features& features)
  {
    double last = 0;
    for (const Features::Edge& edge : features.edges)
    {
      const Vec3 &a = roof.point(edge.first), &b = roof.point(edge.second);
      last = a[1] == 1 && b[1] == 1 ? std::max({ last, a[0], b[0] }) : last;
    }
    return last;
  };
  // The middle of the last edge that is sharp; the facets beside it are nearly flat.
  constexpr double slack = 3;
  TAUTLINE_CHECK_NEAR(bendAt(lastOf(whole) - 0.5), options.angle, slack);
  TAUTLINE_CHECK_NEAR(bendAt(lastOf(found) - 0.5), ofTheAngle * options.angle, slack);
}

/// A planar mesh and an outline of lines: corners that only one of them has are smooth.
TAUTLINE_PART(testOutline)
{
  const MeshData square = blockMesh(CellType::Triangle, 4, 4, 0);
  const GeometryMatch found = match(square, square);
  checkCounts(found, 4, 4, 0);
  MeshData moved = square;
  moved.transform([](Vec3 p) { return Vec3{ p[0] == 4 ? 4.1 : p[0], p[1], 0 }; });
  const GeometryMatch away = match(moved, square);
  for (Index p = 0; p < square.numberOfPoints(); ++p)
  {
    const bool border = square.point(p)[0] == 4;
    TAUTLINE_CHECK(!border || away.points[3 * p] == 4);
  }
  TAUTLINE_LET(MeshData, empty, addPoint({ 0, 0, 0 }));
  TAUTLINE_CHECK_THROWS(match(square, empty), wording("no-lines-and-no-border"));
}
}
