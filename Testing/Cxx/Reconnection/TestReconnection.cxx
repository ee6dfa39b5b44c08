// improveConnectivity(): what is kept, what improves, where the output follows from the input.

#include "Reconnecting.h"

using namespace tautline;

namespace
{
using Preset = ReconnectionPreset;

constexpr Preset presets[] = { Preset::RemoveSlivers, Preset::SwapOnly, Preset::SwapAndSmooth,
  Preset::Aggressive };

/// Barycentric coordinates of x in a cell.
std::array<double, 4> weightsOf(const MeshData& data, Index cell, const Vec3& x)
{
  const Index* v = &data.connectivity[4 * cell];
  std::array<double, 4> w;
  double sum = 0.0;
  for (int i = 0; i < 4; ++i)
  {
    Vec3 p[4];
    for (int k = 0; k < 4; ++k)
    {
      p[k] = k == i ? x : data.point(v[k]);
    }
    w[i] = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
    sum += w[i];
  }
  for (double& weight : w)
  {
    weight /= sum;
  }
  return w;
}

/// Original cells contain the centroids, original points keep their order, inserted points have the
/// weights of their place.
void checkOrigins(const MeshData& input, const ReconnectionResult& result)
{
  const MeshData output = outputOf(result);
  for (Index c = 0; c < output.numberOfCells(); ++c)
  {
    Vec3 centroid = { 0, 0, 0 };
    for (int k = 0; k < 4; ++k)
    {
      centroid += 0.25 * output.point(output.connectivity[4 * c + k]);
    }
    const auto w = weightsOf(input, result.originalCells[c], centroid);
    TAUTLINE_CHECK(*std::min_element(w.begin(), w.end()) > -1e-9);
  }
  Index last = -1;
  std::size_t inserted = 0;
  for (Index i = 0; i < output.numberOfPoints(); ++i)
  {
    const Index original = result.originalPoints[i];
    if (original >= 0)
    {
      TAUTLINE_CHECK(original > last);
      last = original;
      continue;
    }
    const PointInterpolation& place = result.interpolations[inserted++];
    TAUTLINE_CHECK_EQUAL(place.point, i);
    Vec3 x = { 0, 0, 0 };
    for (int k = 0; k < 4; ++k)
    {
      TAUTLINE_CHECK(place.weights[k] > -1e-9);
      x += place.weights[k] * input.point(input.connectivity[4 * place.cell + k]);
    }
    TAUTLINE_CHECK_NEAR(norm(x - output.point(i)), 0.0, 1e-12);
  }
  TAUTLINE_CHECK_EQUAL(inserted, result.interpolations.size());
}

void testPresets()
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    const MeshData data = sliverBlock(5, seed, 1.2);
    const auto facets = outerFacets(data);
    for (Preset preset : presets)
    {
      const Context context(
        "preset " + std::to_string(static_cast<int>(preset)) + " seed " + std::to_string(seed));
      const ReconnectionOptions options = optionsOf(preset);
      const ReconnectionResult result = reconnect(data, options);
      checkResult(data, result);
      checkOrigins(data, result);
      TAUTLINE_CHECK(outerFacets(outputOf(result)) == facets);
      const double count = static_cast<double>(result.history.back().tetrahedra) /
        static_cast<double>(data.numberOfCells());
      TAUTLINE_CHECK(count >= 0.9 && count <= 1.1);
      const double aim = preset == Preset::SwapOnly ? 1.0 : 10.0;
      TAUTLINE_CHECK(
        result.history.back().smallestAngle > aim + result.history.front().smallestAngle);
      // Unchanged by a second run, bit for bit.
      const ReconnectionResult again = reconnect(data, options);
      TAUTLINE_CHECK(again.points == result.points && again.tetrahedra == result.tetrahedra);
    }
  }
}

void testSwapOnly()
{
  const MeshData data = sliverBlock(5, 9, 1.2);
  const ReconnectionResult result = reconnect(data, optionsOf(Preset::SwapOnly));
  TAUTLINE_CHECK(result.points == data.points);
  TAUTLINE_CHECK(result.tetrahedra != data.connectivity);
  TAUTLINE_CHECK_EQUAL(result.history.back().moves, Index(0));
  TAUTLINE_CHECK(result.history.back().edgeRemovals > 0);
}

