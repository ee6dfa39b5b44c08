// SPDX-License-Identifier: BSD-3-Clause
// Boundary layers that follow their wall: the tolerance of radial basis functions, inverse
// distances with rotations, Automatic, and untangling that keeps layers; steps that end before
// elements collapse; motions that end where they begin.

#include "LayeredMeshes.h"
#include "Registry.h"
#include "tautline/Deformation/WarpPointwise.h"
#include "tautline/Deformation/WarpSheet.h"

using namespace tautline;

namespace
{
constexpr double FarAway = 15;

LayeredMesh airfoil(CellType type)
{
  return layeredRing(type, 160, 60, 1.18, airfoilShape(FarAway));
}

LayeredMesh ellipsoid(CellType type)
{
  return layeredShell(type, 8, 16, 1.3, { 1, 0.5, 0.3 }, 6);
}

WarpResult warped(const LayeredMesh& mesh, const Field& motion, const WarpOptions& options)
{
  const Mesh view(mesh.data.view());
  return Warper(view, options).warp(mesh.motion(motion).data());
}

double worstRatio(const WarpResult& result)
{
  return result.history.back().worstRatio;
}

const Field lift = [](const Vec3&) { return Vec3{ 2, 3, 0 }; };

//------------------------------------------------------------------------------
/// Heights above the largest side, shares of the wall, and how it turns.
TAUTLINE_PART(testWalls)
{
  // Boxes of 1 x 1 x 0.1, the lowest layer of which is prescribed and turns about an axis.
  MeshData data = blockMesh(CellType::Hexahedron, 4, 4, 3);
  data.transform(TAUTLINE_PLACE(p[0], p[1], 0.1 * p[2]));
  const Columns turn = rotation({ 1, -2, 0.5 }, 1.9);
  std::vector<unsigned char> prescribed(data.numberOfPoints(), 0);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    prescribed[i] = data.point(i)[2] == 0;
  }
  const auto d = displacements(data, [&](const Vec3& p) { return turn * p - p; });
  const std::vector<WallPoint> walls = wallPoints(Mesh(data.view()), prescribed, d.data());
  double area = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    TAUTLINE_CHECK_EQUAL(std::isinf(walls[i].height), prescribed[i] == 0);
    area += walls[i].area;
    for (std::size_t k = 0; k < 3 && prescribed[i]; ++k)
    {
      TAUTLINE_CHECK_NEAR(walls[i].height, 0.1, 1e-14);
      Vec3 axis = { 0, 0, 0 };
      axis[k] = 1;
      TAUTLINE_CHECK_NEAR(norm(walls[i].turn[k] - turn * axis), 0, 1e-7);
    }
  }
  TAUTLINE_CHECK_NEAR(area, 16, 1e-12);

  // Right triangles of sides 3 and 4; a point whose neighbors are not prescribed does not turn.
  TAUTLINE_LET(MeshData, triangle, addPoints({ { 0, 0, 0 }, { 3, 0, 0 }, { 0, 4, 0 } }),
    addCell(CellType::Triangle, { 0, 1, 2 }));
  const double away[9] = { 1, 2, 0, 0, 0, 0, 0, 0, 0 };
  const std::vector<WallPoint> one = wallPoints(Mesh(triangle.view()), { 1, 0, 0 }, away);
  TAUTLINE_CHECK_NEAR(one[0].height, 2.4, 1e-14);
  TAUTLINE_CHECK_NEAR(one[0].area, 3.5, 1e-14);
  TAUTLINE_CHECK_NEAR(norm(one[0].turn[0] - Vec3{ 1, 0, 0 }), 0, 1e-14);
}

