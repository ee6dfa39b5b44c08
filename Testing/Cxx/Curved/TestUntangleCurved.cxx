// SPDX-License-Identifier: BSD-3-Clause
// Curved elements become valid by moving all their nodes, certified; the boundary stays where it is
// to stay.
#include "CurvedBlocks.h"
#include "MfemFile.h"
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Curved/UntangleCurved.h"

using namespace tautline;

namespace
{
struct Case
{
  CellType type;
  int order;
  double amplitude;
};

CurvedUntangleResult untangle(
  const MeshData& data, const std::function<void(CurvedOptions&)>& set = {})
{
  TAUTLINE_LET(CurvedOptions, options, boundary = BoundaryMotion::Fixed);
  if (set)
  {
    set(options);
  }
  return untangleCurved(Mesh(data.view()), options);
}

bool samePoint(const std::vector<double>& a, const std::vector<double>& b, Index p)
{
  return std::equal(&a[3 * p], &a[3 * p] + 3, &b[3 * p]);
}

/// A ring of quadratic triangles between the circles of radius 1 and 2, with all nodes on these
/// or between; the outer circle is turned by some cells, so that all triangles are folded.
MeshData turnedRing(Index around, double cells)
{
  MeshData linear;
  for (Index ring = 0; ring < 2; ++ring)
  {
    for (Index i = 0; i < around; ++i)
    {
      linear.addPoint({ static_cast<double>(i), static_cast<double>(ring), 0 });
    }
  }
  for (Index i = 0; i < around; ++i)
  {
    const Index j = (i + 1) % around;
    linear.addCell(CellType::Triangle, std::vector<Index>{ i, around + j, j });
    linear.addCell(CellType::Triangle, std::vector<Index>{ i, around + i, around + j });
  }
  MeshData data = quadraticOf(linear);
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    // The cells at the seam have middles between the last point and the first one.
    const std::vector<Index> n = data.nodes(cell);
    for (int e = 0; e < 3; ++e)
    {
      const double a = linear.point(n[e])[0], b = linear.point(n[(e + 1) % 3])[0];
      const bool across = std::abs(a - b) > 1.5;
      const double y = 0.5 * (linear.point(n[e])[1] + linear.point(n[(e + 1) % 3])[1]);
      data.setPoint(n[3 + e], { across ? static_cast<double>(around) - 0.5 : 0.5 * (a + b), y, 0 });
    }
  }
  data.transform(
    [=](const Vec3& p)
    {
      const double angle = 2 * Pi * (p[0] + cells * p[1]) / static_cast<double>(around);
      const double r = 1 + p[1];
      return Vec3{ r * std::cos(angle), r * std::sin(angle), 0 };
    });
  return data;
}
}

TAUTLINE_PART(testBlocks)
{
  for (const Case& c : { Case{ CellType::Triangle, 2, 0.3 }, Case{ CellType::Triangle, 3, 0.2 },
         Case{ CellType::Quadrilateral, 2, 0.35 }, Case{ CellType::Quadrilateral, 4, 0.14 },
         Case{ CellType::Tetrahedron, 2, 0.22 }, Case{ CellType::Tetrahedron, 3, 0.13 },
         Case{ CellType::Hexahedron, 2, 0.3 }, Case{ CellType::Wedge, 2, 0.25 },
         Case{ CellType::Pyramid, 2, 0.16 } })
  {
    const Context context(topology(c.type).name + std::to_string(c.order));
    constexpr Index n = 3;
    const MeshData data = movedCurvedBlock(c.type, c.order, n, c.amplitude);
    const CurvedUntangleResult result = untangle(data);
    TAUTLINE_CHECK(result.invalidBefore > 0);
    TAUTLINE_CHECK_EQUAL(result.invalidBefore, invalidCells(data, data.points));
    TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
    TAUTLINE_CHECK_EQUAL(invalidCells(data, result.points), 0);
    TAUTLINE_CHECK(result.reason == StopReason::AllValid);
    const std::vector<unsigned char> fixed =
      sides(movedCurvedBlock(c.type, c.order, n, 0), n, topology(c.type).dimension);
    for (Index p = 0; p < data.numberOfPoints(); ++p)
    {
      TAUTLINE_CHECK(!fixed[p] || samePoint(result.points, data.points, p));
    }
    // The number of threads does not matter.
    const CurvedUntangleResult other =
      untangle(data, [](CurvedOptions& options) { options.threads = 3; });
    TAUTLINE_CHECK(other.points == result.points);
  }
}