/// RemoveSlivers leaves good tetrahedra alone and reaches its angle; the target ends a run.
void testTargets()
{
  const MeshData data = sliverBlock(6, 5, 0.9);
  const ReconnectionResult slivers = reconnect(data, optionsOf(Preset::RemoveSlivers));
  TAUTLINE_CHECK(slivers.history.back().smallestAngle >= 15.0);
  TAUTLINE_CHECK(slivers.history.back().largestAngle <= 165.0);
  TAUTLINE_CHECK_EQUAL(static_cast<int>(slivers.reason), static_cast<int>(StopReason::Reduction));
  const MeshData output = outputOf(slivers);
  Index same = 0;
  for (Index c = 0; c < output.numberOfCells(); ++c)
  {
    same += std::equal(&output.connectivity[4 * c], &output.connectivity[4 * c] + 4,
      &data.connectivity[4 * slivers.originalCells[c]]);
  }
  const ReconnectionResult all = reconnect(data, optionsOf(Preset::Aggressive));
  TAUTLINE_CHECK(same > output.numberOfCells() / 3);
  TAUTLINE_CHECK(all.history.back().moves > 2 * slivers.history.back().moves);
  TAUTLINE_CHECK(all.history.back().smallestAngle > slivers.history.back().smallestAngle + 5.0);
  // A mesh that is good enough is not touched.
  ReconnectionOptions options;
  options.targetAngle = 10.0;
  const ReconnectionResult none = reconnect(output, options);
  TAUTLINE_CHECK(none.points == output.points && none.tetrahedra == output.connectivity);
  TAUTLINE_CHECK_EQUAL(none.history.size(), std::size_t(1));
  for (signed char obstacle : none.obstacles)
  {
    TAUTLINE_CHECK_EQUAL(static_cast<int>(obstacle), 0);
  }
}

void testCount()
{
  const MeshData data = sliverBlock(5, 6, 1.2);
  for (const auto& bounds : { std::array<double, 2>{ 1.0, 1.02 }, { 0.97, 1.0 }, { 0.5, 2.0 } })
  {
    ReconnectionOptions options;
    options.smallestCount = bounds[0];
    options.largestCount = bounds[1];
    const ReconnectionResult result = reconnect(data, options);
    checkResult(data, result);
    const double n = static_cast<double>(data.numberOfCells());
    for (const ReconnectionRecord& record : result.history)
    {
      TAUTLINE_CHECK(static_cast<double>(record.tetrahedra) >= bounds[0] * n &&
        static_cast<double>(record.tetrahedra) <= bounds[1] * n);
    }
  }
  ReconnectionOptions options;
  options.smallestCount = options.largestCount = 1.0;
  const ReconnectionResult result = reconnect(data, options);
  TAUTLINE_CHECK_EQUAL(result.history.back().insertions, Index(0));
  TAUTLINE_CHECK_EQUAL(result.history.back().contractions, Index(0));
  TAUTLINE_CHECK(result.history.back().edgeRemovals > 0);
  TAUTLINE_CHECK_EQUAL(result.points.size(), data.points.size());
}

