// SPDX-License-Identifier: BSD-3-Clause
// The worst tetrahedron by its smallest dihedral angle: never worse whatever the preset, and better
// with the preset for it, of the kernel and of the filter. The angles are computed here.
#include "Optimizing.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkMeshOptimizer.h"

#include <cstdio>

using namespace tautline;

namespace
{
constexpr unsigned seeds = 6;
constexpr double rounding = 1e-9;

/// A block of tetrahedra with a wavy side.
MeshData wavyBlock(unsigned seed)
{
  MeshData data = perturbedBlock(CellType::Tetrahedron, 5, 0.22, seed);
  data.transform(
    TAUTLINE_PLACE(p[0] * (1 + 0.03 * std::sin(1.3 * p[1])), p[1], p[2] * (1 + p[0] / 40)));
  return data;
}

/// Between the faces that meet at an edge, in degrees.
double dihedralAngle(const Vec3& from, const Vec3& to, const Vec3& left, const Vec3& right)
{
  const Vec3 a = cross(to - from, left - from), b = cross(to - from, right - from);
  const double turn = dot(cross(a, b), to - from) / norm(to - from);
  return std::atan2(std::abs(turn), dot(a, b)) * 180 / std::acos(-1.0);
}

/// The smallest angle of all, in degrees. @param movable only of tetrahedra with a free point
double smallestAngle(const MeshData& data, bool movable)
{
  constexpr int edges[6][4] = { { 0, 1, 2, 3 }, { 0, 2, 1, 3 }, { 0, 3, 1, 2 }, { 1, 2, 0, 3 },
    { 1, 3, 0, 2 }, { 2, 3, 0, 1 } };
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  double smallest = 180;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Index* nodes = data.connectivity.data() + data.offsets[c];
    const bool fixed = std::all_of(nodes, nodes + 4, [&](Index p) { return boundary[p] != 0; });
    for (const auto& edge : edges)
    {
      const double angle = dihedralAngle(data.point(nodes[edge[0]]), data.point(nodes[edge[1]]),
        data.point(nodes[edge[2]]), data.point(nodes[edge[3]]));
      smallest = movable && fixed ? smallest : std::min(smallest, angle);
    }
  }
  return smallest;
}

MeshData at(MeshData data, const std::vector<double>& points)
{
  data.points = points;
  return data;
}

constexpr Preset presets[] = { Preset::FastCleanUp, Preset::BestShape, Preset::UniformSize,
  Preset::LowInterpolationError, Preset::UntangleThenImprove, Preset::WorstElement };

/// The angle after each preset that applies to tetrahedra without a reference; the start of the
/// second round has the best angle, which other objectives would lower.
TAUTLINE_PART(testKernel)
{
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    const Context context("seed " + std::to_string(seed));
    const MeshData data = wavyBlock(seed);
    TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
    const double before = smallestAngle(data, false), free = smallestAngle(data, true);
    double best = 0; // of the preset Best shape
    MeshData improved = data;
    for (const Preset preset : presets)
    {
      const Context which("preset " + std::to_string(static_cast<int>(preset)));
      OptimizeOptions options;
      applyPreset(preset, options);
      options.worstMetric = Metric::MinimumAngle;
      const MeshData after = at(data, run(data, options).points);
      const double reached = smallestAngle(after, true);
      TAUTLINE_CHECK_EQUAL(invalid(data, after.points), Index(0));
      TAUTLINE_CHECK(smallestAngle(after, false) >= before * (1 - rounding));
      best = preset == Preset::BestShape ? reached : best;
      if (preset == Preset::WorstElement)
      {
        std::printf("seed %u: smallest angle %.3f of the input, %.3f Best shape, %.3f Worst "
                    "element\n",
          seed, free, best, reached);
        TAUTLINE_CHECK(reached > 1.5 * free);
        TAUTLINE_CHECK(reached > 1.02 * best);
        improved = after;
      }
    }
    // Over all tetrahedra. Those that cannot move have larger ones than Best shape gives.
    const double angle = smallestAngle(improved, false);
    for (const Preset preset : presets)
    {
      const Context which("preset " + std::to_string(static_cast<int>(preset)) + ", improved");
      OptimizeOptions options;
      applyPreset(preset, options);
      options.worstMetric = Metric::MinimumAngle;
      const double held = smallestAngle(at(data, run(improved, options).points), false);
      TAUTLINE_CHECK(held >= angle * (1 - rounding));
      options.holdWorst = false;
      const double lost = smallestAngle(at(data, run(improved, options).points), false);
      TAUTLINE_CHECK(preset != Preset::BestShape || lost < 0.97 * angle);
    }
  }
}

//------------------------------------------------------------------------------
/// With the metric chosen by its name the filter gives what the kernel gives, and its arrays agree.
TAUTLINE_PART(testFilter)
{
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    const Context context("filter, seed " + std::to_string(seed));
    const MeshData data = wavyBlock(seed);
    OptimizeOptions options;
    applyPreset(Preset::WorstElement, options);
    options.worstMetric = Metric::MinimumAngle;
    const MeshData expected = at(data, run(data, options).points);
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)),
      SetPreset(vtkMeshOptimizer::WORST_ELEMENT), SetWorstMetricByName("min_angle"), Update());
    const MeshData after = withPointsOf(data, outputOf(filter));
    TAUTLINE_CHECK(after.points == expected.points);
    TAUTLINE_CHECK(smallestAngle(after, true) > 1.5 * smallestAngle(data, true));
    // Another choice is another result.
    TAUTLINE_SET(filter, SetWorstMetric(-1), Update());
    const MeshData byRatio = withPointsOf(data, outputOf(filter));
    TAUTLINE_CHECK(smallestAngle(byRatio, true) < smallestAngle(after, true));
  }
}
}
