// SPDX-License-Identifier: BSD-3-Clause
// improveConnectivity() with a boundary that stays within a distance of the input's.

#include "Reconnecting.h"
#include "Registry.h"

using namespace tautline;

namespace
{
using Facet = std::array<Vec3, 3>;
constexpr Index Cubes = RoundCubes;

/// The closest points of a triangle to x, by brute force over its interior and edges.
double distanceTo(const Facet& f, const Vec3& x)
{
  const Vec3 n = cross(f[1] - f[0], f[2] - f[0]);
  double least = norm(x - f[0]);
  bool inside = true;
  for (int i = 0; i < 3; ++i)
  {
    const Vec3 &a = f[i], &b = f[(i + 1) % 3];
    const double s = std::clamp(dot(x - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
    least = std::min(least, norm(x - (a + s * (b - a))));
    inside = inside && dot(cross(b - a, x - a), n) >= 0.0;
  }
  return inside ? std::abs(dot(x - f[0], n)) / norm(n) : least;
}

double distanceTo(const std::set<Facet>& facets, const Vec3& x)
{
  return smallestOf<double>(1e300, facets, [&](const Facet& f) { return distanceTo(f, x); });
}

/// At the corners, the middles of edges and the centers.
double distanceTo(const std::set<Facet>& from, const std::set<Facet>& to)
{
  double largest = 0.0;
  for (const auto& [a, b, c] : from)
  {
    for (const Vec3& x :
      { a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (1.0 / 3.0) * (a + b + c) })
    {
      largest = std::max(largest, distanceTo(to, x));
    }
  }
  return largest;
}

/// Every edge has two facets; points less edges plus facets.
Index eulerOf(const std::set<Facet>& facets)
{
  std::map<std::array<Vec3, 2>, int> edges;
  std::set<Vec3> points;
  for (const Facet& f : facets)
  {
    for (int i = 0; i < 3; ++i)
    {
      points.insert(f[i]);
      ++edges[{ std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3]) }];
    }
  }
  TAUTLINE_EACH_OF(const auto& edge, edges, TAUTLINE_CHECK_EQUAL(edge.second, 2));
  return static_cast<Index>(points.size()) - static_cast<Index>(edges.size()) +
    static_cast<Index>(facets.size());
}

ReconnectionOptions surfaceOptions()
{
  ReconnectionOptions options = optionsOf(ReconnectionPreset::Aggressive);
  TAUTLINE_SET(options, boundary = BoundaryMotion::OnSurface, threads = 1);
  return options;
}

/// As checkResult(), but that the volume changes with the boundary.
void checkBoundary(const MeshData& input, const ReconnectionResult& result, double tolerance)
{
  const MeshData output = outputOf(result);
  TAUTLINE_EACH_OF(signed char v, validityOf(output),
    TAUTLINE_CHECK_EQUAL(static_cast<int>(v), static_cast<int>(Valid)));
  const ReconnectionRecord &first = result.history.front(), &last = result.history.back();
  TAUTLINE_CHECK(last.smallestAngle >= first.smallestAngle);
  TAUTLINE_CHECK(last.worstInverseMeanRatio <= first.worstInverseMeanRatio);
  TAUTLINE_CHECK(last.worstQuality >= first.worstQuality);
  const std::set<Facet> before = outerFacets(input), after = outerFacets(output);
  TAUTLINE_CHECK_EQUAL(eulerOf(after), eulerOf(before));
  const double there = distanceTo(after, before), back = distanceTo(before, after);
  // Both ways, at corners, middles of edges and centers of facets.
  TAUTLINE_CHECK(there <= tolerance * (1.0 + 1e-9));
  TAUTLINE_CHECK(back <= 1.25 * tolerance * (1.0 + 1e-9));
  TAUTLINE_CHECK_NEAR(result.boundaryDistance, std::max(there, back), 1e-12);
  TAUTLINE_CHECK_RELATIVE(result.volumeBefore, volumeOf(input), 1e-12);
  TAUTLINE_CHECK_RELATIVE(result.volumeAfter, volumeOf(output), 1e-12);
}

double diagonalOf(const MeshData& data)
{
  Vec3 low = data.point(0), high = low;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      low[k] = std::min(low[k], data.point(i)[k]);
      high[k] = std::max(high[k], data.point(i)[k]);
    }
  }
  return norm(high - low);
}