/// Scales that are powers of two change nothing but the scale. Others, and rotations, round the
/// coordinates: swaps are the same where no two tetrahedra have the same quality. Smoothing makes
/// the worst tetrahedra equally good; then the result is only as good as before.
void testScales()
{
  MeshData data = sliverBlock(3, 4, 1.2);
  data.transform(
    [](const Vec3& p)
    {
      return p +
        0.03 *
        Vec3{ std::sin(p[1] + 2 * p[2] + p[0]), std::sin(2 * p[0] + 3 * p[2]),
          std::sin(3 * p[0] + 2 * p[1]) };
    });
  for (Preset preset : presets)
  {
    const Context context("preset " + std::to_string(static_cast<int>(preset)));
    const ReconnectionOptions options = optionsOf(preset);
    const ReconnectionResult reference = reconnect(data, options);
    TAUTLINE_CHECK(reference.tetrahedra != data.connectivity);
    for (double scale : { 0x1p-400, 0x1p-27, 0x1p27, 0x1p400 })
    {
      MeshData scaled = data;
      scaled.transform([&](const Vec3& p) { return scale * p; });
      const ReconnectionResult result = reconnect(scaled, options);
      TAUTLINE_CHECK(result.tetrahedra == reference.tetrahedra);
      TAUTLINE_CHECK(result.points.size() == reference.points.size());
      for (std::size_t i = 0; i < result.points.size(); ++i)
      {
        TAUTLINE_CHECK_EQUAL(result.points[i] / scale, reference.points[i]);
      }
    }
    const auto compare = [&](const auto& map)
    {
      MeshData moved = data;
      moved.transform(map);
      const ReconnectionResult result = reconnect(moved, options);
      TAUTLINE_CHECK(preset != Preset::SwapOnly || result.tetrahedra == reference.tetrahedra);
      TAUTLINE_CHECK_RELATIVE(result.history.back().worstQuality,
        reference.history.back().worstQuality, preset == Preset::SwapOnly ? 1e-8 : 0.1);
    };
    const Columns turn = rotation({ 1, 2, 3 }, 1.0);
    compare([](const Vec3& p) { return 1e-8 * p; });
    compare([](const Vec3& p) { return 1e8 * p; });
    compare([&](const Vec3& p) { return turn * p + Vec3{ 5, -3, 2 }; });
  }
}

void testRegions()
{
  const MeshData data = blockMesh(CellType::Tetrahedron, 6, 6, 6);
  MeshData slivers = sliverBlock(6, 8, 1.0);
  // Two regions meet at the plane x = 3, whose points stay; a third touches both.
  std::vector<Index> regions;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Vec3 m = Mesh(data.view()).center(c, CellType::Tetrahedron);
    regions.push_back(m[0] < 3 ? -7 : (m[1] < 3 ? 100 : 4));
  }
  for (ReconnectionBoundary boundary : { ReconnectionBoundary::Fixed, ReconnectionBoundary::Flat })
  {
    ReconnectionOptions options;
    options.regions = regions.data();
    options.boundary = boundary;
    const bool fixed = boundary == ReconnectionBoundary::Fixed;
    // With the flat boundary the interfaces are to be flat at the start.
    MeshData input = slivers;
    if (!fixed)
    {
      for (Index i = 0; i < data.numberOfPoints(); ++i)
      {
        const Vec3 p = data.point(i);
        if (p[0] == 3 || (p[0] > 3 && p[1] == 3))
        {
          input.setPoint(i, p);
        }
      }
      const std::vector<signed char> v = validityOf(input);
      if (std::count(v.begin(), v.end(), Valid) != data.numberOfCells())
      {
        input = data;
      }
    }
    const ReconnectionResult result = reconnect(input, options);
    checkResult(input, result);
    const MeshData output = outputOf(result);
    std::vector<Index> after;
    for (Index c : result.originalCells)
    {
      after.push_back(regions[c]);
    }
    for (Index region : { -7, 100, 4 })
    {
      double before = 0.0, now = 0.0;
      for (Index c = 0; c < input.numberOfCells(); ++c)
      {
        before += regions[c] == region ? volumeOf(input, c) : 0.0;
      }
      for (Index c = 0; c < output.numberOfCells(); ++c)
      {
        now += after[c] == region ? volumeOf(output, c) : 0.0;
      }
      TAUTLINE_CHECK_RELATIVE(now, before, 1e-13);
      if (fixed)
      {
        TAUTLINE_CHECK(outerFacets(output, after, region) == outerFacets(input, regions, region));
      }
    }
  }
}

