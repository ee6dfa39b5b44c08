// SPDX-License-Identifier: BSD-3-Clause
// The constraints of the optimizer: fixed points, limits, planes, lines, surfaces.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/Patches/SimplexMesh.h"

#include <cstring>

using namespace tautline;

namespace
{
/// Fixed points, limits, planes and lines.
TAUTLINE_PART(testConstraints)
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 5, 0.1);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  const Index n = data.numberOfPoints();
  auto fixed = collect<unsigned char>(n, [&](Index i) { return boundary[i] || i % 3 == 0; });
  TAUTLINE_LET(OptimizeOptions, options, fixed = fixed.data());
  OptimizeResult result = run(data, options);
  for (Index i = 0; i < n; ++i)
  {
    if (fixed[i])
    {
      TAUTLINE_CHECK_EQUAL(std::memcmp(&result.points[3 * i], &data.points[3 * i], 24), 0);
    }
  }
  TAUTLINE_CHECK_EQUAL(result.freeVertices, Index(std::count(fixed.begin(), fixed.end(), 0)));

  constexpr double limit = 0.03;
  const std::vector<double> limits(n, limit);
  options = TAUTLINE_CHANGED(OptimizeOptions(), limits = limits.data());
  result = run(data, options);
  double most = 0;
  for (Index i = 0; i < n; ++i)
  {
    const Vec3 now = { result.points[3 * i], result.points[3 * i + 1], result.points[3 * i + 2] };
    most = std::max(most, norm(now - data.point(i)));
  }
  TAUTLINE_CHECK(most <= limit * (1 + 1e-12));
  TAUTLINE_CHECK(most > 0.99 * limit); // it was in the way
  checkHistory(data, result);
  options.optimizer = Optimizer::LimitedMemoryBFGS;
  TAUTLINE_CHECK_THROWS(run(data, options), wording("need-a-local-optimizer"));

  // Points of the face z = 0 slide in it, points of its edges along them; the corners stay.
  for (Optimizer optimizer :
    { Optimizer::LocalNewton, Optimizer::LocalConjugateGradient, Optimizer::LimitedMemoryBFGS })
  {
    const Context context("slide " + std::to_string(static_cast<int>(optimizer)));
    MeshData slid = data;
    std::vector<double> planes(3 * n, 0.0), lines(3 * n, 0.0);
    std::fill(fixed.begin(), fixed.end(), 0);
    Random random(3);
    for (Index i = 0; i < n; ++i)
    {
      Vec3 p = data.point(i);
      const auto end = [](double x) { return x == 0 || x == 5; };
      const int ends = end(p[0]) + end(p[1]) + end(p[2]);
      fixed[i] = ends > 0 && (p[2] != 0 || ends == 3);
      if (!fixed[i] && ends == 2)
      {
        lines[3 * i + (end(p[0]) ? 1 : 0)] = 1;
        p[end(p[0]) ? 1 : 0] += random.uniform(-0.2, 0.2);
      }
      else if (!fixed[i] && ends == 1)
      {
        planes[3 * i + 2] = 1;
        p[0] += random.uniform(-0.15, 0.15);
      }
      slid.setPoint(i, p);
    }
    TAUTLINE_CHECK_EQUAL(invalid(slid, slid.points), Index(0));
    options = TAUTLINE_CHANGED(OptimizeOptions(), optimizer = optimizer, fixed = fixed.data());
    const double held = [&]()
    {
      std::vector<unsigned char> all = fixed;
      for (Index i = 0; i < n; ++i)
      {
        all[i] = boundary[i];
      }
      return run(slid, TAUTLINE_CHANGED(options, fixed = all.data())).history.back().objective;
    }();
    TAUTLINE_SET(options, slidePlanes = planes.data(), slideLines = lines.data());
    result = run(slid, options);
    TAUTLINE_CHECK(result.history.back().objective < held);
    for (Index i = 0; i < n; ++i)
    {
      const Vec3 now = { result.points[3 * i], result.points[3 * i + 1], result.points[3 * i + 2] };
      const Vec3 then = slid.point(i);
      if (then[2] == 0)
      {
        TAUTLINE_CHECK_NEAR(now[2], 0.0, 1e-13);
      }
      for (int c = 0; c < 3; ++c)
      {
        const bool line = lines[3 * i] != 0 || lines[3 * i + 1] != 0;
        if (line && lines[3 * i + c] == 0)
        {
          TAUTLINE_CHECK_NEAR(now[c], then[c], 1e-13);
        }
      }
    }
  }
}