/// The facets of the block's edges and corners limit a fixed boundary; on the sphere all move.
TAUTLINE_PART(testBall)
{
  const Context context("ball");
  const MeshData ball = roundMesh(3);
  ReconnectionOptions options = surfaceOptions();
  const ReconnectionResult result = reconnect(ball, options);
  const double tolerance = options.surfaceTolerance * diagonalOf(ball);
  checkBoundary(ball, result, tolerance);
  const ReconnectionRecord& last = result.history.back();
  TAUTLINE_CHECK(last.boundarySwaps > 0);
  // Facets cut off more or less of the ball; which are swapped, rounding decides.
  TAUTLINE_CHECK(std::abs(result.volumeAfter / result.volumeBefore - 1.0) < 0.015);
  ReconnectionOptions fixed = TAUTLINE_CHANGED(options, boundary = BoundaryMotion::Fixed);
  const ReconnectionRecord still = reconnect(ball, fixed).history.back();
  std::cout << "ball: smallest angle " << still.smallestAngle << " fixed, " << last.smallestAngle
            << " on the surface; worst " << still.worstInverseMeanRatio << ", "
            << last.worstInverseMeanRatio << "; swaps " << last.boundarySwaps << "; distance "
            << result.boundaryDistance << " of " << tolerance << "; volume " << result.volumeBefore
            << ", " << result.volumeAfter << "\n";
  TAUTLINE_CHECK(last.smallestAngle > still.smallestAngle + 5.0);
  TAUTLINE_CHECK(last.worstInverseMeanRatio < 0.8 * still.worstInverseMeanRatio);
}

/// The rims are sharp edges: caps stay in their planes, and the points of rims on these.
TAUTLINE_PART(testCylinder)
{
  const Context context("cylinder");
  const MeshData cylinder = roundMesh(2);
  const ReconnectionOptions options = surfaceOptions();
  const ReconnectionResult result = reconnect(cylinder, options);
  const double tolerance = options.surfaceTolerance * diagonalOf(cylinder);
  checkBoundary(cylinder, result, tolerance);
  double before = 0.0, after = 0.0;
  const auto capArea = [](const std::set<Facet>& facets)
  {
    double area = 0.0;
    for (const Facet& f : facets)
    {
      const bool cap =
        std::all_of(f.begin(), f.end(), [](const Vec3& x) { return std::abs(x[2] - 1.0) < 1e-12; });
      area += cap ? 0.5 * norm(cross(f[1] - f[0], f[2] - f[0])) : 0.0;
    }
    return area;
  };
  before = capArea(outerFacets(cylinder));
  after = capArea(outerFacets(outputOf(result)));
  TAUTLINE_CHECK(std::abs(after / before - 1.0) < 0.02);
  std::cout << "cylinder: smallest angle " << result.history.front().smallestAngle << " to "
            << result.history.back().smallestAngle << "; caps " << before << ", " << after
            << "; distance " << result.boundaryDistance << " of " << tolerance << "\n";
  TAUTLINE_CHECK(result.history.back().smallestAngle > 20.0);

  // Without a distance only what is flat changes.
  ReconnectionOptions exact = TAUTLINE_CHANGED(options, surfaceTolerance = 0.0);
  const ReconnectionResult same = reconnect(cylinder, exact);
  checkBoundary(cylinder, same, 1e-11);
  TAUTLINE_CHECK_RELATIVE(same.volumeAfter, same.volumeBefore, 1e-10);
  TAUTLINE_CHECK(same.history.back().boundarySwaps > 0);
}

/// Facets between regions stay as they are, and fixed points where they are.
TAUTLINE_PART(testKept)
{
  const Context context("kept");
  const MeshData ball = roundMesh(3);
  std::vector<Index> regions;
  std::vector<unsigned char> fixed(ball.numberOfPoints(), 0);
  const MeshData block = blockMesh(CellType::Tetrahedron, Cubes, Cubes, Cubes);
  for (Index c = 0; c < block.numberOfCells(); ++c)
  {
    double x = sumOf<double>(
      0.0, 4, [&](int k) { return 0.25 * block.point(block.connectivity[4 * c + k])[0]; });
    regions.push_back(x < 0.5 * Cubes);
  }
  for (Index i = 0; i < ball.numberOfPoints(); i += 5)
  {
    fixed[i] = 1;
  }
  ReconnectionOptions options = surfaceOptions();
  TAUTLINE_SET(options, regions = regions.data(), fixed = fixed.data());
  const ReconnectionResult result = reconnect(ball, options);
  const MeshData output = outputOf(result);
  checkBoundary(ball, result, options.surfaceTolerance * diagonalOf(ball));
  auto after =
    collect<Index>(result.originalCells, [&](Index original) { return regions[original]; });
  const auto interface = [](const MeshData& data, const std::vector<Index>& of)
  {
    const std::set<Facet> first = outerFacets(data, of, 0), second = outerFacets(data, of, 1);
    std::set<Facet> common;
    std::set_intersection(first.begin(), first.end(), second.begin(), second.end(),
      std::inserter(common, common.end()));
    return common;
  };
  TAUTLINE_CHECK(interface(ball, regions).size() >= 2 * Cubes * Cubes);
  TAUTLINE_CHECK(interface(ball, regions) == interface(output, after));
  std::set<Vec3> points;
  for (Index i = 0; i < output.numberOfPoints(); ++i)
  {
    points.insert(output.point(i));
  }
  for (Index i = 0; i < ball.numberOfPoints(); i += 5)
  {
    TAUTLINE_CHECK(points.count(ball.point(i)) == 1);
  }
}

