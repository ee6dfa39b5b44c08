// SPDX-License-Identifier: BSD-3-Clause
// improveTriangles() of planar meshes: known optima, invariances, what is kept.

#include "Registry.h"
#include "Triangulating.h"

#include <thread>

using namespace tautline;

namespace
{
using Preset = ReconnectionPreset;

constexpr Preset presets[] = { Preset::RemoveSlivers, Preset::SwapOnly, Preset::SwapAndSmooth,
  Preset::Aggressive };

Vec2 flat(const Vec3& p)
{
  return { p[0], p[1] };
}

std::set<std::array<Index, 3>> cellsOf(const MeshData& data)
{
  std::set<std::array<Index, 3>> cells;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    std::array<Index, 3> t;
    std::copy_n(&data.connectivity[3 * c], 3, t.begin());
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    cells.insert(t);
  }
  return cells;
}

/// Flips lead from any triangulation to the Delaunay triangulation: no point in any circumcircle.
/// Its smallest angle is the largest of all triangulations of the points.
TAUTLINE_PART(testDelaunay)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    const MeshData delaunay = delaunaySquare(150, seed);
    const MeshData input = randomlyFlipped(delaunay, 4000, seed);
    TAUTLINE_CHECK(smallestAngle(input) < 0.5 * smallestAngle(delaunay));
    const ReconnectionResult result = reconnect(input, triangleOptions(Preset::SwapOnly));
    const MeshData output = trianglesOf(result);
    checkTriangles(input, result);
    TAUTLINE_CHECK(output.points == input.points);
    TAUTLINE_CHECK_RELATIVE(smallestAngle(output), smallestAngle(delaunay), 1e-12);
    TAUTLINE_CHECK(cellsOf(output) == cellsOf(delaunay));
    for (Index c = 0; c < output.numberOfCells(); ++c)
    {
      const Index* v = &output.connectivity[3 * c];
      const Vec2 p = flat(output.point(v[0])), q = flat(output.point(v[1]));
      const Vec2 r = flat(output.point(v[2]));
      TAUTLINE_EACH(Index, i, output.numberOfPoints(),
        TAUTLINE_CHECK(inCircle(p, q, r, flat(output.point(i))) <= 0));
    }
  }
}

/// The largest smallest angle of all triangulations of a convex polygon, by dynamic programming.
double bestOfPolygon(const MeshData& data, Index n)
{
  const auto angle = [&](Index a, Index b, Index c)
  {
    return smallestAngle(
      singleCell(CellType::Triangle, { data.point(a), data.point(b), data.point(c) }));
  };
  std::vector<std::vector<double>> best(n, std::vector<double>(n, 180.0));
  for (Index length = 2; length < n; ++length)
  {
    for (Index i = 0; i + length < n; ++i)
    {
      best[i][i + length] = 0.0;
      for (Index k = i + 1; k < i + length; ++k)
      {
        best[i][i + length] = std::max(best[i][i + length],
          std::min({ best[i][k], best[k][i + length], angle(i, k, i + length) }));
      }
    }
  }
  return best[0][n - 1];
}

TAUTLINE_PART(testPolygon)
{
  constexpr Index corners = 11;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    Random random(seed);
    std::vector<double> turns(corners);
    for (double& turn : turns)
    {
      turn = random.uniform(0.0, 2.0 * Pi);
    }
    std::sort(turns.begin(), turns.end());
    MeshData fan;
    for (double turn : turns)
    {
      fan.addPoint({ 3.0 * std::cos(turn), std::sin(turn), 0.5 });
    }
    for (Index i = 1; i + 1 < corners; ++i)
    {
      fan.addCell(CellType::Triangle, { 0, i, i + 1 });
    }
    const ReconnectionResult result = reconnect(fan, triangleOptions(Preset::SwapOnly));
    TAUTLINE_CHECK_RELATIVE(result.history.back().smallestAngle, bestOfPolygon(fan, corners), 1e-9);
  }
}

/// A point within a regular hexagon goes to its middle: all angles are then 60 degrees.
TAUTLINE_PART(testHexagon)
{
  MeshData data;
  for (int k = 0; k < 6; ++k)
  {
    data.addPoint({ std::cos(k * Pi / 3), std::sin(k * Pi / 3), 0.0 });
  }
  data.addPoint({ 0.6, 0.31, 0.0 });
  for (Index k = 0; k < 6; ++k)
  {
    data.addCell(CellType::Triangle, { k, (k + 1) % 6, 6 });
  }
  TriangleOptions options = triangleOptions(Preset::SwapAndSmooth);
  TAUTLINE_SET(options, swap = false, targetAngle = 60.0);
  const ReconnectionResult result = reconnect(data, options);
  TAUTLINE_CHECK(result.history.back().smallestAngle > 59.5);
  TAUTLINE_CHECK(norm(trianglesOf(result).point(6)) < 0.01);
}

