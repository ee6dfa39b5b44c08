// SPDX-License-Identifier: BSD-3-Clause
// improveConnectivity(): what is kept, what improves, where the output follows from the input.

#include "Reconnecting.h"
#include "Registry.h"
#include "tautline/Optimization/Optimize.h"

using namespace tautline;

namespace
{
using Kind = ReconnectionPreset;

constexpr Kind presets[] = { Kind::RemoveSlivers, Kind::SwapOnly, Kind::SwapAndSmooth,
  Kind::Aggressive };

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
    Vec3 centroid = sumOf<Vec3>(
      { 0, 0, 0 }, 4, [&](int k) { return 0.25 * output.point(output.connectivity[4 * c + k]); });
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

TAUTLINE_PART(testPresets)
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    const MeshData data = sliverBlock(5, seed, 1.2);
    const auto facets = outerFacets(data);
    for (Kind preset : presets)
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
      const double aim = preset == Kind::SwapOnly ? 1.0 : 10.0;
      TAUTLINE_CHECK(
        result.history.back().smallestAngle > aim + result.history.front().smallestAngle);
      // Unchanged by a second run, bit for bit.
      const ReconnectionResult again = reconnect(data, options);
      TAUTLINE_CHECK(again.points == result.points && again.tetrahedra == result.tetrahedra);
    }
  }
}

TAUTLINE_PART(testSwapOnly)
{
  const MeshData data = sliverBlock(5, 9, 1.2);
  const ReconnectionResult result = reconnect(data, optionsOf(Kind::SwapOnly));
  TAUTLINE_CHECK(result.points == data.points);
  TAUTLINE_CHECK(result.tetrahedra != data.connectivity);
  TAUTLINE_CHECK_EQUAL(result.history.back().moves, Index(0));
  TAUTLINE_CHECK(result.history.back().edgeRemovals > 0);
}

/// RemoveSlivers leaves good tetrahedra alone and reaches its angle; the target ends a run.
TAUTLINE_PART(testTargets)
{
  const MeshData data = sliverBlock(6, 5, 0.9);
  const ReconnectionResult slivers = reconnect(data, optionsOf(Kind::RemoveSlivers));
  TAUTLINE_CHECK(slivers.history.back().smallestAngle >= 15.0);
  TAUTLINE_CHECK(slivers.history.back().largestAngle <= 165.0);
  TAUTLINE_CHECK_EQUAL(static_cast<int>(slivers.reason), static_cast<int>(StopReason::Reduction));
  const MeshData output = outputOf(slivers);
  Index same = sumOf<Index>(0, output.numberOfCells(),
    [&](Index c)
    {
      return std::equal(&output.connectivity[4 * c], &output.connectivity[4 * c] + 4,
        &data.connectivity[4 * slivers.originalCells[c]]);
    });
  const ReconnectionResult all = reconnect(data, optionsOf(Kind::Aggressive));
  TAUTLINE_CHECK(same > output.numberOfCells() / 3);
  TAUTLINE_CHECK(all.history.back().moves > 2 * slivers.history.back().moves);
  TAUTLINE_CHECK(all.history.back().smallestAngle > slivers.history.back().smallestAngle + 5.0);
  // A mesh that is good enough is not touched.
  TAUTLINE_LET(ReconnectionOptions, options, targetAngle = 10.0);
  const ReconnectionResult none = reconnect(output, options);
  TAUTLINE_CHECK(none.points == output.points && none.tetrahedra == output.connectivity);
  TAUTLINE_CHECK_EQUAL(none.history.size(), std::size_t(1));
  TAUTLINE_EACH_OF(
    signed char obstacle, none.obstacles, TAUTLINE_CHECK_EQUAL(static_cast<int>(obstacle), 0));
}