/// In blocks on any number of threads the same; also with the best shape at the end.
TAUTLINE_PART(testThreads)
{
  const Context context("threads");
  const MeshData ball = roundMesh(3);
  ReconnectionOptions options = surfaceOptions();
  TAUTLINE_SET(options, blockSize = 600, improveMean = true);
  const ReconnectionResult one = reconnect(ball, options);
  options.threads = 3;
  const ReconnectionResult three = reconnect(ball, options);
  TAUTLINE_CHECK(one.points == three.points);
  TAUTLINE_CHECK(one.tetrahedra == three.tetrahedra);
  checkBoundary(ball, one, options.surfaceTolerance * diagonalOf(ball));
}

/// The ball with needles for facets: points of the boundary at the side of one of their neighbors.
MeshData needleBall()
{
  constexpr Index step = 11; // apart from each other
  constexpr double way = 0.9;
  MeshData ball = roundMesh(3);
  const Mesh mesh(ball.view());
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  const VertexCells cells = mesh.vertexCells();
  Index count = 0;
  for (Index i = 0; i < ball.numberOfPoints(); ++i)
  {
    if (!boundary[i] || ++count % step != 0)
    {
      continue;
    }
    const Vec3 start = ball.point(i);
    const auto begin = cells.cells.begin();
    const auto valid = [&](Index cell) { return volumeOf(ball, cell) > 1e-6; };
    bool moved = false;
    for (Index k = cells.offsets[i]; k < cells.offsets[i + 1] && !moved; ++k)
    {
      for (Index j : ball.nodes(cells.cells[k]))
      {
        if (j == i || !boundary[j] || moved)
        {
          continue;
        }
        const Vec3 x = start + way * (ball.point(j) - start);
        ball.setPoint(i, (1.0 / norm(x)) * x);
        moved = std::all_of(begin + cells.offsets[i], begin + cells.offsets[i + 1], valid);
        ball.setPoint(i, moved ? ball.point(i) : start);
      }
    }
  }
  return ball;
}

/// Facets that nothing inside can make up for are improved first.
TAUTLINE_PART(testNeedles)
{
  const Context context("needles");
  const MeshData ball = needleBall();
  ReconnectionOptions options = surfaceOptions();
  const ReconnectionResult result = reconnect(ball, options);
  checkBoundary(ball, result, options.surfaceTolerance * diagonalOf(ball));
  options.boundary = BoundaryMotion::Fixed;
  const ReconnectionResult fixed = reconnect(ball, options);
  std::cout << "needles: " << result.history.front().smallestAngle << " to "
            << fixed.history.back().smallestAngle << " fixed, "
            << result.history.back().smallestAngle << " on the surface\n";
  TAUTLINE_CHECK(fixed.history.back().smallestAngle < 1.0);
  TAUTLINE_CHECK(result.history.back().smallestAngle > 4.0);
}

/// A higher target is never worse in any of the worst: the run for it goes on where the other ends.
TAUTLINE_PART(testTargets)
{
  const Context context("targets");
  const MeshData ball = needleBall();
  for (const BoundaryMotion boundary :
    { BoundaryMotion::Fixed, BoundaryMotion::FlatParts, BoundaryMotion::OnSurface })
  {
    for (const Index block : { ball.numberOfCells(), ball.numberOfCells() / 4 })
    {
      ReconnectionOptions options = surfaceOptions();
      TAUTLINE_SET(options, boundary = boundary, blockSize = block);
      ReconnectionRecord former;
      former.worstInverseMeanRatio = 1e300;
      for (const double angle : { 8.0, 15.0, 20.0, 24.0, 33.4, 36.0, 40.0 })
      {
        options.targetAngle = angle;
        const ReconnectionRecord last = reconnect(ball, options).history.back();
        TAUTLINE_CHECK(last.smallestAngle >= former.smallestAngle);
        TAUTLINE_CHECK(last.worstQuality >= former.worstQuality);
        TAUTLINE_CHECK(last.worstInverseMeanRatio <= former.worstInverseMeanRatio);
        former = last;
      }
    }
  }
}

TAUTLINE_PART(testOptions)
{
  const Context context("options");
  const MeshData ball = roundMesh(3);
  ReconnectionOptions options = TAUTLINE_CHANGED(surfaceOptions(), surfaceTolerance = -1.0);
  TAUTLINE_CHECK_THROWS(reconnect(ball, options), wording("surface-tolerance-must-be-0-to-1"));
  options = TAUTLINE_CHANGED(surfaceOptions(), featureAngle = 181.0);
  TAUTLINE_CHECK_THROWS(reconnect(ball, options), wording("feature-angle-must-be-0-to-180"));
  options = TAUTLINE_CHANGED(surfaceOptions(), boundary = BoundaryMotion::Free);
  TAUTLINE_CHECK_THROWS(reconnect(ball, options), wording("cannot-move-freely"));
}
}