/// Every preset on a sheet of slivers: never worse, the border and the area stay.
TAUTLINE_PART(testPresets)
{
  for (Preset preset : presets)
  {
    const Context context("preset " + std::to_string(static_cast<int>(preset)));
    const MeshData data = sliverSheet(16);
    const ReconnectionResult result = reconnect(data, triangleOptions(preset));
    const MeshData output = trianglesOf(result);
    checkTriangles(data, result);
    TAUTLINE_CHECK_RELATIVE(areaOf(output), areaOf(data), 1e-14);
    TAUTLINE_CHECK(borderOf(output) == borderOf(data));
    const double angle = result.history.back().smallestAngle;
    TAUTLINE_CHECK(result.history.front().smallestAngle < 1.0);
    TAUTLINE_CHECK(angle >= (preset == Preset::SwapOnly           ? 2.0
                                : preset == Preset::SwapAndSmooth ? 25.0
                                : preset == Preset::Aggressive    ? 39.9
                                                                  : 15.0));
    TAUTLINE_CHECK(preset != Preset::SwapOnly || output.points == data.points);
    const ReconnectionResult again = reconnect(data, triangleOptions(preset));
    TAUTLINE_CHECK(again.points == result.points && again.triangles == result.triangles);
    // Original cells contain the centroids.
    for (Index c = 0; c < output.numberOfCells(); ++c)
    {
      const Index* v = &output.connectivity[3 * c];
      const Vec3 x = (1.0 / 3.0) * (output.point(v[0]) + output.point(v[1]) + output.point(v[2]));
      const Index* w = &data.connectivity[3 * result.originalCells[c]];
      for (int k = 0; k < 3; ++k)
      {
        const Vec3 a = data.point(w[k]), b = data.point(w[(k + 1) % 3]);
        TAUTLINE_CHECK(cross(b - a, x - a)[2] > -1e-9);
      }
    }
    for (const PointInterpolation& place : result.interpolations)
    {
      Vec3 x = sumOf<Vec3>({ 0, 0, 0 }, 3,
        [&](int k)
        { return place.weights[k] * data.point(data.connectivity[3 * place.cell + k]); });
      TAUTLINE_CHECK(norm(x - output.point(place.point)) < 1e-12);
      TAUTLINE_CHECK_EQUAL(result.originalPoints[place.point], -1);
    }
  }
}