//------------------------------------------------------------------------------
/// Layers of any height stay on the wall: the tolerance is relative to their height.
TAUTLINE_PART(testFit)
{
  for (const CellType type : { CellType::Triangle, CellType::Quadrilateral })
  {
    const LayeredMesh mesh = airfoil(type);
    for (const Field& motion : { turnedWall(30), lift })
    {
      const WarpResult result = warped(mesh, motion, withMethod(WarpMethod::RadialBasis));
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
      TAUTLINE_CHECK(worstRatio(result) < 1.2);
      // A miss of as much as the height of the first layer is too much.
      WarpOptions coarse = withMethod(WarpMethod::RadialBasis);
      coarse.fitTolerance = 0.9;
      const double loose = worstRatio(warped(mesh, motion, coarse));
      TAUTLINE_CHECK(loose > worstRatio(result));
    }
  }
}

//------------------------------------------------------------------------------
/// Walls that turn carry their layers; the mean of displacements alone shears them.
TAUTLINE_PART(testRotations)
{
  for (const CellType type : { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge })
  {
    const Context context(topology(type).name);
    const LayeredMesh mesh = ellipsoid(type);
    const Field turn = turnedWall(60, { 1, 1, 1 });
    const WarpResult plain = warped(mesh, turn, withMethod(WarpMethod::InverseDistance));
    TAUTLINE_CHECK(plain.invertedAfter > 100);
    const WarpResult result = warped(mesh, turn, withMethod(WarpMethod::InverseDistanceRotations));
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    TAUTLINE_CHECK(worstRatio(result) < 5);
    // The first layer moves as the wall does, to a small part of its height.
    double off = 0;
    for (Index i = 0; i < mesh.wall; ++i)
    {
      const Vec3 p = mesh.data.point(mesh.wall + i), q = p + turn(p);
      const double height = norm(p - mesh.data.point(i));
      const Vec3 there = { result.points[3 * (mesh.wall + i)],
        result.points[3 * (mesh.wall + i) + 1], result.points[3 * (mesh.wall + i) + 2] };
      off = std::max(off, norm(there - q) / height);
    }
    TAUTLINE_CHECK(off < 0.1);

    // A rigid motion of all points is exact, and does not depend on the unit of length.
    for (const double unit : { 1e-8, 1.0, 1e8 })
    {
      MeshData scaled = mesh.data;
      scaled.transform([&](const Vec3& p) { return unit * p; });
      const Columns rigid = rotation({ 1, 3, 2 }, 2.5);
      const auto motion = [&](const Vec3& p) { return rigid * p + unit * Vec3{ 3, 1, 2 } - p; };
      const WarpResult moved =
        warped(scaled, motion, withMethod(WarpMethod::InverseDistanceRotations));
      MeshData expected = scaled;
      expected.transform([&](const Vec3& p) { return p + motion(p); });
      TAUTLINE_CHECK_NEAR(distance(moved.points, expected.points), 0, 1e-7 * unit);
    }
  }
}