TAUTLINE_PART(testCount)
{
  const MeshData data = sliverBlock(5, 6, 1.2);
  for (const auto& bounds : { std::array<double, 2>{ 1.0, 1.02 }, { 0.97, 1.0 }, { 0.5, 2.0 } })
  {
    TAUTLINE_LET(ReconnectionOptions, options, smallestCount = bounds[0], largestCount = bounds[1]);
    const ReconnectionResult result = reconnect(data, options);
    checkResult(data, result);
    const double n = static_cast<double>(data.numberOfCells());
    TAUTLINE_EACH_OF(const ReconnectionRecord& record, result.history,
      TAUTLINE_CHECK(static_cast<double>(record.tetrahedra) >= bounds[0] * n &&
        static_cast<double>(record.tetrahedra) <= bounds[1] * n));
  }
  ReconnectionOptions none; // nor by repairs, which are tried for high targets
  none.smallestCount = none.largestCount = 1.0;
  ReconnectionOptions high = none;
  TAUTLINE_SET(high, boundary = BoundaryMotion::FlatParts, targetAngle = 38.8);
  TAUTLINE_LET(ReconnectionOptions, off, insert = off.contract = false);
  for (const ReconnectionOptions& options : { none, high, off })
  {
    const ReconnectionResult result = reconnect(data, options);
    TAUTLINE_CHECK_EQUAL(result.history.back().insertions, Index(0));
    TAUTLINE_CHECK_EQUAL(result.history.back().contractions, Index(0));
    TAUTLINE_CHECK(result.history.back().edgeRemovals > 0);
    TAUTLINE_CHECK_EQUAL(result.points.size(), data.points.size());
  }
}

/// Scales that are powers of two change nothing but the scale. Others, and rotations, round the
/// coordinates: swaps are the same where no two tetrahedra have the same quality. Smoothing makes
/// the worst tetrahedra equally good; then the result is only as good as before.
TAUTLINE_PART(testScales)
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
  for (Kind preset : presets)
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
      TAUTLINE_EACH(std::size_t, i, result.points.size(),
        TAUTLINE_CHECK_EQUAL(result.points[i] / scale, reference.points[i]));
    }
    const auto compare = [&](const auto& map)
    {
      MeshData moved = data;
      moved.transform(map);
      const ReconnectionResult result = reconnect(moved, options);
      TAUTLINE_CHECK(preset != Kind::SwapOnly || result.tetrahedra == reference.tetrahedra);
      TAUTLINE_CHECK_RELATIVE(result.history.back().worstQuality,
        reference.history.back().worstQuality, preset == Kind::SwapOnly ? 1e-8 : 0.1);
    };
    const Columns turn = rotation({ 1, 2, 3 }, 1.0);
    compare([](const Vec3& p) { return 1e-8 * p; });
    compare([](const Vec3& p) { return 1e8 * p; });
    compare([&](const Vec3& p) { return turn * p + Vec3{ 5, -3, 2 }; });
  }
}

TAUTLINE_PART(testRegions)
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
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    TAUTLINE_LET(ReconnectionOptions, options, regions = regions.data(), boundary = boundary);
    const bool fixed = boundary == BoundaryMotion::Fixed;
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
    auto after = collect<Index>(result.originalCells, [&](Index c) { return regions[c]; });
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

/// Points are inserted on straight edges and in flat parts where facets are too long.
TAUTLINE_PART(testDividedBoundary)
{
  constexpr double length = 6.0;
  MeshData data = blockMesh(CellType::Tetrahedron, 1, 1, 1);
  data.transform(TAUTLINE_PLACE(length * p[0], p[1], p[2]));
  TAUTLINE_LET(ReconnectionOptions, options, largestCount = 100.0);
  const ReconnectionResult fixed = reconnect(data, options);
  options.boundary = BoundaryMotion::FlatParts;
  const ReconnectionResult flat = reconnect(data, options);
  checkResult(data, flat);
  checkOrigins(data, flat);
  // Facets of 6 by 1 with the boundary fixed; a facet of length l and height 1 has (mean ratio)^1.5
  // 2 sqrt(3) l / (2 + 2 l^2), here at most 0.281.
  TAUTLINE_CHECK(fixed.history.back().worstQuality < 0.281);
  TAUTLINE_CHECK(flat.history.back().worstQuality > 0.5);
  TAUTLINE_CHECK(flat.history.back().smallestAngle > 30.0);
  Index onEdges = 0;
  for (const PointInterpolation& place : flat.interpolations)
  {
    const double* p = &flat.points[3 * place.point];
    const auto outer = [](double x, double end) { return x < 1e-12 || x > end - 1e-12; };
    const int planes = outer(p[0], length) + outer(p[1], 1.0) + outer(p[2], 1.0);
    onEdges += planes == 2;
  }
  TAUTLINE_CHECK(onEdges >= 4 * 2);
}