/// The same triangulation for other units, directions and numbers.
TAUTLINE_PART(testInvariance)
{
  const MeshData data = randomlyFlipped(delaunaySquare(200, 3), 3000, 3);
  const TriangleOptions swap = triangleOptions(Preset::SwapOnly);
  const auto expected = cellsOf(trianglesOf(reconnect(data, swap)));
  MeshData sheet = sliverSheet(14, 3);
  sheet.transform([](Vec3 p) { return (1.0 / 14.0) * p; });
  for (double scale : { 1e-8, 1e8, 0x1p-90, 0x1p80 })
  {
    const Context context("scale " + std::to_string(scale));
    MeshData scaled = data;
    scaled.transform([&](Vec3 p) { return scale * p; });
    TAUTLINE_CHECK(cellsOf(trianglesOf(reconnect(scaled, swap))) == expected);
    scaled = sheet;
    scaled.transform([&](Vec3 p) { return scale * p; });
    const ReconnectionResult result = reconnect(scaled, triangleOptions(Preset::Aggressive));
    TAUTLINE_CHECK(result.history.back().smallestAngle > 39.9);
    TAUTLINE_CHECK_RELATIVE(areaOf(trianglesOf(result)), scale * scale, 1e-13);
  }
  Random random(4);
  for (int i = 0; i < 4; ++i)
  {
    const Context context("rotation " + std::to_string(i));
    auto turn = randomRotation(random);
    // Planar meshes are positive seen along their normal, whose largest component is positive.
    const Vec3 n = turn[2];
    const double largest = std::max({ n[0], n[1], n[2] }), least = std::min({ n[0], n[1], n[2] });
    if (-least > largest)
    {
      turn[1] = -1.0 * turn[1];
      turn[2] = -1.0 * turn[2];
      turn[0] = cross(turn[1], turn[2]);
    }
    MeshData turned = data;
    turned.transform([&](Vec3 p) { return turn * p + Vec3{ 1, 2, 3 }; });
    TAUTLINE_CHECK(cellsOf(trianglesOf(reconnect(turned, swap))) == expected);
    turned = sheet;
    turned.transform([&](Vec3 p) { return turn * p + Vec3{ 1, 2, 3 }; });
    const ReconnectionResult result = reconnect(turned, triangleOptions(Preset::Aggressive));
    const MeshData output = trianglesOf(result);
    TAUTLINE_CHECK(result.history.back().smallestAngle > 39.9);
    TAUTLINE_CHECK_RELATIVE(areaOf(output), 1.0, 1e-13);
    const Vec3 normal = turn * Vec3{ 0, 0, 1 };
    for (Index p = 0; p < output.numberOfPoints(); ++p)
    {
      TAUTLINE_CHECK(std::abs(dot(output.point(p) - Vec3{ 1, 2, 3 }, normal)) < 1e-14);
    }
  }
  const MeshData other = shuffled(data, 9);
  const auto angles = [](const MeshData& of)
  {
    std::vector<double> values = valuesOf(of, Metric::MinimumAngle);
    std::sort(values.begin(), values.end());
    return values;
  };
  const std::vector<double> one = angles(trianglesOf(reconnect(data, swap)));
  const std::vector<double> two = angles(trianglesOf(reconnect(other, swap)));
  TAUTLINE_CHECK_EQUAL(one.size(), two.size());
  TAUTLINE_EACH(std::size_t, i, one.size(), TAUTLINE_CHECK_RELATIVE(one[i], two[i], 1e-9));
  // Reversed throughout: the mirror image.
  MeshData reversed = TAUTLINE_CHANGED(data, swapNodes(0, 1));
  Mesh mirrored(reversed.view());
  mirrored.setMirrored(true);
  const ReconnectionResult result = improveTriangles(mirrored, swap);
  TAUTLINE_EACH(Index, c, static_cast<Index>(result.originalCells.size()),
    TAUTLINE_CHECK(areaVector(trianglesOf(result), c)[2] < 0.0));
  TAUTLINE_CHECK_RELATIVE(
    result.history.back().smallestAngle, reconnect(data, swap).history.back().smallestAngle, 1e-9);
}

/// Regions keep their areas, their common edges and their cells.
TAUTLINE_PART(testRegions)
{
  const MeshData data = sliverSheet(14, 7);
  auto regions = collect<Index>(data.numberOfCells(),
    [&](Index c) { return (c / 2 % 14 < 6 ? 4 : -1) + (c / 28 < 5 ? 7 : 0); });
  for (auto boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    TriangleOptions options = triangleOptions(Preset::Aggressive);
    TAUTLINE_SET(options, regions = regions.data(), boundary = boundary);
    const ReconnectionResult result = reconnect(data, options);
    const MeshData output = trianglesOf(result);
    checkTriangles(data, result);
    auto after =
      collect<Index>(result.originalCells, [&](Index original) { return regions[original]; });
    for (Index region : { -1, 4, 6, 11 })
    {
      TAUTLINE_CHECK_RELATIVE(areaOf(output, after, region), areaOf(data, regions, region), 1e-13);
    }
    TAUTLINE_CHECK(
      result.history.back().smallestAngle >= 10.0 * result.history.front().smallestAngle);
  }
}

/// Straight parts of the border: points slide, are removed and added there; the shape stays.
TAUTLINE_PART(testFlat)
{
  // Points of the border that are unevenly spaced.
  MeshData data = sliverSheet(12, 3, 0.3);
  data.transform(TAUTLINE_PLACE(p[0] + 0.07 * p[0] * p[0], p[1] + 0.3 * std::sin(p[1]), 0.0));
  TriangleOptions options = triangleOptions(Preset::Aggressive);
  const double kept = reconnect(data, options).history.back().smallestAngle;
  TAUTLINE_SET(options, boundary = BoundaryMotion::FlatParts, smallestCount = 0.5);
  const ReconnectionResult result = reconnect(data, options);
  const MeshData output = trianglesOf(result);
  checkTriangles(data, result);
  TAUTLINE_CHECK(result.pointsOnLines == 4 * 11);
  TAUTLINE_CHECK(borderOf(output) != borderOf(data));
  TAUTLINE_CHECK_RELATIVE(areaOf(output), areaOf(data), 1e-13);
  const double right = 12 + 0.07 * 144, top = 12 + 0.3 * std::sin(12.0);
  for (const auto& ends : borderOf(output))
  {
    const auto along = [&](int axis, double value)
    { return std::abs(ends[0][axis] - value) < 1e-13 && std::abs(ends[1][axis] - value) < 1e-13; };
    TAUTLINE_CHECK(along(0, 0.0) || along(0, right) || along(1, 0.0) || along(1, top));
  }
  TAUTLINE_CHECK(result.history.back().smallestAngle >= 40.0 && kept >= 39.0);
}