//------------------------------------------------------------------------------
/// The groups of the tree against the plain sum of the paper.
TAUTLINE_PART(testRigidMeans)
{
  const LayeredMesh mesh = layeredShell(CellType::Tetrahedron, 12, 6, 1.4, { 1, 0.5, 0.3 }, 3);
  const Mesh view(mesh.data.view());
  const std::vector<double> d = mesh.motion(turnedWall(50, { 1, 1, 1 }, { 0.1, 0, 0 }));
  const std::vector<char> flags = view.boundary().isBoundaryPoint;
  const std::vector<unsigned char> prescribed(flags.begin(), flags.end());
  const std::vector<WallPoint> walls = wallPoints(view, prescribed, d.data());
  WarpResult result;
  const WarpOptions options = withMethod(WarpMethod::InverseDistanceRotations);
  WarpControl control(options, result);
  const PrescribedMotion motion(view, prescribed, d.data(), 1, walls);
  const std::vector<double> moves = warpByRigidMeans(motion, control);

  const auto given = [&](Index i) { return Vec3{ d[3 * i], d[3 * i + 1], d[3 * i + 2] }; };
  double area = 0, size = 0, spread = 0, largest = 0;
  Vec3 middle = { 0, 0, 0 }, mean = { 0, 0, 0 };
  for (const Index i : motion.prescribed())
  {
    middle += (1 / double(motion.prescribed().size())) * mesh.data.point(i);
    mean += walls[i].area * given(i);
    area += walls[i].area;
  }
  for (const Index i : motion.prescribed())
  {
    size = std::max(size, norm(mesh.data.point(i) - middle));
    spread = std::max(spread, norm(given(i) - (1 / area) * mean));
    largest = std::max(largest, norm(given(i)));
  }
  const double stiff = std::max(0.1 * size, 5 * spread);
  double worst = 0;
  for (std::size_t n = 0; n < motion.free().size(); n += 37)
  {
    const Vec3 p = mesh.data.point(motion.free()[n]);
    double weights = 0;
    Vec3 sum = { 0, 0, 0 };
    for (const Index i : motion.prescribed())
    {
      const Vec3 r = p - mesh.data.point(i);
      const double w = walls[i].area * (std::pow(size / norm(r), 3) + std::pow(stiff / norm(r), 5));
      Vec3 rigid = given(i) - r;
      for (std::size_t k = 0; k < 3; ++k)
      {
        rigid += r[k] * walls[i].turn[k];
      }
      weights += w;
      sum += w * rigid;
    }
    const Index at = 3 * motion.free()[n];
    const Vec3 move = { moves[at], moves[at + 1], moves[at + 2] };
    worst = std::max(worst, norm(move - (1 / weights) * sum));
  }
  std::cout << "groups and plain sums differ by " << worst / largest << " of the motion\n";
  TAUTLINE_CHECK(worst < 1e-3 * largest);
}

//------------------------------------------------------------------------------
/// The choice follows what the explicit methods leave, and what none leaves good is repaired.
TAUTLINE_PART(testAutomatic)
{
  const WarpOptions options = withMethod(WarpMethod::Automatic);
  const WarpResult layers = warped(airfoil(CellType::Quadrilateral), turnedWall(30), options);
  TAUTLINE_CHECK_EQUAL(int(layers.chosen), int(WarpMethod::RadialBasis));
  TAUTLINE_CHECK_EQUAL(layers.attempts.size(), std::size_t(1));
  TAUTLINE_CHECK_EQUAL(layers.history.size(), std::size_t(1));
  TAUTLINE_CHECK(layers.invertedAfter == 0 && worstRatio(layers) < 2);

  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const bool flat = type == CellType::Triangle;
    const MeshData data = boxInBox(type, flat ? 24 : 10, flat ? 8 : 3);
    const Field motion = turnedBox(120, flat);
    const WarpResult result = tautline::warped(data, motion, options);
    TAUTLINE_CHECK_EQUAL(result.attempts.size(), std::size_t(2));
    const auto better = std::min_element(result.attempts.begin(), result.attempts.end(),
      [](const WarpAttempt& a, const WarpAttempt& b) { return a.inverted < b.inverted; });
    TAUTLINE_CHECK_EQUAL(int(result.chosen), int(better->method));
    TAUTLINE_CHECK_EQUAL(result.invertedWarp, better->inverted);
    TAUTLINE_CHECK(result.invertedWarp > 0);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    TAUTLINE_CHECK_EQUAL(invalid(data, result.points), 0);
    TAUTLINE_CHECK(worstRatio(result) < 10);
  }
}

//------------------------------------------------------------------------------
/// Untangling gives layers their shape back, and Hybrid does not trade the worst element.
TAUTLINE_PART(testSecondSteps)
{
  const WarpResult layers = warped(
    airfoil(CellType::Quadrilateral), turnedWall(20), withMethod(WarpMethod::FemwarpUntangling));
  TAUTLINE_CHECK(layers.invertedWarp > 100);
  TAUTLINE_CHECK_EQUAL(layers.invertedAfter, 0);
  TAUTLINE_CHECK(worstRatio(layers) < 3);

  const MeshData data = boxInBox(CellType::Triangle, 40, 16);
  const WarpResult held =
    tautline::warped(data, turnedBox(180, true), withMethod(WarpMethod::Hybrid));
  TAUTLINE_CHECK_EQUAL(held.invertedAfter, 0);
  TAUTLINE_CHECK(worstRatio(held) < 20);
}

