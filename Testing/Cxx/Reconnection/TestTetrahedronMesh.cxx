// SPDX-License-Identifier: BSD-3-Clause
// The changing tetrahedral mesh and its operations: small known cases, brute force, and thousands
// of random operations with all invariants checked after each.

#include "Reconnecting.h"
#include "Registry.h"
#include "tautline/Reconnection/CavityOperations.h"

using namespace tautline;

namespace
{
TetrahedronMesh meshOf(const MeshData& data)
{
  auto points = collect<Vec3>(data.numberOfPoints(), [&](Index i) { return data.point(i); });
  std::vector<TetVertices> cells(data.numberOfCells());
  for (std::size_t i = 0; i < data.connectivity.size(); ++i)
  {
    cells[i / 4][i % 4] = static_cast<PointId>(data.connectivity[i]);
  }
  return TetrahedronMesh(points, cells);
}

/// Points of the boundary fixed, no bounds.
void prepare(TetrahedronMesh& mesh, CavityOperations& operations)
{
  operations.freedoms.assign(mesh.pointSlots(), {});
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      if (mesh.isWall(t, i))
      {
        for (PointId v : mesh.face(t, i))
        {
          operations.freedoms[v].kind = PointFreedom::Fixed;
        }
      }
    }
  }
  TAUTLINE_SET(operations, smallestSize = 0, largestSize = 1000000);
  operations.prepareStamps();
}

double worstQuality(const TetrahedronMesh& mesh)
{
  double worst = 1.0;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    worst = mesh.alive(t) ? std::min(worst, mesh.quality(t)) : worst;
  }
  return worst;
}

double volumeOf(const TetrahedronMesh& mesh)
{
  long double sum = 0.0;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    if (mesh.alive(t))
    {
      const TetVertices& v = mesh.tet(t).vertices;
      sum +=
        measure(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3])).determinant;
    }
  }
  return static_cast<double>(sum / 6.0);
}

std::set<TriangleVertices> wallsOf(const TetrahedronMesh& mesh)
{
  std::set<TriangleVertices> walls;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; mesh.alive(t) && i < 4; ++i)
    {
      if (mesh.isWall(t, i))
      {
        TriangleVertices f = mesh.face(t, i);
        std::sort(f.begin(), f.end());
        walls.insert(f);
      }
    }
  }
  return walls;
}

//------------------------------------------------------------------------------
/// On a lattice with integer coordinates the determinant is exact in integers; scaled by a number
/// that is not a power of two, the points are no longer in one plane, and the sign follows from the
/// rounded coordinates.
TAUTLINE_PART(testOrientation)
{
  Random random(5);
  const auto integer = [&]() { return static_cast<double>(random.integer(7)) - 3.0; };
  int zeros = 0;
  for (int i = 0; i < 20000; ++i)
  {
    Vec3 p[4];
    for (Vec3& x : p)
    {
      x = { integer(), integer(), integer() };
    }
    const double det = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
    zeros += det == 0.0;
    TAUTLINE_CHECK_EQUAL(orientation(p[0], p[1], p[2], p[3]), (det > 0.0) - (det < 0.0));
    TAUTLINE_CHECK_EQUAL(orientation(p[1], p[0], p[2], p[3]), (det < 0.0) - (det > 0.0));
    // Far from the origin in units of 2^-20: coordinates are exact, products are not.
    Vec3 q[4];
    for (int k = 0; k < 4; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        q[k][c] = 1.0 + 0x1p-52 * p[k][c] + (c == 2 ? q[k][0] + q[k][1] : 0.0);
      }
    }
    const int s = orientation(q[0], q[1], q[2], q[3]);
    TAUTLINE_CHECK_EQUAL(orientation(q[2], q[0], q[1], q[3]), s);
    TAUTLINE_CHECK_EQUAL(orientation(q[0], q[1], q[3], q[2]), -s);
  }
  TAUTLINE_CHECK(zeros > 100);
  // The smallest step of a coordinate off the plane x + y + z = 1.
  const Vec3 a = { 1, 0, 0 }, b = { 0, 1, 0 }, c = { 0, 0, 1 };
  for (double t : { 0.25, 0.125, 0.375 })
  {
    const Vec3 d = { t, 0.5, 0.5 - t };
    TAUTLINE_CHECK_EQUAL(orientation(a, b, c, d), 0);
    TAUTLINE_CHECK_EQUAL(orientation(a, b, c, { std::nextafter(t, 1.0), d[1], d[2] }), 1);
    TAUTLINE_CHECK_EQUAL(orientation(a, b, c, { std::nextafter(t, 0.0), d[1], d[2] }), -1);
  }
}