/// Then best shape: the mean becomes better, the worst does not become worse, the shape stays.
TAUTLINE_PART(testMean)
{
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    const MeshData data = sliverSheet(12);
    TriangleOptions options = triangleOptions(Preset::Aggressive);
    options.boundary = boundary;
    const ReconnectionResult plain = reconnect(data, options);
    options.improveMean = true;
    const ReconnectionResult result = reconnect(data, options);
    checkTriangles(data, result);
    const MeshData output = trianglesOf(result);
    TAUTLINE_CHECK(result.triangles == plain.triangles);
    TAUTLINE_CHECK_RELATIVE(areaOf(output), areaOf(data), 1e-13);
    const ReconnectionRecord &last = result.history.back(), &before = plain.history.back();
    TAUTLINE_CHECK(last.smallestAngle >= before.smallestAngle * (1.0 - 1e-12));
    TAUTLINE_CHECK(last.worstInverseMeanRatio <= before.worstInverseMeanRatio * (1.0 + 1e-12));
    TAUTLINE_CHECK(last.moves > before.moves);
    const auto mean = [](const MeshData& mesh)
    {
      const std::vector<double> imr = valuesOf(mesh, Metric::InverseMeanRatio);
      return std::accumulate(imr.begin(), imr.end(), 0.0) / static_cast<double>(imr.size());
    };
    TAUTLINE_CHECK(mean(output) < 1.0 + 0.9 * (mean(trianglesOf(plain)) - 1.0));
    // One point within a hexagon goes to its center, the regular triangles.
    MeshData hexagon;
    for (int i = 0; i < 6; ++i)
    {
      const double turn = Pi / 3.0 * i;
      hexagon.addPoint({ std::cos(turn), std::sin(turn), 0.0 });
      hexagon.addCell(CellType::Triangle, std::vector<Index>{ i, (i + 1) % 6, 6 });
    }
    hexagon.addPoint({ 0.3, 0.2, 0.0 });
    options.swap = options.smooth = options.insert = options.contract = options.compound = false;
    const ReconnectionResult moved = reconnect(hexagon, options);
    TAUTLINE_CHECK(norm(trianglesOf(moved).point(6)) < 1e-2);
    TAUTLINE_CHECK_NEAR(moved.history.back().worstInverseMeanRatio, 1.0, 1e-2);
  }
}

TAUTLINE_PART(testCount)
{
  const MeshData data = sliverSheet(14, 11);
  for (double factor : { 1.0, 1.02, 1.1 })
  {
    TriangleOptions options = triangleOptions(Preset::Aggressive);
    TAUTLINE_SET(options, smallestCount = 1.0 / factor, largestCount = factor);
    const ReconnectionResult result = reconnect(data, options);
    const double ratio = static_cast<double>(result.history.back().tetrahedra) /
      static_cast<double>(data.numberOfCells());
    TAUTLINE_CHECK(ratio <= factor && ratio >= 1.0 / factor - 1e-12);
    if (factor == 1.0)
    {
      TAUTLINE_CHECK_EQUAL(result.history.back().insertions, 0);
      TAUTLINE_CHECK_EQUAL(result.history.back().contractions, 0);
    }
  }
}