TAUTLINE_PART(testValidMesh)
{
  const MeshData data = movedCurvedBlock(CellType::Tetrahedron, 2, 3, 0.02);
  const CurvedUntangleResult result = untangle(data);
  TAUTLINE_CHECK_EQUAL(result.invalidBefore, 0);
  TAUTLINE_CHECK(result.points == data.points);
}

TAUTLINE_PART(testInclinedPlane)
{
  MeshData data = movedCurvedBlock(CellType::Triangle, 2, 3, 0.3);
  const Columns turn = rotation({ 0.36, 0.48, 0.8 }, 0.7);
  data.transform([&](const Vec3& p) { return turn * p + Vec3{ 1, 2, 3 }; });
  const CurvedUntangleResult result = untangle(data);
  TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
  const Vec3 normal = turn[2];
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3 x = { result.points[3 * p], result.points[3 * p + 1], result.points[3 * p + 2] };
    TAUTLINE_CHECK_NEAR(dot(normal, x - Vec3{ 1, 2, 3 }), 0, 1e-12);
  }
}

TAUTLINE_PART(testOnSurface)
{
  // All corners are on the circles: triangles that are turned over need points that slide.
  constexpr Index around = 16;
  constexpr double cells = 7;
  const MeshData data = turnedRing(around, cells);
  TAUTLINE_CHECK(invalidCells(data, data.points) > 0);
  TAUTLINE_CHECK(untangle(data).invalidAfter > 0);
  const CurvedUntangleResult result =
    untangle(data, [](CurvedOptions& options) { options.boundary = BoundaryMotion::OnSurface; });
  TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
  TAUTLINE_CHECK_EQUAL(invalidCells(data, result.points), 0);
  // The quadratic edges are near the circles.
  constexpr double nearCircle = 2e-3;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const double before = norm(data.point(p));
    const double after = std::hypot(result.points[3 * p], result.points[3 * p + 1]);
    const bool onCircle = std::abs(before - 1) < 1e-9 || std::abs(before - 2) < 1e-9;
    TAUTLINE_CHECK(!onCircle || std::abs(after - before) < nearCircle);
  }
}

TAUTLINE_PART(testMidNodesOnly)
{
  MeshData data = raised(blockMesh(CellType::Triangle, 3, 3, 0), 2);
  const MeshData straight = data;
  const Index corners = 16;
  // A middle node inside is taken far away.
  const std::vector<unsigned char> fixed = sides(data, 3, 2);
  Index middle = corners;
  while (fixed[middle])
  {
    ++middle;
  }
  data.points[3 * middle] += 0.6;
  const CurvedUntangleResult result =
    untangle(data, [](CurvedOptions& options) { options.midNodesOnly = true; });
  TAUTLINE_CHECK(result.invalidBefore > 0);
  TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
  for (Index p = 0; p < corners; ++p)
  {
    TAUTLINE_CHECK(samePoint(result.points, straight.points, p));
  }
}

TAUTLINE_PART(testLimits)
{
  const MeshData data = movedCurvedBlock(CellType::Tetrahedron, 2, 3, 0.3);
  int calls = 0;
  const CurvedUntangleResult stopped = untangle(data,
    [&](CurvedOptions& options)
    { options.observer = [&](const IterationState&) { return ++calls < 2; }; });
  TAUTLINE_CHECK(stopped.reason == StopReason::Aborted);
  TAUTLINE_CHECK_EQUAL(calls, 2);
  TAUTLINE_CHECK(stopped.invalidAfter <= stopped.invalidBefore);
  const std::vector<unsigned char> all(data.numberOfPoints(), 1);
  const CurvedUntangleResult none =
    untangle(data, [&](CurvedOptions& options) { options.fixed = all.data(); });
  TAUTLINE_CHECK(none.reason == StopReason::NoFreeVertices);
  TAUTLINE_CHECK(none.points == data.points);

  MeshData surface = movedCurvedBlock(CellType::Triangle, 2, 3, 0.3);
  surface.transform(TAUTLINE_PLACE(p[0], p[1], p[0] * p[0]));
  TAUTLINE_CHECK_THROWS(untangle(surface), wording("curved-cells-of-a-surface-in-space"));
}

TAUTLINE_PART(testFiles)
{
  const MeshFile file = readMfem(externalData("curved") + "/cube-holes-inv.mesh", false);
  TAUTLINE_LET(MeshData, data, points = file.points, types = file.cellTypes, offsets = file.offsets,
    connectivity = file.connectivity);
  const CurvedUntangleResult result = untangle(data);
  TAUTLINE_CHECK_EQUAL(result.invalidBefore, 219);
  TAUTLINE_CHECK_EQUAL(result.invalidAfter, 0);
  TAUTLINE_CHECK_EQUAL(invalidCells(data, result.points), 0);
}