TAUTLINE_PART(testQuality)
{
  const std::vector<Vec3> ideal = idealCell(CellType::Tetrahedron);
  const auto best = measure(ideal[0], ideal[1], ideal[2], ideal[3]);
  TAUTLINE_CHECK_NEAR(best.meanRatio, 1.0, 1e-14);
  TAUTLINE_CHECK_NEAR(best.sine, std::sqrt(8.0) / 3.0, 1e-14);
  // A flat tetrahedron, folded along a diagonal of the square; a face without area.
  const Vec3 o = { 0, 0, 0 }, x = { 1, 0, 0 }, y = { 0, 1, 0 }, xy = { 1, 1, 0 };
  TAUTLINE_CHECK_EQUAL(dihedralRange(o, x, xy, y).smallest, 0.0);
  TAUTLINE_CHECK_EQUAL(dihedralRange(o, x, xy, y).largest, 180.0);
  TAUTLINE_CHECK_EQUAL(dihedralRange(o, o, x, y).largest, 180.0);
  Random random(1);
  for (int i = 0; i < 1000; ++i)
  {
    const Vec3 p = random.vector(-1, 1), a = random.vector(-1, 1), b = random.vector(-1, 1),
               c = random.vector(-1, 1);
    const TetrahedronMeasures m = measure(p, a, b, c);
    const DihedralRange angles = dihedralRange(p, a, b, c);
    const double sine =
      std::min(std::sin(angles.smallest * Pi / 180.0), std::sin(angles.largest * Pi / 180.0));
    TAUTLINE_CHECK_NEAR(std::abs(m.sine), sine, 1e-12);
    TAUTLINE_CHECK_EQUAL(m.determinant > 0.0, m.sine > 0.0);
    if (m.determinant > 0.0)
    {
      const double imr = valueOf(CellType::Tetrahedron, { p, a, b, c }, Metric::InverseMeanRatio);
      TAUTLINE_CHECK_RELATIVE(std::pow(m.meanRatio, -2.0 / 3.0), imr, 1e-12);
      const auto angle = [&](Metric metric) {
        return valueOf(CellType::Tetrahedron, { p, a, b, c }, metric);
      };
      TAUTLINE_CHECK_NEAR(angles.smallest, angle(Metric::MinimumAngle), 1e-9);
      TAUTLINE_CHECK_NEAR(angles.largest, angle(Metric::MaximumAngle), 1e-9);
    }
  }
}