/// Points of the boundary of a block stay on its faces, edges and corners.
void testFlat()
{
  MeshData data = sliverBlock(5, 2, 1.2);
  // Points of the faces move in these, too.
  Random random(17);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i);
    Vec3 x = p;
    for (int k = 0; k < 3; ++k)
    {
      x[k] += p[k] == 0 || p[k] == 5 ? 0.0 : random.uniform(-0.2, 0.2);
    }
    data.setPoint(i, x);
    const std::vector<signed char> v = validityOf(data);
    if (std::count(v.begin(), v.end(), Valid) != data.numberOfCells())
    {
      data.setPoint(i, p);
    }
  }
  ReconnectionOptions options;
  const ReconnectionResult fixed = reconnect(data, options);
  checkResult(data, fixed);
  options.boundary = ReconnectionBoundary::Flat;
  const ReconnectionResult flat = reconnect(data, options);
  checkResult(data, flat);
  checkOrigins(data, flat);
  TAUTLINE_CHECK_EQUAL(fixed.pointsInPlanes, Index(0));
  TAUTLINE_CHECK_EQUAL(flat.pointsInPlanes, Index(6 * 16));
  TAUTLINE_CHECK_EQUAL(flat.pointsOnLines, Index(12 * 4));
  TAUTLINE_CHECK(flat.history.back().boundarySwaps > 0);
  TAUTLINE_CHECK(flat.history.back().smallestAngle > fixed.history.back().smallestAngle);
  const MeshData output = outputOf(flat);
  double area = 0.0;
  for (const auto& f : outerFacets(output))
  {
    area += 0.5 * norm(cross(f[1] - f[0], f[2] - f[0]));
    for (int k = 0; k < 3; ++k)
    {
      // A coordinate that is 0 or 5 at one corner of all three: the face of the block.
      for (const Vec3& p : f)
      {
        TAUTLINE_CHECK(p[k] > -1e-14 && p[k] < 5.0 + 1e-14);
      }
    }
  }
  TAUTLINE_CHECK_RELATIVE(area, 6.0 * 25.0, 1e-13);
}

void testLimits()
{
  const MeshData data = sliverBlock(8, 7, 1.2);
  ReconnectionOptions options;
  options.maximumSeconds = 1e-9;
  const ReconnectionResult timed = reconnect(data, options);
  checkResult(data, timed);
  TAUTLINE_CHECK_EQUAL(static_cast<int>(timed.reason), static_cast<int>(StopReason::TimeLimit));
  options.maximumSeconds = 0.0;
  for (int calls : { 1, 2, 3, 4 })
  {
    int count = 0;
    double last = 0.0;
    options.observer = [&](const ReconnectionRecord& record, double progress)
    {
      TAUTLINE_CHECK(progress >= last && progress <= 1.0 && record.tetrahedra > 0);
      last = progress;
      return ++count < calls;
    };
    const ReconnectionResult aborted = reconnect(data, options);
    checkResult(data, aborted);
    TAUTLINE_CHECK_EQUAL(count, calls);
    TAUTLINE_CHECK_EQUAL(static_cast<int>(aborted.reason), static_cast<int>(StopReason::Aborted));
  }
}

/// What remains below the target has a reason; points that are fixed stay and are used.
void testObstacles()
{
  const MeshData data = sliverBlock(5, 6, 1.2);
  std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
  for (Index i = 0; i < data.numberOfPoints(); i += 3)
  {
    fixed[i] = 1;
  }
  ReconnectionOptions options;
  options.fixed = fixed.data();
  const ReconnectionResult result = reconnect(data, options);
  checkResult(data, result);
  std::vector<Index> place(data.numberOfPoints(), -1);
  for (std::size_t i = 0; i < result.originalPoints.size(); ++i)
  {
    if (result.originalPoints[i] >= 0)
    {
      place[result.originalPoints[i]] = static_cast<Index>(i);
    }
  }
  std::set<Index> used(result.tetrahedra.begin(), result.tetrahedra.end());
  const MeshData output = outputOf(result);
  for (Index i = 0; i < data.numberOfPoints(); i += 3)
  {
    TAUTLINE_CHECK(place[i] >= 0 && used.count(place[i]) == 1);
    TAUTLINE_CHECK(place[i] < 0 || output.point(place[i]) == data.point(i));
  }
  Index below = 0, held = 0;
  for (signed char obstacle : result.obstacles)
  {
    below += obstacle != 0;
    held += obstacle == static_cast<signed char>(ReconnectionObstacle::FixedPoints);
  }
  TAUTLINE_CHECK_EQUAL(below, result.history.back().belowTarget);
  TAUTLINE_CHECK(held > 0);
}
}

int TestReconnection(int, char*[])
{
  testPresets();
  testSwapOnly();
  testTargets();
  testCount();
  testScales();
  testRegions();
  testFlat();
  testLimits();
  testObstacles();
  return exitCode();
}