/// Points of the boundary of a block stay on its faces, edges and corners.
TAUTLINE_PART(testFlat)
{
  MeshData data = sliverBlock(5, 2, 1.2);
  // Points of the faces also move in them.
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
  options.boundary = BoundaryMotion::FlatParts;
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
      TAUTLINE_EACH_OF(const Vec3& p, f, TAUTLINE_CHECK(p[k] > -1e-14 && p[k] < 5.0 + 1e-14));
    }
  }
  TAUTLINE_CHECK_RELATIVE(area, 6.0 * 25.0, 1e-13);
}

TAUTLINE_PART(testLimits)
{
  const MeshData data = sliverBlock(8, 7, 1.2);
  TAUTLINE_LET(ReconnectionOptions, options, maximumSeconds = 1e-9);
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

/// Elements that remain below the target have a reason; points that are fixed stay and are used.
TAUTLINE_PART(testObstacles)
{
  const MeshData data = sliverBlock(5, 6, 1.2);
  std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
  for (Index i = 0; i < data.numberOfPoints(); i += 3)
  {
    fixed[i] = 1;
  }
  TAUTLINE_LET(ReconnectionOptions, options, fixed = fixed.data());
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

/// Blocks of a mesh: the same result with any number of threads, as good as without blocks, walls
/// and volumes of regions kept, every cell of the input covered.
TAUTLINE_PART_SLOW(testBlocks)
{
  const MeshData data = sliverBlock(9, 11, 0.9);
  std::vector<Index> regions;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Index* v = &data.connectivity[4 * c];
    const Vec3 sum = data.point(v[0]) + data.point(v[1]) + data.point(v[2]) + data.point(v[3]);
    regions.push_back(sum[0] < 4.0 * 4.0);
  }
  ReconnectionOptions options = optionsOf(Kind::Aggressive);
  options.regions = regions.data();
  const ReconnectionResult whole = reconnect(data, options);
  options.blockSize = data.numberOfCells() / 5; // 4 blocks
  options.threads = 1;
  const ReconnectionResult result = reconnect(data, options);
  checkResult(data, result);
  checkOrigins(data, result);
  TAUTLINE_CHECK(result.points != whole.points); // done in another order
  const auto worst = [](const ReconnectionResult& r) { return r.history.back().worstQuality; };
  TAUTLINE_CHECK(worst(result) > 0.7 * worst(whole));
  TAUTLINE_CHECK(result.history.back().belowTarget < 1.25 * whole.history.back().belowTarget);
  TAUTLINE_CHECK(result.history.back().insertions > 0);
  auto regionsAfter =
    collect<Index>(result.originalCells, [&](Index original) { return regions[original]; });
  const MeshData output = outputOf(result);
  for (Index region : { 0, 1 })
  {
    TAUTLINE_CHECK(outerFacets(output, regionsAfter, region) == outerFacets(data, regions, region));
  }
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    TAUTLINE_SET(options, boundary = boundary, threads = 1);
    const ReconnectionResult one = reconnect(data, options);
    checkResult(data, one);
    for (int threads : { 2, 5 })
    {
      options.threads = threads;
      const ReconnectionResult other = reconnect(data, options);
      TAUTLINE_CHECK(other.points == one.points);
      TAUTLINE_CHECK(other.tetrahedra == one.tetrahedra);
      TAUTLINE_CHECK(other.originalCells == one.originalCells);
    }
  }
  options.observer = [&](const ReconnectionRecord& record, double) { return record.pass < 1; };
  const ReconnectionResult aborted = reconnect(data, options);
  checkResult(data, aborted);
  TAUTLINE_CHECK(aborted.reason == StopReason::Aborted);
}

/// The edges of a mesh, as pairs of points given by their coordinates.
std::set<std::array<Vec3, 2>> edgesOf(const MeshData& data)
{
  std::set<std::array<Vec3, 2>> edges;
  for (std::size_t i = 0; i < data.connectivity.size(); ++i)
  {
    for (std::size_t j = i + 1; j / 4 == i / 4 && j < data.connectivity.size(); ++j)
    {
      std::array<Vec3, 2> edge = { data.point(data.connectivity[i]),
        data.point(data.connectivity[j]) };
      std::sort(edge.begin(), edge.end());
      edges.insert(edge);
    }
  }
  return edges;
}

