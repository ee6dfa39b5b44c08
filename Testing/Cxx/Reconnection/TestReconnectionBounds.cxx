// SPDX-License-Identifier: BSD-3-Clause
// The objectives of improveConnectivity(), the limits by the boundary, and memory.

#include "Reconnecting.h"
#include "Registry.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Reconnection/FacetBound.h"

#include <sys/wait.h>
#include <unistd.h>

using namespace tautline;

namespace
{
/// The best quality over places at random, then nearer and nearer to the best so far.
double searchFacet(const Vec3& a, const Vec3& b, const Vec3& c, const QualityWeights& weights)
{
  Random random(7);
  const Vec3 centroid = (1.0 / 3.0) * (a + b + c);
  Vec3 best = centroid;
  double value = 0.0, radius = 1.5 * std::max({ norm(b - a), norm(c - b), norm(a - c) });
  for (int round = 0; round < 24; ++round, radius *= 0.7)
  {
    const Vec3 center = best;
    for (int i = 0; i < (round == 0 ? 60000 : 3000); ++i)
    {
      const Vec3 p = center + random.vector(-radius, radius);
      const double q = roundedQuality(p, a, b, c, weights);
      best = q > value ? p : best;
      value = std::max(value, q);
    }
  }
  return value;
}

TAUTLINE_PART(testFacetQuality)
{
  StarSmoothing smoothing;
  const Vec3 a = { 0, 0, 0 };
  const Vec3 corners[][2] = { { { 1, 0, 0 }, { 0.5, 0.866, 0 } }, { { 1, 0, 0 }, { 0.1, 0.2, 0 } },
    { { 2, 0, 1 }, { 0, 0.3, 0 } }, { { 2.19, 0, 0 }, { -0.7, 0.3, 0 } } };
  for (const auto& corner : corners)
  {
    const Vec3 &b = corner[0], &c = corner[1];
    for (const QualityWeights& weights :
      { QualityWeights{ 1, 1 }, QualityWeights{ 1, 3 }, QualityWeights{ 1, 1e3 } })
    {
      const double bound = facetQuality(a, b, c, weights, smoothing);
      const double found = searchFacet(a, b, c, weights);
      TAUTLINE_CHECK(bound > found * (1.0 - 1e-3));
      TAUTLINE_CHECK(weights.meanRatio > 3.0 || bound < found * (1.0 + 1e-3));
    }
    const double meanRatio = facetMeanRatio(a, b, c);
    TAUTLINE_CHECK_RELATIVE(meanRatio, searchFacet(a, b, c, { 1e3, 1 }), 1e-4);
    TAUTLINE_CHECK_RELATIVE(
      facetQuality(a, b, c, { 1e3, 1 }, smoothing), std::min(meanRatio, 1.0), 3e-3);
  }
  // An equilateral triangle allows the regular tetrahedron; a degenerate one allows nothing.
  const Vec3 b = { 1, 0, 0 }, c = { 0.5, std::sqrt(0.75), 0 };
  TAUTLINE_CHECK_RELATIVE(facetMeanRatio(a, b, c), 1.0, 1e-14);
  TAUTLINE_CHECK_RELATIVE(facetQuality(a, b, c, {}, smoothing), std::sqrt(8.0) / 3.0, 1e-3);
  TAUTLINE_CHECK_EQUAL(facetQuality(a, b, b, {}, smoothing), 0.0);
}

/// Six tetrahedra round one point, between a triangle and the points above and below it.
MeshData bipyramid()
{
  MeshData data;
  const std::vector<Vec3> points = { { 1, 0, 0 }, { -0.5, 0.9, 0 }, { -0.6, -0.8, 0.1 },
    { 0.1, 0, 3 }, { 0, 0.1, -1 }, { 0.1, 0.1, 0.2 } };
  data.addPoints(points);
  for (Index i = 0; i < 3; ++i)
  {
    const Index j = (i + 1) % 3;
    data.addCell(CellType::Tetrahedron, std::vector<Index>{ i, j, 5, 3 });
    data.addCell(CellType::Tetrahedron, std::vector<Index>{ j, i, 5, 4 });
  }
  return data;
}

/// The point goes where each objective is largest: each is best in its own figure.
TAUTLINE_PART(testObjectives)
{
  const MeshData data = bipyramid();
  TAUTLINE_LET(ReconnectionOptions, options,
    swap = options.insert = options.contract = options.compound = false, targetAngle = 60.0);
  const auto run = [&](ReconnectionObjective objective)
  {
    options.objective = objective;
    const ReconnectionResult result = reconnect(data, options);
    checkResult(data, result);
    return result.history.back();
  };
  const ReconnectionRecord both = run(ReconnectionObjective::AnglesAndShape);
  const ReconnectionRecord angles = run(ReconnectionObjective::Angles);
  const ReconnectionRecord shape = run(ReconnectionObjective::Shape);
  const auto sine = [](const ReconnectionRecord& r)
  { return std::sin(std::min(r.smallestAngle, 180.0 - r.largestAngle) * (Pi / 180.0)); };
  const auto meanRatio = [](const ReconnectionRecord& r)
  { return std::pow(r.worstInverseMeanRatio, -1.5); };
  TAUTLINE_CHECK_RELATIVE(both.worstQuality, std::min(sine(both), meanRatio(both)), 1e-9);
  TAUTLINE_CHECK_RELATIVE(angles.worstQuality, sine(angles), 1e-9);
  TAUTLINE_CHECK_RELATIVE(shape.worstQuality, meanRatio(shape), 1e-9);
  TAUTLINE_CHECK(sine(angles) > 1.01 * sine(both));
  TAUTLINE_CHECK(meanRatio(angles) < 0.98 * meanRatio(both));
  TAUTLINE_CHECK(meanRatio(shape) >= meanRatio(both) * (1.0 - 1e-3));
}

/// Elements that remain below the target are within their bounds, and the reason Facets means that
/// it is at the bound.
TAUTLINE_PART(testBounds)
{
  const MeshData data = bipyramid();
  TAUTLINE_LET(ReconnectionOptions, options, targetAngle = 60.0);
  const ReconnectionResult result = reconnect(data, options);
  const std::size_t count = result.obstacles.size();
  TAUTLINE_CHECK(result.bounds.size() == count && result.qualities.size() == count);
  double worst = 1.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto obstacle = static_cast<ReconnectionObstacle>(result.obstacles[i]);
    const double quality = result.qualities[i], bound = result.bounds[i];
    worst = std::min(worst, quality);
    TAUTLINE_CHECK(quality <= bound && bound <= 1.0);
    TAUTLINE_CHECK(bound == 1.0 || obstacle != ReconnectionObstacle::None);
    TAUTLINE_CHECK_EQUAL(obstacle == ReconnectionObstacle::Facets, bound <= quality * 1.002);
  }
  TAUTLINE_CHECK_EQUAL(worst, result.history.back().worstQuality);
  // The bound of the mesh comes from the worst facet.
  StarSmoothing smoothing;
  double least = 1.0;
  for (Index i = 0; i < 3; ++i)
  {
    for (Index apex : { 3, 4 })
    {
      least = std::min(least,
        facetQuality(data.point(i), data.point((i + 1) % 3), data.point(apex), {}, smoothing));
    }
  }
  TAUTLINE_CHECK_RELATIVE(result.forcedQuality, least, 1e-9);
  TAUTLINE_CHECK(worst <= least * 1.002);
  // A tetrahedron alone is at its bound: the angle between two of its facets.
  const MeshData one = singleCell(
    CellType::Tetrahedron, { { 0, 0, 0 }, { 1, 0, 0 }, { 0.3, 1, 0 }, { 0.4, 0.4, 0.05 } });
  options.objective = ReconnectionObjective::Angles;
  const ReconnectionResult alone = reconnect(one, options);
  TAUTLINE_CHECK_EQUAL(
    static_cast<int>(alone.obstacles[0]), static_cast<int>(ReconnectionObstacle::Facets));
  TAUTLINE_CHECK_EQUAL(alone.bounds[0], alone.qualities[0]);
}