/// Points of a curved side slide on the facets (in 2D edges) it has.
TAUTLINE_PART(testSlidingSurface)
{
  for (CellType type : { CellType::Tetrahedron, CellType::Hexahedron, CellType::Triangle })
  {
    const Context context(topology(type).name);
    const int up = topology(type).dimension - 1;
    MeshData data = perturbedBlock(type, 5, 0.1);
    const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    const Index n = data.numberOfPoints();
    std::vector<unsigned char> fixed(n, 0), slides(n, 0);
    Random random(23);
    for (Index i = 0; i < n; ++i)
    {
      Vec3 p = data.point(i);
      bool inner = true;
      for (int c = 0; c < up; ++c)
      {
        inner = inner && p[c] > 0 && p[c] < 5;
      }
      slides[i] = inner && p[up] == 5;
      fixed[i] = boundary[i] && !slides[i];
      for (int c = 0; c < up && slides[i]; ++c)
      {
        p[c] += random.uniform(-0.3, 0.3);
      }
      p[up] *= 1 + 0.05 * std::sin(0.2 * std::acos(-1.0) * p[0]);
      data.setPoint(i, p);
    }
    TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
    OptimizeOptions options;
    std::vector<unsigned char> held = fixed;
    for (Index i = 0; i < n; ++i)
    {
      held[i] = boundary[i];
    }
    options.fixed = held.data();
    const double F = run(data, options).history.back().objective;
    TAUTLINE_SET(options, fixed = fixed.data(), slideSurface = slides.data());
    const OptimizeResult result = run(data, options);
    TAUTLINE_CHECK(result.history.back().objective < 0.99 * F);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
    TAUTLINE_CHECK(result.surfaceError > 0 && result.surfaceError < 0.05);
    const Mesh mesh(data.view());
    const SimplexMesh simplices(mesh, fixed.data(), nullptr, 1);
    const SurfaceProjection surface(mesh, simplices);
    for (Index i = 0; i < n; ++i)
    {
      const Vec3 x = simplices.transform(
        { result.points[3 * i], result.points[3 * i + 1], result.points[3 * i + 2] });
      if (slides[i])
      {
        TAUTLINE_CHECK_NEAR(norm(surface.closest(x) - x), 0.0, 1e-12);
      }
    }
    options.optimizer = Optimizer::LimitedMemoryBFGS;
    TAUTLINE_CHECK_THROWS(run(data, options), wording("local-optimizer"));
  }
}

/// Points of a sphere's mesh stay on it.
TAUTLINE_PART(testSurface)
{
  MeshData data = blockMesh(CellType::Triangle, 12, 12, 0);
  Random random(2);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    Vec3 p = data.point(i);
    if (!boundary[i])
    {
      p += Vec3{ random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0 };
    }
    p = Vec3{ p[0] / 6 - 1, p[1] / 6 - 1, 0 };
    data.setPoint(i, { p[0], p[1], std::sqrt(4 - p[0] * p[0] - p[1] * p[1]) });
  }
  OptimizeOptions options;
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK(result.history.back().objective < 0.95 * result.history.front().objective);
  TAUTLINE_CHECK_RELATIVE(sumOfSquares(data, result.points, Metric::InverseMeanRatio),
    result.history.back().objective, 1e-10);
  const double edge = 1.0 / 6;
  TAUTLINE_CHECK(result.surfaceError > 0 && result.surfaceError < edge * edge);
  double most = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const double* p = &result.points[3 * i];
    most = std::max(most, std::abs(2 - std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])));
  }
  TAUTLINE_CHECK(most < edge * edge); // on the facets of the input, which cut the sphere's chords
  options.optimizer = Optimizer::LimitedMemoryBFGS;
  TAUTLINE_CHECK_THROWS(run(data, options), wording("local-optimizer"));
}
}