/// Target lengths bound the edges that insertions and contractions make.
TAUTLINE_PART(testSizes)
{
  const MeshData data = sliverBlock(5, 7, 1.0);
  const std::set<std::array<Vec3, 2>> before = edgesOf(data);
  const auto newLengths = [&](const ReconnectionResult& result)
  {
    std::vector<double> lengths = { 1.0 };
    for (const auto& edge : edgesOf(outputOf(result)))
    {
      if (before.count(edge) == 0)
      {
        lengths.push_back(norm(edge[1] - edge[0]));
      }
    }
    return lengths;
  };
  TAUTLINE_LET(ReconnectionOptions, options, smallestCount = 0.0, largestCount = 10.0,
    swap = options.smooth = options.contract = false);
  const ReconnectionResult inserted = reconnect(data, options);
  const std::vector<double> anyInserted = newLengths(inserted);
  const double shortest = *std::min_element(anyInserted.begin(), anyInserted.end());
  TAUTLINE_SET(
    options, size = ReconnectionSize::Length, edgeFactor = 1.25, edgeLength = 2.0 * shortest);
  const ReconnectionResult fewer = reconnect(data, options);
  const std::vector<double> longer = newLengths(fewer);
  TAUTLINE_CHECK(longer.size() > 1 && longer.size() < anyInserted.size());
  TAUTLINE_CHECK(*std::min_element(longer.begin(), longer.end()) >= 1.6 * shortest);
  options.edgeLength = 10.0;
  TAUTLINE_CHECK_EQUAL(reconnect(data, options).history.back().insertions, Index(0));

  TAUTLINE_SET(options, insert = false, contract = true, edgeLength = 100.0);
  const std::vector<double> anyContracted = newLengths(reconnect(data, options));
  const double longest = *std::max_element(anyContracted.begin(), anyContracted.end());
  options.edgeLength = 0.75 * longest;
  const std::vector<double> limited = newLengths(reconnect(data, options));
  TAUTLINE_CHECK(longest > 1.0);
  TAUTLINE_CHECK(*std::max_element(limited.begin(), limited.end()) <= 0.9376 * longest);

  // The same by a length and by a tensor per point; other tensors and the input's lengths differ.
  const double length = 2.0 * shortest, entry = 1.0 / (length * length);
  ReconnectionOptions all = TAUTLINE_CHANGED(options, insert = true, contract = false);
  std::vector<double> lengths(data.numberOfPoints(), length), tensors;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    tensors.insert(tensors.end(), { entry, entry, entry, 0.0, 0.0, 0.0 });
  }
  TAUTLINE_SET(all, size = ReconnectionSize::Lengths, sizes = lengths.data());
  TAUTLINE_CHECK(reconnect(data, all).points == fewer.points);
  TAUTLINE_SET(all, size = ReconnectionSize::Metrics, sizes = tensors.data());
  TAUTLINE_CHECK(reconnect(data, all).points == fewer.points);
  for (std::size_t i = 0; i < tensors.size(); i += 6)
  {
    tensors[i] = 0.01 * entry; // ten times longer in x
  }
  TAUTLINE_CHECK(reconnect(data, all).points != fewer.points);
  all.size = ReconnectionSize::Input;
  checkResult(data, reconnect(data, all));
  TAUTLINE_CHECK(reconnect(data, all).points != fewer.points);

  all.size = ReconnectionSize::Metrics;
  tensors[3] = 2.0 * entry;
  TAUTLINE_CHECK_THROWS(
    reconnect(data, all), wording("1-metric-tensors-are-not-positive-definite"));
  TAUTLINE_SET(all, size = ReconnectionSize::Lengths, sizes = lengths.data());
  lengths[4] = 0.0;
  TAUTLINE_CHECK_THROWS(reconnect(data, all), wording("1-target-lengths-of-edges-are-not"));
  all.sizes = nullptr;
  TAUTLINE_CHECK_THROWS(reconnect(data, all), wording("are-missing"));
  TAUTLINE_SET(all, size = ReconnectionSize::Length, edgeLength = 0.0);
  TAUTLINE_CHECK_THROWS(reconnect(data, all), wording("must-be-above-0"));
  all.edgeLength = all.edgeFactor = 1.0;
  TAUTLINE_CHECK_THROWS(reconnect(data, all), wording("must-be-above-1"));
}