//------------------------------------------------------------------------------
/// Steps of automatic length end where an element would be flattened to a thousandth.
TAUTLINE_PART(testCollapse)
{
  const MeshData data = boxInBox(CellType::Triangle, 40, 16);
  for (const WarpMethod method : { WarpMethod::SmallStepFemwarp, WarpMethod::InverseDistance })
  {
    WarpOptions options = withMethod(method);
    options.steps = 0;
    const WarpResult result = tautline::warped(data, turnedBox(120, true), options);
    TAUTLINE_CHECK(result.amount > 0.1 && result.amount < 1);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    const WarpQuality quality = qualityOf(Mesh(data.view()), result.points.data());
    TAUTLINE_CHECK(quality.worstRatio > 1 && quality.worstRatio <= 1e3);
  }
}

//------------------------------------------------------------------------------
/// The inverse mean ratio of a stretch, against its formula, for all types.
TAUTLINE_PART(testRatio)
{
  for (const CellType type : { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
         CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    const MeshData data = perturbedBlock(type, 3, 0.05);
    const bool flat = topology(type).dimension == 2;
    constexpr double s = 7;
    MeshData moved = data;
    moved.transform(TAUTLINE_PLACE(s * p[0], p[1], p[2]));
    const double expected = flat ? (s * s + 1) / (2 * s) : (s * s + 2) / (3 * std::pow(s, 2.0 / 3));
    const WarpQuality quality = qualityOf(Mesh(data.view()), moved.points.data());
    TAUTLINE_CHECK_RELATIVE(quality.worstRatio, expected, 1e-12);
  }
}

//------------------------------------------------------------------------------
/// Every method on every type of element, and on surfaces in space.
TAUTLINE_PART(testAllTypes)
{
  for (const CellType type :
    { CellType::Triangle, CellType::Quadrilateral, CellType::Wedge, CellType::Pyramid })
  {
    const bool flat = topology(type).dimension == 2;
    // Surfaces are bent; the inner part turns a little, and moves out of its plane.
    const auto bent = [flat](const Vec3& p) {
      return flat ? Vec3{ p[0], p[1], 0.3 * std::sin(3 * p[0]) * p[1] } : p;
    };
    MeshData data = boxInBox(type, 10, 4, 0.05);
    const Field turn = turnedBox(15, flat);
    const std::vector<double> d = displacements(data,
      [&](const Vec3& p) {
        return turn(p) + Vec3{ 0, 0, onInnerBox(p, flat) ? 0.05 : 0.0 };
      });
    data.transform(bent);
    const Mesh mesh(data.view());
    for (int method = 0; method <= int(WarpMethod::Automatic); ++method)
    {
      const Context context(std::string(topology(type).name) + " method " + std::to_string(method));
      const WarpResult result = Warper(mesh, withMethod(WarpMethod(method))).warp(d.data());
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
      TAUTLINE_CHECK_EQUAL(result.amount, 1.0);
      TAUTLINE_CHECK(worstRatio(result) > 1 && worstRatio(result) < 5);
    }
  }
}

//------------------------------------------------------------------------------
/// A surface that turns in space as a whole keeps its shape; one that folds is reported.
TAUTLINE_PART(testSurfaceShape)
{
  MeshData data = perturbedBlock(CellType::Triangle, 8, 0.15);
  data.transform(TAUTLINE_PLACE(p[0], p[1], 0.1 * p[0] * p[1]));
  const Mesh mesh(data.view());
  MeshData turned = data;
  const Columns turn = rotation({ 1, 2, 3 }, 2.8);
  turned.transform([&](const Vec3& p) { return turn * p; });
  const WarpQuality same = qualityOf(mesh, turned.points.data());
  TAUTLINE_CHECK_EQUAL(same.inverted, 0);
  TAUTLINE_CHECK_NEAR(same.worst, 0, 1e-20);
  TAUTLINE_CHECK_NEAR(same.worstRatio, 1, 1e-12);
  // A point that crosses the edge opposite to it folds the triangles there.
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  const Index inner = std::find(boundary.begin(), boundary.end(), 0) - boundary.begin();
  MeshData folded = data;
  folded.setPoint(inner, data.point(inner) + Vec3{ 2.5, 0, 0.25 });
  TAUTLINE_CHECK(qualityOf(mesh, folded.points.data()).inverted > 0);
}

//------------------------------------------------------------------------------
/// The elastic sheet: a flat one is plane strain, and rigid motions cost nothing.
TAUTLINE_PART(testSheet)
{
  const MeshData flat = perturbedBlock(CellType::Quadrilateral, 4, 0.15);
  const ElasticOperator pde;
  const SparseMatrix plane = stiffnessMatrix(Mesh(flat.view()), pde);
  const SparseMatrix sheet = sheetMatrix(Mesh(flat.view()), pde, {});
  double worst = 0;
  for (Index a = 0; a < flat.numberOfPoints(); ++a)
  {
    for (Index b = 0; b < flat.numberOfPoints(); ++b)
    {
      for (Index k = 0; k < 4; ++k)
      {
        worst = std::max(worst,
          std::abs(
            plane.at(2 * a + k / 2, 2 * b + k % 2) - sheet.at(3 * a + k / 2, 3 * b + k % 2)));
      }
    }
  }
  TAUTLINE_CHECK_NEAR(worst, 0, 1e-14);
  MeshData bent = perturbedBlock(CellType::Triangle, 4, 0.15);
  bent.transform(TAUTLINE_PLACE(p[0], p[1], 0.2 * p[0] * p[1]));
  const SparseMatrix shell = sheetMatrix(Mesh(bent.view()), pde, {});
  for (std::size_t c = 0; c < 3; ++c)
  {
    std::vector<double> u(shell.size, 0.0), r(shell.size);
    for (Index i = 0; i < bent.numberOfPoints(); ++i)
    {
      u[3 * i + Index(c)] = 1;
    }
    shell.multiply(u.data(), r.data());
    TAUTLINE_EACH_OF(const double x, r, TAUTLINE_CHECK_NEAR(x, 0, 1e-13));
  }
}

//------------------------------------------------------------------------------
/// A full turn in one step moves nothing, which is stated; in several steps it is followed.
TAUTLINE_PART(testStill)
{
  const MeshData data = boxInBox(CellType::Triangle, 16, 4);
  const Mesh mesh(data.view());
  const auto turn = [&](double amount, double* to)
  {
    const std::vector<double> d = displacements(data, turnedBox(360 * amount, true));
    std::copy(d.begin(), d.end(), to);
  };
  for (const WarpMethod method :
    { WarpMethod::Femwarp, WarpMethod::Hybrid, WarpMethod::RadialBasis, WarpMethod::Automatic })
  {
    const Context context("method " + std::to_string(int(method)));
    WarpOptions options = withMethod(method);
    const WarpResult once = Warper(mesh, options).warp(turn);
    TAUTLINE_CHECK(once.still);
    TAUTLINE_CHECK(!once.message.empty());
    TAUTLINE_CHECK_NEAR(distance(once.points, data.points), 0, 1e-9);
    options.steps = 0;
    const WarpResult followed = Warper(mesh, options).warp(turn);
    TAUTLINE_CHECK(followed.still);
    TAUTLINE_CHECK(distance(followed.points, data.points) > 1e-3);
    TAUTLINE_CHECK_EQUAL(followed.invertedAfter, 0);
  }
  const std::vector<double> nothing(data.points.size(), 0.0);
  TAUTLINE_CHECK(Warper(mesh, WarpOptions()).warp(nothing.data()).still);
  TAUTLINE_CHECK(!tautline::warped(data, turnedBox(20, true), WarpOptions()).still);
}
}