/// The best point in a regular octahedron is its center, from any start; the value of a point that
/// moves in a plane or on a line is at least as good as each of many points there.
TAUTLINE_PART(testSmoothing)
{
  const Vec3 v[6] = { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 },
    { 0, 0, -1 } };
  StarSmoothing star;
  for (int x : { 0, 1 })
  {
    for (int y : { 2, 3 })
    {
      for (int z : { 4, 5 })
      {
        const bool even = (x + y + z) % 2 == 0;
        TAUTLINE_CHECK(star.addFace(v[x], even ? v[y] : v[z], even ? v[z] : v[y]));
      }
    }
  }
  Random random(2);
  for (int i = 0; i < 100; ++i)
  {
    const Vec3 start = random.vector(-0.25, 0.25);
    Vec3 p = start;
    const double q = star.maximize(p, 100);
    TAUTLINE_CHECK_NEAR(norm(p), 0.0, 2e-3);
    TAUTLINE_CHECK_EQUAL(q, star.evaluate(p));
    for (PointFreedom::Kind kind : { PointFreedom::InPlane, PointFreedom::OnLine })
    {
      Vec3 d = random.vector(-1, 1);
      d = (1.0 / norm(d)) * d;
      p = start;
      const double best = star.maximize(p, 100, { kind, d });
      const Vec3 moved = p - start;
      const double along = dot(moved, d);
      // Rounding of up to 100 steps: at most 1.12e-14, with GCC 16.
      TAUTLINE_CHECK_NEAR(
        kind == PointFreedom::InPlane ? along : norm(moved - along * d), 0.0, 5e-14);
      for (int k = 0; k < 20; ++k)
      {
        const PointFreedom freedom = { kind, d };
        TAUTLINE_CHECK(
          star.evaluate(start + freedom.project(random.vector(-0.3, 0.3))) < best + 5e-3);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Tetrahedra round the edge from (0, 0, -1) to (0, 0, 1), with n ring points.
MeshData ringMesh(int n, Random& random, double height)
{
  TAUTLINE_LET(MeshData, data, addPoint({ random.uniform(-0.1, 0.1), 0, -height }),
    addPoint({ 0, random.uniform(-0.1, 0.1), height }));
  for (int i = 0; i < n; ++i)
  {
    const double angle = 2.0 * Pi * (i + random.uniform(-0.2, 0.2)) / n;
    const double radius = random.uniform(0.7, 1.3);
    data.addPoint({ radius * std::cos(angle), radius * std::sin(angle), random.uniform(-.1, .1) });
  }
  for (int i = 0; i < n; ++i)
  {
    data.addCell(CellType::Tetrahedron, { 0, 1, 2 + i, 2 + (i + 1) % n });
  }
  return data;
}

/// The best smallest quality over all triangulations of ring[i..j], by recursion.
double bruteForce(const MeshData& data, int i, int j)
{
  if (j - i < 2)
  {
    return 1.0;
  }
  double best = -1.0;
  for (int k = i + 1; k < j; ++k)
  {
    const Vec3 x = data.point(2 + i), y = data.point(2 + k), z = data.point(2 + j);
    const double q =
      std::min(roundedQuality(x, y, z, data.point(1)), roundedQuality(y, x, z, data.point(0)));
    best = std::max(best, std::min(q, std::min(bruteForce(data, i, k), bruteForce(data, k, j))));
  }
  return best;
}

TAUTLINE_PART(testEdgeRemoval)
{
  Random random(11);
  int removed = 0, kept = 0;
  for (int trial = 0; trial < 600; ++trial)
  {
    const int n = 3 + trial % 7;
    const MeshData data = ringMesh(n, random, random.uniform(0.2, 1.2));
    TetrahedronMesh mesh = meshOf(data);
    TAUTLINE_CHECK_EQUAL(mesh.findViolation(), "");
    CavityOperations operations(mesh);
    prepare(mesh, operations);
    const std::set<TriangleVertices> walls = wallsOf(mesh);
    const double before = worstQuality(mesh), volume = volumeOf(mesh);
    const double best = bruteForce(data, 0, n - 1);
    if (std::abs(best - before) < 1e-6)
    {
      continue;
    }
    // The operation is to improve the tetrahedron it is called for: the worst.
    TetId t = 0;
    while (mesh.quality(t) != before)
    {
      ++t;
    }
    const bool done = operations.removeEdge(t, 0, 1);
    TAUTLINE_CHECK_EQUAL(done, best > before);
    TAUTLINE_CHECK_NEAR(worstQuality(mesh), std::max(before, best), 1e-12);
    TAUTLINE_CHECK_EQUAL(mesh.size(), done ? 2 * (n - 2) : n);
    TAUTLINE_CHECK_EQUAL(mesh.findViolation(), "");
    TAUTLINE_CHECK_RELATIVE(volumeOf(mesh), volume, 1e-13);
    TAUTLINE_CHECK(wallsOf(mesh) == walls);
    (done ? removed : kept) += 1;
  }
  TAUTLINE_CHECK(removed > 100);
  TAUTLINE_CHECK(kept > 100);
}

/// n - 2 faces between two near points, removed at once: n tetrahedra round the new edge.
TAUTLINE_PART(testFaceRemoval)
{
  Random random(12);
  for (int n = 3; n <= 6; ++n)
  {
    MeshData data = ringMesh(n, random, 0.9);
    data.types.clear();
    data.offsets = { 0 };
    data.connectivity.clear();
    for (int i = 1; i + 1 < n; ++i)
    {
      data.addCell(CellType::Tetrahedron, { 2, 2 + i, 2 + i + 1, 1 });
      data.addCell(CellType::Tetrahedron, { 2 + i, 2, 2 + i + 1, 0 });
    }
    TetrahedronMesh mesh = meshOf(data);
    TAUTLINE_CHECK_EQUAL(mesh.findViolation(), "");
    const std::set<TriangleVertices> walls = wallsOf(mesh);
    const double before = worstQuality(mesh), volume = volumeOf(mesh);
    CavityOperations operations(mesh);
    prepare(mesh, operations);
    bool done = false;
    for (TetId t = 0; t < mesh.slots() && !done; ++t)
    {
      if (mesh.quality(t) != before)
      {
        continue;
      }
      for (int i = 0; i < 4 && !done; ++i)
      {
        done = operations.removeFaces(t, i);
      }
    }
    double round = smallestOf<double>(1.0, n,
      [&](int i)
      {
        return roundedQuality(
          data.point(0), data.point(1), data.point(2 + i), data.point(2 + (i + 1) % n));
      });
    TAUTLINE_CHECK_EQUAL(done, round > before);
    if (done)
    {
      TAUTLINE_CHECK_EQUAL(mesh.size(), n);
      TAUTLINE_CHECK_NEAR(worstQuality(mesh), round, 1e-12);
    }
    TAUTLINE_CHECK_EQUAL(mesh.findViolation(), "");
    TAUTLINE_CHECK_RELATIVE(volumeOf(mesh), volume, 1e-13);
    TAUTLINE_CHECK(wallsOf(mesh) == walls);
  }
}

//------------------------------------------------------------------------------
/// Everything the next operations depend on, except the order of free ids.
std::vector<double> stateOf(const TetrahedronMesh& mesh)
{
  std::vector<double> state = { static_cast<double>(mesh.size()) };
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    state.push_back(mesh.alive(t));
    for (int i = 0; mesh.alive(t) && i < 4; ++i)
    {
      state.push_back(mesh.tet(t).vertices[i]);
      state.push_back(mesh.tet(t).neighbors[i]);
    }
  }
  for (PointId v = 0; v < mesh.pointSlots(); ++v)
  {
    const Vec3 x = mesh.used(v) ? mesh.point(v) : Vec3{ 0, 0, 0 };
    state.insert(state.end(), x.begin(), x.end());
  }
  return state;
}

bool operate(CavityOperations& operations, const TetrahedronMesh& mesh, TetId t, Random& random)
{
  using Compound = CavityOperations::Compound;
  const int i = static_cast<int>(random.integer(4)),
            j = (i + 1 + static_cast<int>(random.integer(3))) % 4;
  switch (random.integer(9))
  {
    case 0:
    case 1:
      return operations.removeEdge(t, i, j);
    case 2:
      return operations.removeFaces(t, i);
    case 3:
      return operations.contract(t, i, j);
    case 4:
      return operations.insert(t);
    case 5:
      return operations.tryCompound(t, Compound::Swap);
    case 6:
      return operations.tryCompound(t, Compound::Insertion);
    case 7:
      return operations.tryCompound(t, Compound::Contraction);
    default:
      return operations.smooth(mesh.tet(t).vertices[i], 2);
  }
}

void testRandomOperations(int wanted)
{
  Random random(21);
  int accepted = 0, undone = 0;
  for (unsigned seed = 1; accepted < wanted && failures() == 0; ++seed)
  {
    TetrahedronMesh mesh = meshOf(sliverBlock(3, seed, 0.9));
    CavityOperations operations(mesh);
    prepare(mesh, operations);
    const std::set<TriangleVertices> walls = wallsOf(mesh);
    const double volume = volumeOf(mesh);
    double worst = worstQuality(mesh);
    for (int attempt = 0; attempt < 1500; ++attempt)
    {
      const TetId t = static_cast<TetId>(random.integer(mesh.slots()));
      if (!mesh.alive(t))
      {
        continue;
      }
      const std::vector<double> state = stateOf(mesh);
      const OperationCounts counts = operations.counts();
      operations.repairs = attempt % 8 == 0 ? 2 : 0; // after tentative changes
      if (!operate(operations, mesh, t, random))
      {
        const std::vector<double> after = stateOf(mesh);
        // Slots that were added and freed again may remain; used slots are unchanged.
        undone += after.size() != state.size();
        TAUTLINE_CHECK_EQUAL(after[0], state[0]);
        TAUTLINE_CHECK_EQUAL(operations.counts().insertions, counts.insertions);
        TAUTLINE_CHECK(after.size() != state.size() || after == state);
        if (attempt % 8 == 0)
        {
          TAUTLINE_CHECK_EQUAL(mesh.findViolation(), "");
        }
        continue;
      }
      ++accepted;
      TAUTLINE_CHECK_EQUAL(mesh.findViolation(), "");
      TAUTLINE_CHECK_RELATIVE(volumeOf(mesh), volume, 1e-12);
      TAUTLINE_CHECK(wallsOf(mesh) == walls);
      TAUTLINE_CHECK(worstQuality(mesh) >= worst * (1.0 - 1e-12));
      worst = worstQuality(mesh);
      TAUTLINE_EACH_OF(TetId s, operations.changed(), TAUTLINE_CHECK(mesh.alive(s)));
    }
  }
  TAUTLINE_CHECK(accepted >= wanted);
  TAUTLINE_CHECK(undone > 0);
}
}

TAUTLINE_TEST(TestTetrahedronMesh)
{
  TAUTLINE_RUN(testRandomOperations(400));
  TAUTLINE_RUN_SLOW(testRandomOperations(4000));
}