/// With the worst held, the mean becomes about as good as with Best shape alone on the same cells.
TAUTLINE_PART(testMean)
{
  const MeshData data = sliverBlock(6, 9, 0.9);
  const auto meanOf = [](const MeshData& mesh)
  {
    const std::vector<double> values = valuesOf(mesh, Metric::InverseMeanRatio);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    ReconnectionOptions options = optionsOf(Kind::Aggressive);
    options.boundary = boundary;
    const ReconnectionResult plain = reconnect(data, options);
    options.improveMean = true;
    const ReconnectionResult held = reconnect(data, options);
    checkResult(data, held);
    const ReconnectionRecord &before = plain.history.back(), &after = held.history.back();
    TAUTLINE_CHECK(held.tetrahedra == plain.tetrahedra);
    TAUTLINE_CHECK(after.smallestAngle >= before.smallestAngle * (1.0 - 1e-12));
    TAUTLINE_CHECK(after.worstInverseMeanRatio <= before.worstInverseMeanRatio * (1.0 + 1e-12));
    TAUTLINE_CHECK(meanOf(outputOf(held)) < 0.99 * meanOf(outputOf(plain)));
    if (boundary == BoundaryMotion::Fixed)
    {
      MeshData shape = outputOf(plain);
      const OptimizeResult best = optimize(Mesh(shape.view()), OptimizeOptions());
      shape.points = best.points;
      TAUTLINE_CHECK(meanOf(outputOf(held)) <= 1.02 * meanOf(shape));
    }
  }
}

/// Overlaps cover each cell of the input, averages are exact for constants and keep the integral.
TAUTLINE_PART(testOverlaps)
{
  const MeshData data = sliverBlock(4, 5, 0.9);
  std::vector<double> field;
  Random random(4);
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    field.push_back(random.vector(-1.0, 3.0)[0]);
  }
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    ReconnectionOptions options = optionsOf(Kind::Aggressive);
    options.boundary = boundary;
    TAUTLINE_CHECK(reconnect(data, options).overlaps.offsets.empty());
    options.overlaps = true;
    const ReconnectionResult result = reconnect(data, options);
    const MeshData output = outputOf(result);
    const CellOverlaps& overlaps = result.overlaps;
    TAUTLINE_CHECK_EQUAL(static_cast<Index>(overlaps.offsets.size()), output.numberOfCells() + 1);
    std::vector<double> covered(data.numberOfCells(), 0.0);
    double before = 0.0, after = 0.0, size = 0.0;
    for (Index c = 0; c < output.numberOfCells(); ++c)
    {
      double most = 0.0, sum = 0.0;
      for (Index k = overlaps.offsets[c]; k < overlaps.offsets[c + 1]; ++k)
      {
        covered[overlaps.cells[k]] += overlaps.fractions[k] * volumeOf(output, c);
        most = std::max(most, overlaps.fractions[k]);
        sum += overlaps.fractions[k];
      }
      TAUTLINE_CHECK_NEAR(sum, 1.0, 1e-14);
      const Index* begin = &overlaps.cells[overlaps.offsets[c]];
      const Index* end = begin + (overlaps.offsets[c + 1] - overlaps.offsets[c]);
      const Index* original = std::find(begin, end, result.originalCells[c]);
      TAUTLINE_CHECK(original != end);
      TAUTLINE_CHECK_EQUAL(overlaps.fractions[original - overlaps.cells.data()], most);
      after += volumeOf(output, c) * overlaps.average(c, [&](Index i) { return field[i]; });
      TAUTLINE_CHECK_EQUAL(overlaps.average(c, [](Index) { return 0.1; }), 0.1);
    }
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      TAUTLINE_CHECK_RELATIVE(covered[c], volumeOf(data, c), 1e-9);
      before += volumeOf(data, c) * field[c];
      size += volumeOf(data, c) * std::abs(field[c]);
    }
    TAUTLINE_CHECK_NEAR(after, before, 1e-12 * size);
  }
}
}