/// Marked edges and fixed points stay; elements that they keep below the target are reported as
/// such.
TAUTLINE_PART(testKept)
{
  const MeshData data = sliverSheet(12, 13);
  TriangleOptions options = triangleOptions(Preset::Aggressive);
  std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
  for (std::size_t i = 0; i < fixed.size(); i += 5)
  {
    fixed[i] = 1;
  }
  options.fixed = fixed.data();
  Index next = 0;
  for (const auto& use : edgesOf(data))
  {
    if (++next % 9 == 0)
    {
      options.markedEdges.push_back({ use.first[1], use.first[0] });
    }
  }
  const ReconnectionResult result = reconnect(data, options);
  const MeshData output = trianglesOf(result);
  checkTriangles(data, result);
  std::vector<Index> place(data.numberOfPoints(), -1);
  for (std::size_t i = 0; i < result.originalPoints.size(); ++i)
  {
    if (result.originalPoints[i] >= 0)
    {
      place[result.originalPoints[i]] = static_cast<Index>(i);
    }
  }
  for (std::size_t i = 0; i < fixed.size(); i += 5)
  {
    TAUTLINE_CHECK(place[i] >= 0 && output.point(place[i]) == data.point(static_cast<Index>(i)));
  }
  const auto edges = edgesOf(output);
  for (const EdgeKey& edge : options.markedEdges)
  {
    const Index a = place[edge[0]], b = place[edge[1]];
    TAUTLINE_CHECK(a >= 0 && b >= 0 && edges.count({ std::min(a, b), std::max(a, b) }) == 1);
  }
  Index below = 0;
  std::map<int, Index> reasons;
  for (signed char obstacle : result.obstacles)
  {
    below += obstacle != 0;
    ++reasons[obstacle];
  }
  TAUTLINE_CHECK_EQUAL(below, result.history.back().belowTarget);
  TAUTLINE_CHECK(reasons[static_cast<int>(ReconnectionObstacle::FixedPoints)] > 0);
  TAUTLINE_CHECK(reasons[static_cast<int>(ReconnectionObstacle::Interface)] > 0);

  std::fill(fixed.begin(), fixed.end(), 1);
  options.swap = options.insert = false;
  const ReconnectionResult still = reconnect(data, options);
  TAUTLINE_CHECK(still.points == data.points && still.triangles == data.connectivity);
}

/// A corner of 20 degrees: no mesh has a larger smallest angle, and that is reported.
TAUTLINE_PART(testForced)
{
  constexpr double corner = 20.0 * Pi / 180.0;
  TAUTLINE_LET(MeshData, data, addPoint({ 0, 0, 0 }), addPoint({ 1, 0, 0 }),
    addPoint({ std::cos(corner), std::sin(corner), 0 }), addCell(CellType::Triangle, { 0, 1, 2 }));
  const ReconnectionResult result = reconnect(data, triangleOptions(Preset::Aggressive));
  TAUTLINE_CHECK_EQUAL(result.history.back().tetrahedra, 1);
  TAUTLINE_CHECK_EQUAL(
    static_cast<int>(result.obstacles[0]), static_cast<int>(ReconnectionObstacle::Facets));
  TAUTLINE_CHECK_RELATIVE(result.forcedQuality, std::sin(corner), 1e-12);
  TAUTLINE_CHECK_RELATIVE(
    result.forcedInverseMeanRatio, valuesOf(data, Metric::InverseMeanRatio)[0], 1e-12);
}

TAUTLINE_PART(testLimits)
{
  const MeshData data = sliverSheet(40, 3);
  TriangleOptions options = triangleOptions(Preset::Aggressive);
  options.maximumSeconds = 1e-9;
  const ReconnectionResult timed = reconnect(data, options);
  TAUTLINE_CHECK(timed.reason == StopReason::TimeLimit);
  checkTriangles(data, timed);
  options.maximumSeconds = 0.0;
  for (int allowed : { 0, 1, 3 })
  {
    int calls = 0;
    double last = 0.0;
    options.observer = [&](const ReconnectionRecord&, double progress)
    {
      TAUTLINE_CHECK(progress >= last && progress <= 1.0);
      last = progress;
      return calls++ < allowed;
    };
    const ReconnectionResult stopped = reconnect(data, options);
    TAUTLINE_CHECK(stopped.reason == StopReason::Aborted);
    TAUTLINE_CHECK_EQUAL(calls, allowed + 1);
    checkTriangles(data, stopped);
  }
  // An observer that ends the run within a pass is not called again at the end of the pass.
  const auto longerThanItsInterval = std::chrono::milliseconds(150);
  int calls = 0;
  options.observer = [&](const ReconnectionRecord&, double)
  {
    std::this_thread::sleep_for(longerThanItsInterval);
    return ++calls < 2;
  };
  const ReconnectionResult within = reconnect(data, options);
  TAUTLINE_CHECK(within.reason == StopReason::Aborted);
  TAUTLINE_CHECK_EQUAL(calls, 2);
  checkTriangles(data, within);
}
}