/// In a child process, whose limit may be set: the error names the memory and a remedy.
TAUTLINE_PART(testMemory)
{
  const MeshData data = sliverBlock(30, 3, 0.2);
  const Mesh mesh(data.view());
  const pid_t child = fork();
  if (child == 0)
  {
    constexpr double few = 3e7; // 162,000 tetrahedra take 40 MB
    limitMemory(few);
    int code = 1;
    try
    {
      improveConnectivity(mesh, ReconnectionOptions());
    }
    catch (const MemoryError& error)
    {
      const std::string text = error.what();
      code = contains(text, wording("reconnection-of-this-mesh-takes-about")) &&
          contains(text, wording("take-a-smaller-mesh"))
        ? 0
        : 2;
    }
    catch (...)
    {
      code = 3;
    }
    _exit(code);
  }
  int status = -1;
  waitpid(child, &status, 0);
  TAUTLINE_CHECK_EQUAL(status, 0);
}

/// The records of a mesh of several chunks have its worst values, wherever these are.
TAUTLINE_PART(testRecords)
{
  const MeshData data = sliverBlock(12, 7);
  ReconnectionOptions options = optionsOf(ReconnectionPreset::SwapAndSmooth);
  options.targetAngle = 20.0;
  std::set<Index> chunks;
  for (int threads : { 1, 3 })
  {
    options.threads = threads;
    const ReconnectionResult result = reconnect(data, options);
    for (const auto& [mesh, record] : { std::pair(data, result.history.front()),
           std::pair(outputOf(result), result.history.back()) })
    {
      const std::vector<double> smallest = valuesOf(mesh, Metric::MinimumAngle),
                                largest = valuesOf(mesh, Metric::MaximumAngle),
                                shape = valuesOf(mesh, Metric::InverseMeanRatio);
      const auto worst = std::min_element(smallest.begin(), smallest.end());
      TAUTLINE_CHECK_RELATIVE(record.smallestAngle, *worst, 1e-9);
      TAUTLINE_CHECK_RELATIVE(
        record.largestAngle, *std::max_element(largest.begin(), largest.end()), 1e-9);
      TAUTLINE_CHECK_RELATIVE(
        record.worstInverseMeanRatio, *std::max_element(shape.begin(), shape.end()), 1e-9);
      TAUTLINE_CHECK_EQUAL(record.tetrahedra, mesh.numberOfCells());
      TAUTLINE_CHECK_EQUAL(record.belowTarget > 0, *worst < options.targetAngle);
      chunks.insert((worst - smallest.begin()) / ChunkSize);
    }
    const std::vector<double> shape = valuesOf(outputOf(result), Metric::InverseMeanRatio);
    TAUTLINE_CHECK_RELATIVE(result.meanAfter,
      std::accumulate(shape.begin(), shape.end(), 0.0) / static_cast<double>(shape.size()), 1e-9);
  }
  TAUTLINE_CHECK(*chunks.rbegin() > 0); // otherwise a later chunk is not needed
}

/// Nothing is inserted or contracted at postponed points.
TAUTLINE_PART(testPostponed)
{
  const MeshData data = sliverBlock(9, 11, 0.9);
  ReconnectionOptions options = optionsOf(ReconnectionPreset::Aggressive);
  std::vector<unsigned char> postponed(data.numberOfPoints(), 1);
  options.postponed = postponed.data();
  for (const Index block : { data.numberOfCells(), data.numberOfCells() / 5 })
  {
    options.blockSize = block;
    const ReconnectionResult result = reconnect(data, options);
    checkResult(data, result);
    const ReconnectionRecord& last = result.history.back();
    TAUTLINE_CHECK_EQUAL(last.insertions, Index(0));
    TAUTLINE_CHECK_EQUAL(last.contractions, Index(0));
    TAUTLINE_CHECK(last.edgeRemovals > 0 && last.moves > 0);
    TAUTLINE_CHECK_EQUAL(result.points.size(), data.points.size());
  }
}
}
